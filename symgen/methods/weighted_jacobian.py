"""Gradients J^T w by the Jacobian and products with it, for where one reverse sweep loses digits.

A sweep carries weights through all that u or q_ddot is made of, and what cancels between two entries of J w is worked
out to the digits of the larger one.  J has its entries one by one, with what cancels in each of them cancelled.  A
product with second derivatives is the derivative of that along its direction.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.methods.admission import ByTheorem
from symgen.methods.method import INPUTS, Candidate, Method
from symgen.methods.table import Use, methods
from symgen.methods.workspace import Workspace
from symgen.model.quantities import DIRECTION, MOTIONS, ROWS, FurtherName
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along, jacobian
from symgen.symbolic.matrix import dot

# Of what, by which symbols, and the argument that holds the weights.
_OF: dict[str, tuple[str, FurtherName]] = {
    "inverse_dynamics_gradient": (INPUTS, "w_u"),
    "forward_dynamics_gradient": (MOTIONS[0], "w_qdd"),
    "inverse_dynamics_hessian_product": (INPUTS, "w_u"),
}


@dataclass(frozen=True, slots=True)
class _WeightedJacobian(ByTheorem):
    """`theorem` says why it is valid wherever the function itself is."""

    theorem: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The gradient (a number for each symbol), or why there is none."""
        function, argument = _OF[quantity]
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
        mechanics, graph = best.system.mechanics, best.system.mechanics.graph
        by = mechanics.motion if function == INPUTS else (*mechanics.q, *mechanics.qd, *mechanics.u)
        slopes = jacobian(graph, best.derived.outputs, by)
        (weights,) = mechanics.further(argument)
        outputs = tuple(dot(graph, [row[k] for row in slopes], weights) for k in range(len(by)))
        if DIRECTION in ROWS[quantity].arguments:
            (direction,) = mechanics.further(DIRECTION)
            outputs = tuple(derivative_along(graph, outputs, dict(zip(by, direction, strict=True))))
        return replace(best, derived=replace(best.derived, name=quantity, shape=(len(by),), outputs=outputs))


WEIGHTED_JACOBIAN: Method = _WeightedJacobian("it divides by what the function itself divides by")
