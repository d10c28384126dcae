"""The configuration of a machine whose encoders say some of its coordinates, by Newton's method from one nearby.

g(q) = 0 with the measured coordinates as they are said or, where more are measured than determine the rest, as near to
that as g allows: the stationary points of |S q - q_m|^2 / 2 + mu^T g, by Newton's method for both (Nocedal and Wright,
Numerical Optimization, 18.1), whose steps grow short quadratically however far the encoders disagree.

A step has a fixed count of operations, and so have STEPS_TAKEN of them.  That they led to a solution, and to the one
that the start belongs to, is tested: what is left of g is not above rounding; a second step longer than half of the
first says that the start is not in the neighbourhood in which Newton's method stays (Deuflhard, Newton Methods for
Nonlinear Problems, 2.1), and a determinant of another sign that a singularity lies between: the result may belong to
another assembly mode then.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import Cholesky
from symgen.linear_algebra.guards import LEFT, Guard, magnitude, moved
from symgen.linear_algebra.null_spaces import HouseholderSpace
from symgen.linear_algebra.pivoted import reflected
from symgen.symbolic.calculus import gradient, jacobian
from symgen.symbolic.matrix import Matrix, Vector, dot, matmul, matvec, transpose
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.traverse import substitute

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation

# A first step of 0.2 times the radius of convergence leaves 1e-22 of it after five.
STEPS_TAKEN = 5


class MeasuredConfiguration:
    """q from its measured entries, the others being where to look."""

    def __init__(self, derivation: Derivation) -> None:
        self._derivation, self._graph = derivation, derivation.graph
        self._q, self._space = derivation.mechanics.q, derivation.geometric_space
        self._places = derivation.mechanics.model.measured_places
        self._given, _, _ = derivation.mechanics.measured
        self._determined = len(self._places) == self._space.delta
        # on which side of their singularities the rows are, where they tell that
        self._orientation = self._graph.one
        step, self._guards = self._by_rows() if self._determined else self._by_least_squares()
        self._iterates: list[Vector] = [self._q]
        self._steps: list[Vector] = []
        for _ in range(STEPS_TAKEN):
            self._steps.append(self._at(step, self._iterates[-1]))
            self._iterates.append(self._moved_by(self._steps[-1]))

    @property
    def outputs(self) -> Vector:
        """The configuration."""
        return self._iterates[-1]

    def _moved_by(self, step: Vector) -> Vector:
        """The next iterate, exactly with what is measured where nothing is measured twice.

        It is a number: what is left of the rows there is no place for algebra with what led there.
        """
        held = dict(zip(self._places, self._given, strict=True)) if self._determined else {}
        sums = map(_sum, self._iterates[-1], step)
        return tuple(held[k] if k in held else self._graph.rounded(x) for k, x in enumerate(sums))

    @property
    def guards(self) -> tuple[Guard, ...]:
        """Where rows or what is measured lose rank, at the start and before the last step; which branch; how closed."""
        first, second, *_, last = (dot(self._graph, step, step) for step in self._steps)
        longer, half = second - first / 4, Fraction(1, 2 * LEFT * self._derivation.n)
        before = self._iterates[-2]
        same_side = self._orientation * self._at([self._orientation], before)[0]
        found = [
            *self._guards,
            *(moved(guard, dict(zip(self._q, before, strict=True))) for guard in self._guards),
            Guard(Status.BRANCH, longer, 1, scale=self._graph.one, positive=True, small=True),
            self._closure,
            # half of the digits stood still in the last step: it has brought the others
            Guard(Status.NOT_CLOSED, last, 1, scale=self._graph.const(half), positive=True, small=True),
        ]
        if same_side.constant is None:
            found.append(Guard(Status.BRANCH, same_side, 1, scale=self._graph.one, positive=True))
        return tuple(found)

    def _by_rows(self) -> tuple[Vector, tuple[Guard, ...]]:
        """The step to what is measured that closes the rows by the other coordinates, to the first order."""
        mechanics, n = self._derivation.mechanics, self._derivation.n
        rows = _SolvedRows(self._graph, mechanics.geometric_jacobian, self._places, n)
        self._orientation = rows.orientation
        steps = [x - self._q[k] for x, k in zip(self._given, self._places, strict=True)]
        return rows.solve(steps, [-x for x in mechanics.constraint_residual]), rows.guards

    def _by_least_squares(self) -> tuple[Vector, tuple[Guard, ...]]:
        """Newton's step for q and mu, with mu = (B^+)^T S^T (q_m - S q)."""
        graph, mechanics, n = self._graph, self._derivation.mechanics, self._derivation.n
        space = self._space
        if not isinstance(space, HouseholderSpace):
            space = reflected(graph, mechanics.geometric_jacobian, n, self._derivation.generic.geometric_rank)
        pull = [graph.zero] * n
        for x, k in zip(self._given, self._places, strict=True):
            pull[k] = x - self._q[k]
        multipliers = space.lift_transposed(tuple(pull))
        held = [graph.symbol(f"multiplier {k}") for k in range(len(multipliers))]
        curved = gradient(graph, dot(graph, held, mechanics.constraint_residual), self._q)
        bent = substitute(graph, [x for row in jacobian(graph, curved, self._q) for x in row],
                          dict(zip(held, multipliers, strict=True)))  # fmt: skip
        hessian = tuple(
            tuple(bent[n * i + j] + (1 if i == j and i in self._places else 0) for j in range(n)) for i in range(n)
        )
        basis, delta = space.basis, space.delta
        along = transpose(basis, delta)
        # in directions of length 1 a measured coordinate turns by no more than 1
        factor = Cholesky(graph, matmul(graph, along, matmul(graph, hessian, basis, delta), delta), [graph.one] * delta)
        least = [-x for x in space.lift(mechanics.constraint_residual)]
        rest = [a - b for a, b in zip(pull, matvec(graph, hessian, least), strict=True)]
        free = matvec(graph, basis, factor.solve(matvec(graph, along, tuple(rest))))
        steep = (replace(guard, status=Status.MEASURED_RANK) for guard in factor.guards)
        return tuple(map(_sum, least, free)), (*space.guards, *steep)

    @property
    def _closure(self) -> Guard:
        """What is left of g, beside what rounding leaves of its terms and of the coordinates."""
        graph, mechanics, last = self._graph, self._derivation.mechanics, self._iterates[-1]
        residual = mechanics.constraint_residual
        terms = magnitude(graph, residual)
        slopes = [magnitude(graph, row) for row in mechanics.geometric_jacobian]
        sizes = [graph.function("abs", (x,)) for x in self._q]
        scales = [term + dot(graph, row, sizes) for term, row in zip(terms, slopes, strict=True)]
        left = self._at([*residual, *scales], last)
        open_, scale = left[: len(residual)], left[len(residual) :]
        return Guard(Status.NOT_CLOSED, dot(graph, open_, open_), 2, scale=dot(graph, scale, scale), small=True)

    def _at(self, scalars: Sequence[Scalar], place: Vector) -> Vector:
        """The same at another configuration."""
        return tuple(substitute(self._graph, scalars, dict(zip(self._q, place, strict=True))))


class _SolvedRows:
    """Rows solved for the coordinates that are not measured, where as many are as there are directions."""

    def __init__(self, graph: Graph, rows: Matrix, places: Sequence[int], n: int) -> None:
        self._graph, self._rows, self._places = graph, rows, places
        self._free = [k for k in range(n) if k not in places]
        block = tuple(tuple(row[k] for k in self._free) for row in rows)
        self._space = reflected(graph, block, len(self._free), len(self._free))
        # rows that lose rank themselves leave the rest open, too: telling that apart takes them all once more
        self.guards = tuple(replace(guard, status=Status.MEASURED_RANK) for guard in self._space.guards)

    @property
    def orientation(self) -> Scalar:
        """On which side of its singularities the block is; 1 where rows depend on each other and do not tell."""
        regular = len(self._rows) == len(self._free)
        return self._space.reflections.determinant_sign if regular else self._graph.one

    def solve(self, given: Sequence[Scalar], right: Sequence[Scalar]) -> Vector:
        """x with B x = right whose measured entries are those given."""
        held = [dot(self._graph, [row[k] for k in self._places], given) for row in self._rows]
        found = self._space.lift(tuple(a - b for a, b in zip(right, held, strict=True)))
        x = dict(zip(self._places, given, strict=True)) | dict(zip(self._free, found, strict=True))
        return tuple(x[k] for k in range(len(x)))


def _sum(a: Scalar, b: Scalar) -> Scalar:
    return a + b
