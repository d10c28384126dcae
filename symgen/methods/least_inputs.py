"""u = M~^+ f: the least inputs that produce a force, beside V as on it."""

from __future__ import annotations

from symgen.linear_algebra.null_space.null_spaces import InputEquations, Restriction
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.symbolic.matrix import Vector, matvec


def least_inputs(
    mechanics: System, generic: Genericity, forms: InputEquations, restriction: Restriction, force: Vector
) -> Vector:
    """The inputs (m) of least norm, in the weights of `forms`, for a generalized force (n) or what is nearest to it.

    M~^+ M~ u = u.  Where inputs are idle and directions have no drive, u is solved for twice: beside V, inputs that
    on V load the constraints alone would answer to what no input moves.
    """
    inputs = forms.solve(restriction(force))
    if generic.alpha < min(generic.m, generic.delta):
        inputs = forms.solve(restriction(matvec(mechanics.graph, mechanics.control_matrix, inputs)))
    return inputs
