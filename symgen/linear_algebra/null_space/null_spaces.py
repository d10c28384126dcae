"""Two ways to the null space of B: by minors (`MinorSpace`) and by Householder reflections (`HouseholderSpace`).

Both are valid wherever B has its generic rank, and choose no coordinates, columns or rows: the minors enter
symmetrically, the reflections take the rows as they come.  The reflections need independent rows (rho = r).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Protocol

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import ActuationForms, RowForms, few_minors, small_family
from symgen.linear_algebra.guards import Guard, beside_lengths
from symgen.linear_algebra.reflections import Reflections
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matvec, subtract_vectors, transpose
from symgen.symbolic.scalar import Scalar

# Minors of B up to which a null space is built from them; beyond, Householder reflections are cheaper anyway.
MINOR_LIMIT = 300
# Squared pivots up to which they are multiplied as they are.
LONGEST_PRODUCT = 6
# Of the squared lengths of all rows together, what one of them is taken for at least: 1e-6 of their length.
VANISHING = Fraction(1, 2**40)


class InputEquations(Protocol):
    """The equations of the inputs along a null space: by determinants, or by reflections where these are too many."""

    @property
    def single(self) -> bool:
        """Whether one determinant is divided by."""

    @property
    def minors(self) -> frozenset[Scalar]:
        """What is small where the inputs lose an effect, besides the denominator."""

    def cancelled(self, cancel: Callable[[Scalar], Scalar]) -> InputEquations:
        """The same with a single determinant multiplied out."""

    def weighted(self, weights: Sequence[Scalar]) -> InputEquations:
        """The same with weights of the inputs."""

    @property
    def rank_measures(self) -> list[Scalar]:
        """Squared lengths that are divided by, none of which vanishes where the inputs have their rank."""

    def solve(self, force: Vector) -> Vector:
        """The inputs of least norm."""

    def internal_force(self) -> tuple[Vector, Scalar]:
        """Of one input more than directions: inputs that move nothing, and their squared weighted norm.

        Their signs are those of (-1)^k det[A without column k] for the columns A of the equations.
        """

    def square(self) -> Scalar:
        """The sum of the squared determinants."""

    def denominator(self) -> Scalar:
        """What vanishes where a rank drops."""


class NullSpace(Protocol):
    """What the derivations need to know of the constraints at a configuration."""

    graph: Graph
    rows: Matrix
    n: int
    delta: int

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The denominators that vanish where the rank of B drops."""

    @property
    def size(self) -> Scalar:
        """What det(B B^T) is measured by: the product of the squared lengths of the rows (Hadamard's bound)."""

    @property
    def projector(self) -> Matrix:
        """N_B (21), n x n."""

    @property
    def pseudoinverse(self) -> Matrix:
        """B^+, n x r."""

    def project(self, x: Vector) -> Vector:
        """N_B x."""

    def lift(self, a: Vector) -> Vector:
        """B^+ a."""

    def lift_transposed(self, x: Vector) -> Vector:
        """(B^+)^T x."""

    def actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[InputEquations, Restriction]:
        """What solves for inputs, and the map that brings forces to where they live."""

    def listed_actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[ActuationForms, Restriction]:
        """The same by determinants, however many they are."""


def without(x: Vector, locked: Sequence[int]) -> Vector:
    """x with 0 at the places of coordinates that rows of their own lock."""
    return tuple(entry.graph.zero if j in locked else entry for j, entry in enumerate(x)) if locked else x


def has_few_minors(rows: Matrix, rank: int) -> bool:
    """Whether a null space may be built from the minors of rows of this rank."""
    return few_minors(rows, rank, MINOR_LIMIT)


class Restriction:
    """Brings a generalized force to the space in which the input equations are solved."""

    def __init__(
        self, rank: int, delta: int, reflections: Reflections | None = None, locked: Sequence[int] = ()
    ) -> None:
        self._rank, self._delta = rank, delta
        self._reflections = reflections
        self._locked = locked

    def orientation(self, graph: Graph) -> Scalar:
        """The sign between determinants of columns brought there and det[M_J, B^T], of independent rows.

        With B^T = Q R the latter is (-1)^(rank delta) det Q det R det(F^T M_J).
        """
        sign = graph.const(-1 if self._rank * self._delta & 1 else 1)
        return sign if self._reflections is None else sign * self._reflections.determinant_sign

    def __call__(self, force: Vector) -> Vector:
        """The force itself, or its components F^T f along the orthonormal null-space basis."""
        if self._reflections is None:
            return force
        return self._reflections.apply_transposed(without(force, self._locked))[self._rank :]


class MinorSpace:
    """By the minors of B: polynomials and one division."""

    def __init__(
        self, graph: Graph, rows: Matrix, n: int, rank: int, shortened: Callable[[Scalar], Scalar] | None = None
    ) -> None:
        self.graph, self.rows, self.n, self.rank = graph, rows, n, rank
        self.delta = n - rank
        self.forms = RowForms(graph, rows, n, rank, shortened)

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The sum of the squared minors, of dependent rows taken at one length; none without constraints."""
        if self.rank == 0:
            return ()
        if self.rank < len(self.rows):
            measure, bound = self.forms.at_one_length(self.lengths), self.graph.product(self.lengths)
            return (Guard(Status.CONSTRAINT_RANK, measure, 2, scale=bound, directions=self.rank),)
        return (Guard(Status.CONSTRAINT_RANK, self.forms.square, 2, scale=self.size, directions=self.rank),)

    @cached_property
    def squares(self) -> list[Scalar]:
        """The squared lengths of the rows."""
        return [dot(self.graph, row, row) for row in self.rows]

    @cached_property
    def lengths(self) -> list[Scalar]:
        """The same of rows that depend on each other, none of them 0: one that vanishes is missed by nothing."""
        least = self.graph.sum(self.squares) * VANISHING
        return [square + least for square in self.squares]

    @cached_property
    def size(self) -> Scalar:
        """What that sum is measured by: over the row subsets of size rho, the products of the squared lengths."""
        return self.graph.sum(self.graph.product(self.squares[k] for k in subset) for subset in self.forms.subsets)

    @cached_property
    def projector(self) -> Matrix:
        """N_B (21), n x n."""
        return self.forms.projector()

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B^+, n x r."""
        return self.forms.pseudoinverse()

    def project(self, x: Vector) -> Vector:
        """N_B x."""
        return matvec(self.graph, self.projector, x)

    def lift(self, a: Vector) -> Vector:
        """B^+ a."""
        return matvec(self.graph, self.pseudoinverse, a)

    def lift_transposed(self, x: Vector) -> Vector:
        """(B^+)^T x."""
        return matvec(self.graph, transpose(self.pseudoinverse, len(self.rows)), x)

    def actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[InputEquations, Restriction]:
        """By determinants where these are few, by reflections otherwise."""
        if small_family(self.forms.forms, inputs, degree):
            return self.listed_actuation(inputs, degree)
        from symgen.linear_algebra.null_space.pivoted import reflected  # which is made of what is here

        return reflected(self.graph, self.rows, self.n, self.rank).actuation(inputs, degree)

    def listed_actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[ActuationForms, Restriction]:
        """By determinants of all coordinates: forces stay as they are."""
        return ActuationForms(self.forms, inputs, degree), Restriction(self.rank, self.delta)


class HouseholderSpace:
    """By the orthogonal factorisation B^T = Q R.

    `locked` are coordinates that rows without others lock wherever all rows are independent: N_B is 0 there, exactly.
    """

    def __init__(
        self, graph: Graph, rows: Matrix, n: int, everywhere: bool = False, locked: Sequence[int] = ()
    ) -> None:
        self.graph, self.rows, self.n, self.locked = graph, rows, n, locked
        self.rank = len(rows)
        self.delta = n - self.rank
        self.reflections = Reflections(graph, rows, n, everywhere)

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """What the rows before leave of each row, beside the lengths of what leaves it."""
        beside = self.reflections.combinations(self.lengths)
        return beside_lengths(Status.CONSTRAINT_RANK, self.reflections.pivots, beside)

    @cached_property
    def volume(self) -> Guard:
        """The same as one denominator, det(B B^T), for what multiplies it by others or tells causes by it."""
        if self.rank > LONGEST_PRODUCT:
            # quotients stay in the range of a float32 however many rows there are
            quotients = [pivot / length for pivot, length in zip(self.reflections.pivots, self.lengths, strict=True)]
            measure, size = self.graph.product(quotients), self.graph.one
        else:
            measure, size = self.graph.product(self.reflections.pivots), self.size
        return Guard(Status.CONSTRAINT_RANK, measure, 2, scale=size, directions=self.rank)

    @cached_property
    def lengths(self) -> list[Scalar]:
        """The squared lengths of the rows."""
        return [dot(self.graph, row, row) for row in self.rows]

    @cached_property
    def size(self) -> Scalar:
        """What det(B B^T) is measured by: the product of the squared lengths of the rows."""
        return self.graph.product(self.lengths)

    @property
    def square(self) -> Scalar:
        """det(B B^T)."""
        return self.graph.product(self.reflections.pivots)

    @property
    def rank_measures(self) -> list[Scalar]:
        """Squared lengths that are divided by: of what rows before leave of each, 0 only where the rank drops."""
        return self.reflections.pivots

    @cached_property
    def basis(self) -> Matrix:
        """An orthonormal null-space basis F (n x delta): the last columns of Q."""
        units = identity(self.graph, self.n)[self.rank :]
        return transpose(tuple(without(self.reflections.apply(e), self.locked) for e in units), self.n)

    @cached_property
    def projector(self) -> Matrix:
        """N_B = F F^T (21), n x n, exactly symmetric."""
        graph, n = self.graph, self.n
        upper = {(i, j): dot(graph, self.basis[i], self.basis[j]) for i in range(n) for j in range(i, n)}
        return tuple(tuple(upper[min(i, j), max(i, j)] for j in range(n)) for i in range(n))

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B^+, n x r."""
        return transpose(tuple(self.lift(e) for e in identity(self.graph, self.rank)), self.n)

    def project(self, x: Vector) -> Vector:
        """N_B x: reflected, without its components along the rows, and reflected back."""
        zeros = (self.graph.zero,) * self.rank
        along = self.reflections.apply_transposed(without(x, self.locked))[self.rank :]
        return without(self.reflections.apply((*zeros, *along)), self.locked)

    def lift(self, a: Vector) -> Vector:
        """Solve R^T y = a forwards, then Q [y; 0]."""
        y: list[Scalar] = []
        for k, column in enumerate(self.reflections.triangle):
            y.append((a[k] - dot(self.graph, column[:k], y)) / column[k])
        return self.reflections.apply((*y, *(self.graph.zero,) * self.delta))

    def lift_transposed(self, x: Vector) -> Vector:
        """Solve R y = (Q^T x)_1 backwards."""
        head = list(self.reflections.apply_transposed(x)[: self.rank])
        y: list[Scalar] = [self.graph.zero] * self.rank
        for k in reversed(range(self.rank)):
            y[k] = head[k] / self.reflections.triangle[k][k]
            for i in range(k):
                head[i] = head[i] - self.reflections.triangle[k][i] * y[k]
        return tuple(y)

    @property
    def restriction(self) -> Restriction:
        """Components of a force along the null space, F^T f."""
        return Restriction(self.rank, self.delta, self.reflections, self.locked)

    def actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[InputEquations, Restriction]:
        """By determinants of F^T M where these are few, by reflections of it otherwise."""
        restriction = self.restriction
        columns = [restriction(column) for column in inputs]
        if small_family([[0]], columns, degree):
            return ActuationForms(RowForms(self.graph, (), self.delta, 0), columns, degree), restriction
        from symgen.linear_algebra.reflected_inputs import ReflectedInputs  # which is made of what is here

        return ReflectedInputs(self.graph, columns, self.delta, degree, self.reflections.everywhere), restriction

    def listed_actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[ActuationForms, Restriction]:
        """By determinants of F^T M, however many they are."""
        restriction = self.restriction
        free = RowForms(self.graph, (), self.delta, 0)
        return ActuationForms(free, [restriction(column) for column in inputs], degree), restriction


def rests_on_rank(space: NullSpace) -> bool:
    """Whether results hold where B has its rank even if nothing of B is left in them: where rows lock something."""
    return isinstance(space, HouseholderSpace) and bool(space.locked)


def residual(space: NullSpace, force: Vector, inputs: Sequence[Vector], u: Vector) -> Vector:
    """N_B (f - M u)."""
    graph = space.graph
    supplied = tuple(graph.sum(column[i] * x for column, x in zip(inputs, u, strict=True)) for i in range(space.n))
    return space.project(subtract_vectors(force, supplied))
