"""How q, q_dot and q_ddot may change together: what makes a derivative by each of them one along the motion.

On V a change of q keeps the geometric rows, B_g dq = 0; one of q_dot keeps B q_dot = 0, one of q_ddot keeps
B q_ddot + B_dot q_dot = 0, each with what those before it do.  Any 3n numbers become such a change here, and one that
is such a change stays as it is, so that no coordinates are chosen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symgen.symbolic.calculus import jacobian
from symgen.symbolic.matrix import Matrix, add, identity, matmul, matvec, scale, subtract

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation


def constraint_variations(derivation: Derivation) -> Matrix:
    """The projector (3n x 3n) onto the changes of (q, q_dot, q_ddot) that the constraints allow."""
    mechanics, graph, n = derivation.mechanics, derivation.graph, derivation.n
    rows, inverse, projector = mechanics.constraint_jacobian, derivation.space.pseudoinverse, derivation.space.projector
    bias = mechanics.constraint_acceleration_bias(mechanics.qd)
    velocities = matvec(graph, rows, mechanics.qd)
    accelerations = [b + a for b, a in zip(matvec(graph, rows, mechanics.qdd), bias, strict=True)]

    def taken_back(by_row: Matrix, change: Matrix) -> Matrix:
        """B^+ times what a change does to the rows."""
        return matmul(graph, inverse, matmul(graph, by_row, change, n), n)

    none = scale(identity(graph, n), graph.zero)
    has_geometric_rows = bool(mechanics.geometric_jacobian)
    places = derivation.geometric_space.projector if has_geometric_rows else identity(graph, n)
    turned = subtract(none, taken_back(jacobian(graph, velocities, mechanics.q), places))
    by_places, by_rates = jacobian(graph, accelerations, mechanics.q), jacobian(graph, bias, mechanics.qd)
    of_places = subtract(none, add(taken_back(by_places, places), taken_back(by_rates, turned)))
    of_rates = subtract(none, taken_back(by_rates, projector))
    return (
        *((*x, *y, *z) for x, y, z in zip(places, none, none, strict=True)),
        *((*x, *y, *z) for x, y, z in zip(turned, projector, none, strict=True)),
        *((*x, *y, *z) for x, y, z in zip(of_places, of_rates, projector, strict=True)),
    )
