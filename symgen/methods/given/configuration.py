"""The configuration with given values of functions x(q), of measured coordinates or of a task, by Newton's method.

g(q) = 0 with these functions as they are given or, where more are given than determine the rest, as near to that as g
allows: the stationary points of |x(q) - x|^2 / 2 + mu^T g, by Newton's method for both (Nocedal and Wright, Numerical
Optimization, 18.1), whose steps grow short quadratically however far what is given disagrees.

A step has a fixed count of operations, and so have STEPS_TAKEN of them.  That they led to a solution, and to the one
that the start belongs to, is tested: what is left of the rows is not above rounding; a second step longer than half of
the first says that the start is not in the neighbourhood in which Newton's method stays (Deuflhard, Newton Methods for
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
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.methods.given.functions import Given
from symgen.symbolic.calculus import gradient, jacobian
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, add, dot, matmul, matvec, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute

if TYPE_CHECKING:
    from symgen.methods.derivation import Derivation

# A first step of 0.2 times the radius of convergence leaves 1e-22 of it after five.
STEPS_TAKEN = 5


class GivenConfiguration:
    """q from what is given, the coordinates themselves being where to look."""

    def __init__(self, derivation: Derivation, given: Given) -> None:
        self._derivation, self._graph, self._given = derivation, derivation.graph, given
        self._q, self._space = derivation.mechanics.q, derivation.geometric_space
        met = len(given.functions) <= self._space.delta
        named = [k for k, place in enumerate(given.places) if place >= 0]
        # coordinates that are given are known; what else is given adds rows
        self._held = {given.places[k]: given.values[k] for k in named} if met else {}
        others = [k for k in range(len(given.functions)) if k not in named] if met else []
        self._open = self._differences(others)
        self._rows: Matrix = (*derivation.mechanics.geometric_jacobian, *(given.slopes[k] for k in others))
        # on which side of their singularities the rows are, where they tell that
        self._orientation = self._graph.one
        if met:
            step, self._last_guards = first, self._first_guards = self._by_rows()
        else:
            step, self._last_guards = self._by_least_squares(curved=True)
            first, self._first_guards = self._by_least_squares(curved=False)
        self._iterates: list[Vector] = [self._q]
        self._steps: list[Vector] = []
        for taken in range(STEPS_TAKEN):
            self._steps.append(self._at(step, self._iterates[-1]) if taken else first)
            self._iterates.append(self._moved_by(self._steps[-1]))

    @property
    def outputs(self) -> Vector:
        """The configuration."""
        return self._iterates[-1]

    def _differences(self, which: Sequence[int]) -> Vector:
        """What the functions have beyond what is given."""
        given = self._given
        return tuple(given.functions[k] - given.values[k] for k in which)

    def _moved_by(self, step: Vector) -> Vector:
        """The next iterate, exactly with the coordinates that are given where nothing is given twice.

        It is a number: what is left of the rows there is no place for algebra with what led there.
        """
        sums = map(_sum, self._iterates[-1], step)
        return tuple(self._held[k] if k in self._held else self._graph.rounded(x) for k, x in enumerate(sums))

    @property
    def guards(self) -> tuple[Guard, ...]:
        """Where rows or what is given lose rank, at the start and before the last step; which branch; how closed."""
        first, second, *_, last = (dot(self._graph, step, step) for step in self._steps)
        longer, half = second - first / 4, Fraction(1, 2 * LEFT * self._derivation.n)
        before = self._iterates[-2]
        same_side = self._orientation * self._at([self._orientation], before)[0]
        guards = [
            *self._first_guards,
            *(moved(guard, dict(zip(self._q, before, strict=True))) for guard in self._last_guards),
            Guard(Status.BRANCH, longer, 1, scale=self._graph.one, positive=True, small=True),
            *self._closure,
            # half of the digits stood still in the last step: it has brought the others
            Guard(Status.NOT_CLOSED, last, 1, scale=self._graph.const(half), positive=True, small=True),
        ]
        if same_side.constant is None:
            guards.append(Guard(Status.BRANCH, same_side, 1, scale=self._graph.one, positive=True))
        return tuple(guards)

    def _by_rows(self) -> tuple[Vector, tuple[Guard, ...]]:
        """The step to what is given that closes the rows by the other coordinates, to the first order."""
        rank = self._derivation.generic.geometric_rank + len(self._given.functions)
        rows = _SolvedRows(self._graph, self._rows, tuple(self._held), self._derivation.n, rank, self._given.status)
        self._orientation = rows.orientation
        steps = [x - self._q[k] for k, x in self._held.items()]
        return rows.solve(steps, [-x for x in self._residual]), rows.guards

    @property
    def _residual(self) -> Vector:
        """What is left of g, and of what is given besides."""
        return (*self._derivation.mechanics.constraint_residual, *self._open)

    def _by_least_squares(self, curved: bool) -> tuple[Vector, tuple[Guard, ...]]:
        """Newton's step for q and mu, with mu = (B^+)^T X^T (x - x(q)), X the derivatives of x.

        Where it starts x - x(q) is the way to go, not what is left of it at the end: it would bend the first step the
        wrong way, so that this one is Gauss and Newton's, not `curved` by mu.
        """
        graph, mechanics, n, given = self._graph, self._derivation.mechanics, self._derivation.n, self._given
        space = self._space
        if not isinstance(space, HouseholderSpace):
            space = reflected(graph, mechanics.geometric_jacobian, n, self._derivation.generic.geometric_rank)
        beyond = self._differences(range(len(given.functions)))
        pull = tuple(-x for x in matvec(graph, transpose(given.slopes, n), beyond))
        along = [[row[j] for row in given.slopes] for j in range(n)]
        hessian = tuple(tuple(dot(graph, along[i], along[j]) for j in range(n)) for i in range(n))
        if curved:
            hessian = add(hessian, self._curvature((*space.lift_transposed(pull), *beyond)))
        basis, delta = space.basis, space.delta
        across = transpose(basis, delta)
        core = matmul(graph, across, matmul(graph, hessian, basis, delta), delta)
        factor = Cholesky(graph, core, [self._steepest] * delta)
        least = [-x for x in space.lift(mechanics.constraint_residual)]
        rest = [a - b for a, b in zip(pull, matvec(graph, hessian, least), strict=True)]
        free = matvec(graph, basis, factor.solve(matvec(graph, across, tuple(rest))))
        steep = (replace(guard, status=given.status) for guard in factor.guards)
        return tuple(map(_sum, least, free)), (*space.guards, *steep)

    def _curvature(self, factors: Vector) -> Matrix:
        """The second derivatives of rows and functions, each times its factor."""
        graph = self._graph
        held = [graph.stand_in(f"multiplier {k}") for k in range(len(factors))]
        functions = (*self._derivation.mechanics.constraint_residual, *self._given.functions)
        slopes = jacobian(graph, gradient(graph, dot(graph, held, functions), self._q), self._q)
        known = dict(zip(held, factors, strict=True))
        return tuple(tuple(substitute(graph, row, known)) for row in slopes)

    @property
    def _steepest(self) -> Scalar:
        """What pivots are compared with: the square of how fast functions change in directions of length 1, at most."""
        given, graph = self._given, self._graph
        # of coordinates each by no more than 1
        return graph.one if min(given.places) >= 0 else graph.sum(x * x for row in given.slopes for x in row)

    @property
    def _closure(self) -> tuple[Guard, ...]:
        """What is left of the rows, beside what rounding leaves of their terms and of the coordinates."""
        graph, last = self._graph, self._iterates[-1]
        if not self._residual:
            return ()
        sizes = [graph.function("abs", (x,)) for x in self._q]
        slopes = [magnitude(graph, row) for row in self._rows]
        terms = magnitude(graph, self._residual)
        scales = [term + dot(graph, row, sizes) for term, row in zip(terms, slopes, strict=True)]
        left = self._at([*self._residual, *scales], last)
        open_, scale = left[: len(scales)], left[len(scales) :]
        return (Guard(Status.NOT_CLOSED, dot(graph, open_, open_), 2, scale=dot(graph, scale, scale), small=True),)

    def _at(self, scalars: Sequence[Scalar], place: Vector) -> Vector:
        """The same at another configuration."""
        return tuple(substitute(self._graph, scalars, dict(zip(self._q, place, strict=True))))


class _SolvedRows:
    """Rows, of this rank with what is given, solved for the other coordinates: by the least change of them."""

    def __init__(self, graph: Graph, rows: Matrix, places: Sequence[int], n: int, rank: int, status: Status) -> None:
        self._graph, self._rows, self._places = graph, rows, places
        self._free = [k for k in range(n) if k not in places]
        block = tuple(tuple(row[k] for k in self._free) for row in rows)
        self._space = reflected(graph, block, len(self._free), rank - len(places))
        # rows that lose rank themselves leave the rest open, too: telling that apart takes them all once more
        self.guards = tuple(replace(guard, status=status) for guard in self._space.guards)

    @property
    def orientation(self) -> Scalar:
        """On which side of its singularities the block is; 1 where no determinant tells.

        Rows that depend on each other have none, and where directions stay open there are ways around singularities.
        """
        regular = len(self._rows) == len(self._free)
        return self._space.reflections.determinant_sign if regular else self._graph.one

    def solve(self, given: Sequence[Scalar], right: Sequence[Scalar]) -> Vector:
        """x with B x = right whose entries at these places are those given."""
        held = [dot(self._graph, [row[k] for k in self._places], given) for row in self._rows]
        free_entries = self._space.lift(tuple(a - b for a, b in zip(right, held, strict=True)))
        x = dict(zip(self._places, given, strict=True)) | dict(zip(self._free, free_entries, strict=True))
        return tuple(x[k] for k in range(len(x)))


def _sum(a: Scalar, b: Scalar) -> Scalar:
    return a + b
