"""The null space of B where columns are the same up to a constant factor, such as those of collinear joints.

With b_j = c_j b over a family of such columns, B x sees sum_j c_j x_j alone: across it, along the vectors orthogonal to
c, ker B is constant.  What is left are as many columns as there are families, at the length |c| b each, for which the
null space is found as usual.  Where the rank is their number, N_B is constant; reflections of all columns would leave
rounding errors of it, and what loads the constraints, such as weights, would come through these.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from math import isfinite, isqrt

from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace, Restriction
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.records import dataclass
from symgen.symbolic.evaluate import Evaluator, inner_point
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, identity, transpose
from symgen.symbolic.scalar import Scalar

# What rounding may leave of a ratio.
ROUNDING_OF_RATIOS = 1e-9
# The largest denominator of a ratio.
LARGEST_DENOMINATOR = 10_000


@dataclass(frozen=True, slots=True)
class Across:
    """A constant vector of the null space: across the factors of `members`, or along one coordinate that is free.

    Members but the last have their factors c_j there, the last what makes the vector orthogonal to all factors.
    """

    members: tuple[int, ...]
    factors: tuple[Fraction, ...]
    sign: int = 1

    @property
    def entries(self) -> dict[int, Fraction]:
        """The vector by coordinate, not of length 1."""
        if len(self.members) == 1:
            return {self.members[0]: Fraction(self.sign)}
        last = -_square(self.factors[:-1]) / self.factors[-1]
        return {j: self.sign * w for j, w in zip(self.members, (*self.factors[:-1], last), strict=True)}

    @property
    def square(self) -> Fraction:
        """The square of its length."""
        return _square(tuple(self.entries.values()))

    def dot(self, graph: Graph, x: Vector) -> Scalar:
        """The product with x: what members have in common is taken off before anything is added."""
        *before, last = self.members
        if not before:
            return x[last] * self.sign
        *factors, of_last = self.factors
        pairs = zip(before, factors, strict=True)
        return graph.sum((x[j] - x[last] * (c / of_last)) * (self.sign * c) for j, c in pairs)


@dataclass(frozen=True, slots=True)
class ColumnFamily:
    """Columns that are c_j times the first of them."""

    members: tuple[int, ...]
    factors: tuple[Fraction, ...]

    @property
    def square(self) -> Fraction:
        """|c|^2."""
        return _square(self.factors)

    @property
    def entries(self) -> dict[int, Fraction]:
        """c by coordinate."""
        return dict(zip(self.members, self.factors, strict=True))


def _square(values: Sequence[Fraction]) -> Fraction:
    return sum((x * x for x in values), Fraction(0))


def families(rows: Matrix, n: int) -> tuple[ColumnFamily, ...]:
    """The columns that are not 0, gathered by their directions, in the order of their first members.

    A point in double precision finds what may be proportional; equal functions decide.
    """
    columns = [tuple(row[j] for row in rows) for j in range(n)]
    alike: dict[tuple[int, ...], list[int]] = {}
    for j, column in enumerate(columns):
        if places := tuple(i for i, x in enumerate(column) if not x.is_zero):
            alike.setdefault(places, []).append(j)
    compared = [j for group in alike.values() if len(group) > 1 for j in group]
    values = dict(zip(compared, _values([columns[j] for j in compared]), strict=True))
    column_families: list[dict[int, Fraction]] = []
    for places, group in alike.items():
        own: list[dict[int, Fraction]] = []
        for j in group:
            for family in own:
                first = next(iter(family))
                factor = _factor(values[first], values[j], places[0])
                if factor is not None and _is_multiple(columns[j], columns[first], factor):
                    family[j] = factor
                    break
            else:
                own.append({j: Fraction(1)})
        column_families += own
    column_families.sort(key=lambda family: next(iter(family)))
    return tuple(ColumnFamily(tuple(family), tuple(family.values())) for family in column_families)


def _values(columns: Sequence[Vector]) -> list[list[float]]:
    """The columns at a random point."""
    flat = [entry for column in columns for entry in column]
    if not flat:
        return []
    at = Evaluator(flat)(inner_point(flat))
    r = len(columns[0])
    return [list(at[start : start + r]) for start in range(0, len(at), r)]


def _factor(one: Sequence[float], other: Sequence[float], place: int) -> Fraction | None:
    """What the second column may be of the first."""
    if not one[place] or not isfinite(ratio := other[place] / one[place]) or not ratio:
        return None
    factor = Fraction(ratio).limit_denominator(LARGEST_DENOMINATOR)
    rest = max(abs(y - float(factor) * x) for x, y in zip(one, other, strict=True))
    return factor or None if rest <= ROUNDING_OF_RATIOS * max(map(abs, other)) else None


def _is_multiple(column: Vector, first: Vector, factor: Fraction) -> bool:
    return all(y is x * factor for x, y in zip(first, column, strict=True))


def constant_part(families: Sequence[ColumnFamily], n: int) -> tuple[Across, ...]:
    """Orthogonal vectors that complete the families to a basis, so that both together have a determinant above 0."""
    vectors = [
        Across(family.members[:count], family.factors[:count])
        for family in families
        for count in range(2, len(family.members) + 1)
    ]
    members = {j for family in families for j in family.members}
    vectors += [Across((j,), (Fraction(1),)) for j in range(n) if j not in members]
    if vectors and _is_turned_over([*(family.entries for family in families), *(vector.entries for vector in vectors)]):
        vectors[-1] = Across(vectors[-1].members, vectors[-1].factors, -1)
    return tuple(vectors)


def _is_turned_over(vectors: Sequence[dict[int, Fraction]]) -> bool:
    """Whether orthogonal vectors have a determinant below 0, by elimination."""
    rows = [dict(vector) for vector in vectors]
    turned = False
    for k in range(len(rows)):
        i = next(i for i in range(k, len(rows)) if rows[i].get(k))
        if i != k:
            rows[i], rows[k], turned = rows[k], rows[i], not turned
        turned ^= rows[k][k] < 0
        for row in rows[k + 1 :]:
            if share := row.get(k, Fraction(0)) / rows[k][k]:
                for j, x in rows[k].items():
                    row[j] = row.get(j, Fraction(0)) - share * x
    return turned


def folded(row: Vector, families: Sequence[ColumnFamily]) -> Vector:
    """A row of B along the families: one entry each, |c| times that of the first member."""
    return tuple(row[family.members[0]] * _length(row[0].graph, family) for family in families)


def _length(graph: Graph, vector: ColumnFamily | Across) -> Scalar:
    square = vector.square
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    return graph.const(root) if root * root == square else graph.function("sqrt", (graph.const(square),))


class FamilySpace(HouseholderSpace):
    """By constant vectors across families of columns, and by reflections of one column a family.

    `locked` are numbers of families that rows without others lock.
    """

    def __init__(
        self,
        graph: Graph,
        rows: Matrix,
        n: int,
        rank: int,
        families: Sequence[ColumnFamily],
        locked: Sequence[int] = (),
    ) -> None:
        self.graph, self.rows, self.n, self.rank, self.locked = graph, rows, n, rank, locked
        self.delta = n - rank
        self._families = families
        self._constant = constant_part(families, n)
        own = tuple(folded(row, families) for row in rows)
        self._own = reflected(graph, own, len(families), rank, locked=locked)
        self.reflections = self._own.reflections

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """What the rows before leave of each row, beside its length."""
        return self._own.guards

    @cached_property
    def lengths(self) -> list[Scalar]:
        """The squared lengths of the rows."""
        return self._own.lengths

    @property
    def square(self) -> Scalar:
        """det(B B^T); where rows depend on each other, that of the rows as reflections see them."""
        return self._own.square

    @property
    def restriction(self) -> Restriction:
        """Components of a force along the families' null space, then across families."""
        return _FamilyRestriction(self)

    def components(self, x: Vector) -> Vector:
        """F^T x: components along the null space of the families, then along the constant part."""
        constant = (vector.dot(self.graph, x) / _length(self.graph, vector) for vector in self._constant)
        return (*self._own.restriction(self._along(x)), *constant)

    def _along(self, x: Vector) -> Vector:
        """c.x / |c| of each family."""
        pairs = ((family, self.graph.sum(x[j] * c for j, c in family.entries.items())) for family in self._families)
        return tuple(total / _length(self.graph, family) for family, total in pairs)

    def _back(self, y: Vector) -> list[Scalar]:
        """The vector with these components along the families."""
        x = [self.graph.zero] * self.n
        for family, component in zip(self._families, y, strict=True):
            share = component / _length(self.graph, family)
            for j, c in family.entries.items():
                x[j] = share * c
        return x

    @cached_property
    def basis(self) -> Matrix:
        """F: the null space of the families, then the constant part."""
        graph = self.graph
        columns = [tuple(self._back(column)) for column in transpose(self._own.basis, self._own.delta)]
        for vector in self._constant:
            length, entries = _length(graph, vector), vector.entries
            columns.append(tuple(graph.const(entries.get(j, Fraction(0))) / length for j in range(self.n)))
        return transpose(tuple(columns), self.n)

    @cached_property
    def projector(self) -> Matrix:
        """N_B (21), n x n."""
        return transpose(tuple(self.project(axis) for axis in identity(self.graph, self.n)), self.n)

    def project(self, x: Vector) -> Vector:
        """N_B x."""
        graph = self.graph
        projection = self._back(self._own.project(self._along(x)))
        for vector in self._constant:
            share = vector.dot(graph, x) / graph.const(vector.square)
            for j, w in vector.entries.items():
                projection[j] = projection[j] + share * w
        return tuple(projection)

    def lift(self, a: Vector) -> Vector:
        """B^+ a."""
        return tuple(self._back(self._own.lift(a)))

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B^+, n x r."""
        return transpose(tuple(self.lift(axis) for axis in identity(self.graph, len(self.rows))), self.n)

    def lift_transposed(self, x: Vector) -> Vector:
        """(B^+)^T x."""
        return self._own.lift_transposed(self._along(x))


class _FamilyRestriction(Restriction):
    def __init__(self, space: FamilySpace) -> None:
        super().__init__(space.rank, space.delta, space.reflections)
        self._space = space

    def __call__(self, force: Vector) -> Vector:
        return self._space.components(force)
