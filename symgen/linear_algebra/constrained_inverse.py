"""The constrained inverse of the mass matrix: K = W (W^T G W)^-1 W^T for any null-space basis W.

K f is the acceleration that the force f causes along the constraints.  Only G positive definite on ker B is needed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Protocol

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import wedge
from symgen.linear_algebra.guards import Guard, magnitude
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace, MinorSpace
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matmul, matvec, transpose
from symgen.symbolic.scalar import Scalar

# Of its bound, what an inertia is taken for at least: tested in float32, about the square of what rounding leaves.
REST = Fraction(1, 2**28)


class ConstrainedInertia(Protocol):
    """Solves for accelerations along the constraints."""

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The denominators of K."""

    def solve(self, force: Vector) -> Vector:
        """K f."""


def _diagonal(a: Matrix) -> list[Scalar]:
    return [row[i] for i, row in enumerate(a)]


class Cholesky:
    """L D L^T without pivoting: safe for a symmetric positive definite matrix (Golub and Van Loan, 4.1).

    `scales` are the sizes of what the diagonal entries are summed from, the measure for negligible pivots; the entries
    themselves where they are not given.
    """

    def __init__(self, graph: Graph, a: Matrix, scales: Sequence[Scalar] | None = None) -> None:
        self.graph = graph
        self.scales = _diagonal(a) if scales is None else scales
        self.size = len(a)
        self.lower: list[list[Scalar]] = []
        self.pivots: list[Scalar] = []
        for i in range(self.size):
            scaled: list[Scalar] = []
            for j in range(i):
                scaled.append(a[i][j] - graph.sum(scaled[k] * self.lower[j][k] for k in range(j)))
            row = [value / pivot for value, pivot in zip(scaled, self.pivots, strict=True)]
            self.pivots.append(a[i][i] - graph.sum(x * y for x, y in zip(scaled, row, strict=True)))
            self.lower.append(row)

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The pivots, positive where the matrix is positive definite."""
        pairs = zip(self.pivots, self.scales, strict=True)
        return tuple(Guard(Status.MASS_RANK, pivot, 1, scale=scale, positive=True) for pivot, scale in pairs)

    def solve(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L D L^T x = b."""
        return self.raised([value / pivot for value, pivot in zip(self.lowered(b), self.pivots, strict=True)])

    def lowered(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L y = b."""
        y: list[Scalar] = []
        for i in range(self.size):
            y.append(b[i] - dot(self.graph, self.lower[i], y))
        return tuple(y)

    def raised(self, b: Sequence[Scalar]) -> Vector:
        """The solution of L^T x = b."""
        x = list(b)
        for i in reversed(range(self.size)):
            for j in range(i + 1, self.size):
                x[i] = x[i] - self.lower[j][i] * x[j]
        return tuple(x)


def diagonal_sizes(
    graph: Graph, mass_matrix: Matrix, whole: Callable[[Scalar], bool] = lambda _: False
) -> list[Scalar]:
    """The diagonal entries G_ii, positive; |G_ij|^2 <= G_ii G_jj because G is positive semidefinite.

    What bounds the way of a body behind many turns is many times that way, so that nothing is measured by the bound of
    an entry, but that an entry which is a rest of its terms is none.  One that is `whole` adds up masses and inertias,
    of which there is no rest.
    """
    entries = _diagonal(mass_matrix)
    bounds = magnitude(graph, entries)
    pairs = zip(entries, bounds, strict=True)
    return [g if g is bound or whole(g) else g + bound * REST for g, bound in pairs]


class FreeInertia:
    """No constraints: K = G^-1."""

    def __init__(self, graph: Graph, mass_matrix: Matrix) -> None:
        self._factor = Cholesky(graph, mass_matrix, diagonal_sizes(graph, mass_matrix))
        self.guards = self._factor.guards

    def solve(self, force: Vector) -> Vector:
        """K f = G^-1 f, by L D L^T of G."""
        return self._factor.solve(force)


class MinorInertia:
    """delta = 1 or 2 in closed form.

    delta = 1: K = w w^T / (w^T G w).  delta = 2, with Phi the antisymmetric matrix of minors:
    K = Phi G Phi^T / (1/2 sum_ij (Phi G Phi^T)_ij G_ij).  Dependent rows sum over the row subsets.
    """

    def __init__(self, space: MinorSpace, mass_matrix: Matrix) -> None:
        graph, n = space.graph, space.n
        axes = identity(graph, n)
        full = (1 << n) - 1
        entries = [[graph.zero] * n for _ in range(n)]
        for form in space.forms.forms:
            if space.delta == 1:
                w = [wedge(form, axis).get(full, graph.zero) for axis in axes]
                contribution = [[a * b for b in w] for a in w]
            else:
                once = [wedge(form, axis) for axis in axes]
                phi = tuple(tuple(wedge(mv, axis).get(full, graph.zero) for axis in axes) for mv in once)
                half = matmul(graph, phi, mass_matrix, n)
                contribution = [[dot(graph, half[i], phi[j]) for j in range(n)] for i in range(n)]
            for i in range(n):
                for j in range(n):
                    low, high = min(i, j), max(i, j)
                    entries[i][j] = entries[i][j] + contribution[low][high]
        weight = graph.sum(dot(graph, entries[i], mass_matrix[i]) for i in range(n))
        self._graph = graph
        self._entries: Matrix = tuple(map(tuple, entries))
        self._denominator = weight if space.delta == 1 else weight / 2
        # the minors' own size is judged by the space's guard; here only G on the null space is, in units that cancel
        g = diagonal_sizes(graph, mass_matrix)
        scale = graph.sum(
            value * value * graph.product(g[i] for i in range(n) if not mask >> i & 1)
            for form in space.forms.forms
            for mask, value in form.items()
        )
        guard = Guard(Status.MASS_RANK, self._denominator, 1, scale=scale, directions=space.delta)
        self.guards = (*space.guards, guard)

    def solve(self, force: Vector) -> Vector:
        """K f: one product with the n x n matrix of polynomials, and one division."""
        inverse = 1 / self._denominator
        return tuple(x * inverse for x in matvec(self._graph, self._entries, force))


class BasisInertia:
    """Orthonormal basis F by reflections, then L D L^T of F^T G F."""

    def __init__(self, space: HouseholderSpace, mass_matrix: Matrix) -> None:
        graph, basis, delta = space.graph, space.basis, space.delta
        self._graph, self._basis = graph, basis
        weighted = matmul(graph, mass_matrix, basis, delta)
        self._transposed = transpose(basis, delta)
        projected = matmul(graph, self._transposed, weighted, delta)
        g = diagonal_sizes(graph, mass_matrix)
        scales = [graph.sum(f * f * size for f, size in zip(column, g, strict=True)) for column in self._transposed]
        self._factor = Cholesky(graph, projected, scales)
        self.guards = (*space.guards, *self._factor.guards)

    def solve(self, force: Vector) -> Vector:
        """K f = F (F^T G F)^-1 F^T f."""
        return matvec(self._graph, self._basis, self._factor.solve(matvec(self._graph, self._transposed, force)))
