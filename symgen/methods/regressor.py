"""The regressor: the least inputs for a unit of each inertial parameter, u = Y pi for bodies alone."""

from __future__ import annotations

from symgen.methods.derivation import Derivation
from symgen.symbolic.matrix import Matrix, matmul, transpose


def regressor(d: Derivation) -> Matrix:
    """Y = M~^+ Y_tau (m x p), with what each inertial parameter loads the coordinates with as columns of Y_tau.

    The pseudoinverse is made once; what loads no coordinate is a column of zeros.
    """
    from symgen.mechanics.rigid_bodies.inertial_columns import inertial_columns  # other models start without it

    mechanics = d.mechanics
    columns = inertial_columns(mechanics.bodies, mechanics.model.mechanism, mechanics.qd, mechanics.qdd)
    return matmul(d.graph, d.control_pseudoinverse, transpose(columns, d.n), len(columns))
