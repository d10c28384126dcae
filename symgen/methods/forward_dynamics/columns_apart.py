"""Equations of motion in velocities for which the columns of B of links in line are not all but the same.

The tip of a leg of two links moves by l_1 n(a) a_dot + l_2 n(b) b_dot, n(a) = (-sin a, cos a), in absolute angles.
Where the leg is all but stretched both columns point the same way; what they differ by, which bears the load along it,
is lost in the rounding of their entries, and no solver behind them brings it back.  With b_dot = v - t a_dot and
t = cos(b - a) l_1/l_2 it stands in a column of its own, l_1 sin(a - b) (-cos b, -sin b), to all digits of the knee.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from symgen.mechanics.never_zero import Definite
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.schur import MassMatrixFactor, OrderedCholesky, elimination_order
from symgen.records import dataclass
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class Share:
    """What is taken of the column of a link beside that of the link that carries it."""

    child: int
    amount: Scalar


class ColumnsApart(Problem):
    """The same equations for x with y_ddot = T x; `shares` are those of T, by the coordinate of the carrying link.

    `factor` is that of T^T G T.
    """

    # a column that is as short as the sine of a knee brings rows into line where a leg is stretched
    rows_in_line = True

    def __init__(self, problem: Problem, shares: Mapping[int, Share], rows: Matrix) -> None:
        super().__init__(problem.mechanics, problem.guards)
        self._problem, self._shares, self._rows = problem, shares, rows
        self.factor: MassMatrixFactor = _Turned(problem, shares)

    @cached_property
    def mass_matrix(self) -> Matrix:
        """T^T G T."""
        half = [self._along(row) for row in self._problem.mass_matrix]
        return tuple(zip(*(self._along(column) for column in zip(*half, strict=True)), strict=True))

    @property
    def rows(self) -> Matrix:
        """B T."""
        return self._rows

    @cached_property
    def force(self) -> Vector:
        """T^T f."""
        return self._along(self._problem.force)

    def brought_back(self, motion: Motion) -> Motion:
        """With T x for x."""
        accelerations = list(motion.accelerations)
        for parent, share in self._shares.items():
            accelerations[share.child] = accelerations[share.child] - share.amount * motion.accelerations[parent]
        return replace(motion, accelerations=tuple(accelerations))

    def _along(self, row: Sequence[Scalar]) -> Vector:
        """row T."""
        entries = list(row)
        for parent, share in self._shares.items():
            entries[parent] = row[parent] - share.amount * row[share.child]
        return tuple(entries)


class _Turned(OrderedCholesky):
    """T^T G T = (T^T L) D (T^T L)^T: where children come before their parents T^T L is triangular, as L is.

    So D, and what is told of masses by it, stay what they are; T^T G T has the inertia of a heavy link in each entry.
    """

    def __init__(self, problem: Problem, shares: Mapping[int, Share]) -> None:
        super().__init__(problem)
        place = {j: i for i, j in enumerate(self.order)}
        lower = list(self._factor.lower)
        for parent, share in shares.items():
            row, k = lower[place[parent]], place[share.child]
            # beside the pivot, where what both columns hold of outer links cancels
            (rest,) = problem.multiplied_out([(row[k] - share.amount) * self.pivots[k]])
            before = (x - share.amount * y for x, y in zip(row[:k], self._factor.lower[k], strict=True))
            lower[place[parent]] = [*before, rest / self.pivots[k], *row[k + 1 :]]
        self._factor.lower = lower


def apart(problem: Problem) -> ColumnsApart | None:
    """The equations of a system in absolute angles with each link's column beside that of the link it carries.

    None where no two links end in a loop of the plane.
    """
    mechanics = problem.mechanics
    if mechanics.change is None or not problem.rows:
        return None
    definite, order = Definite(mechanics), elimination_order(problem.mass_matrix)
    columns = [list(column) for column in zip(*problem.rows, strict=True)]
    shares: dict[int, Share] = {}
    for child, parent in enumerate(mechanics.change.parents):
        if parent is None or parent in shares or order.index(child) > order.index(parent):
            continue
        decomposition = _beside(definite, *(tuple(row[j] for row in problem.rows) for j in (parent, child)))
        if decomposition is not None:
            amount, columns[parent] = decomposition
            shares[parent] = Share(child, amount)
    return ColumnsApart(problem, shares, tuple(zip(*columns, strict=True))) if shares else None


def _beside(definite: Definite, own: Vector, other: Vector) -> tuple[Scalar, list[Scalar]] | None:
    """t and own - t other, orthogonal to `other` in each of the planes in which both move a point along a circle."""
    graph, rest, shares = own[0].graph, list(own), set[Scalar]()
    left = [i for i, x in enumerate(other) if not x.is_zero]
    while left:
        i = left.pop(0)
        for k in left:
            u, v = (own[i], own[k]), (other[i], other[k])
            square = dot(graph, v, v)
            if definite.holds(square):
                left.remove(k)
                break
        else:
            return None
        number, powers = graph.products.monomial(square)
        shares.add(graph.products.quotient(dot(graph, u, v), powers, number))
        across = graph.products.quotient(v[0] * u[1] - v[1] * u[0], powers, number)
        rest[i], rest[k] = -v[1] * across, v[0] * across
    if len(shares) != 1 or next(iter(shares)).is_zero:
        return None
    return shares.pop(), rest
