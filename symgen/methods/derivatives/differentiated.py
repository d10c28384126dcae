"""Derivatives of what a method's steps make, and products of weights with them, for where others lose digits.

A reverse sweep carries weights through all that u or q_ddot is made of, and what cancels between two entries of J w is
worked out to the digits of the larger one.  J has its entries one by one, with what cancels in each of them cancelled.
A product with second derivatives is the derivative of that along its direction.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.method import INPUTS, Candidate, Method
from symgen.methods.table import Use, methods
from symgen.methods.workspace import Workspace
from symgen.model.quantities import DIRECTION, MOTIONS, ROWS, WEIGHT_ARGUMENTS
from symgen.records import dataclass
from symgen.symbolic.accumulation import shortest_jacobian
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.matrix import Matrix, Vector, dot, flatten

# What is the derivative of what.
FUNCTIONS = {
    "inverse_dynamics_jacobian": INPUTS,
    "inverse_dynamics_gradient": INPUTS,
    "inverse_dynamics_hessian_product": INPUTS,
    "inverse_dynamics_parameter_jacobian": INPUTS,
    "forward_dynamics_jacobian": MOTIONS[0],
    "forward_dynamics_gradient": MOTIONS[0],
    "multipliers_jacobian": MOTIONS[1],
}


def derivatives(mechanics: System, quantity: str, values: Vector, swept: bool) -> Vector:
    """A derivative of a function with these `values`; weights are `swept` through it, or multiply its Jacobian."""
    graph = mechanics.graph
    by = _symbols(mechanics, quantity)
    weights = _weights(mechanics, quantity)
    if weights and swept:
        values = tuple(dot(graph, one, values) for one in weights)
    slopes = shortest_jacobian(graph, values, by)
    outputs = flatten(slopes)
    if weights and not swept:
        outputs = tuple(dot(graph, one, column) for one in weights for column in zip(*slopes, strict=True))
    return along_direction(mechanics, quantity, outputs)


def along_direction(mechanics: System, quantity: str, outputs: Vector) -> Vector:
    """Their derivative along v_x, where the quantity is one along a direction."""
    if DIRECTION not in ROWS[quantity].arguments:
        return outputs
    (direction,) = mechanics.further(DIRECTION)
    along = dict(zip(_symbols(mechanics, quantity), direction, strict=True))
    return tuple(derivative_along(mechanics.graph, outputs, along))


def _weights(mechanics: System, quantity: str) -> Matrix:
    """w as a row; none where nothing is weighted."""
    return mechanics.further(*(name for name in WEIGHT_ARGUMENTS if name in ROWS[quantity].arguments))


def _symbols(mechanics: System, quantity: str) -> Vector:
    if "parameters" in ROWS[quantity].sizes:
        return mechanics.parameters
    return mechanics.motion if FUNCTIONS[quantity] == INPUTS else (*mechanics.q, *mechanics.qd, *mechanics.u)


@dataclass(frozen=True, slots=True)
class _Differentiated(ByTheorem):
    """`theorem` says why it is valid wherever the function itself is."""

    theorem: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The derivatives by the method of the function that counts least, or why there are none."""
        function = FUNCTIONS[quantity]
        made = []
        for row in methods(function, Use.CHOSEN):
            method = row.load()
            one = method.build(workspace, function)
            if isinstance(one, Candidate):
                one = replace(one, method=row.name)
                if method.validity(workspace, one, first_only=True).admitted:
                    made.append(one)
        if not made:
            return "none of the methods of the function itself is valid"
        best = min(made, key=lambda one: one.weight)
        mechanics, values = best.system.mechanics, best.derived.outputs
        outputs = derivatives(mechanics, quantity, values, swept=False)
        rows = () if _weights(mechanics, quantity) else (len(values),)
        shape = (*rows, len(_symbols(mechanics, quantity)))
        return replace(best, derived=replace(best.derived, name=quantity, shape=shape, outputs=outputs))


DIFFERENTIATED: Method = _Differentiated("it divides by what the function itself divides by")
