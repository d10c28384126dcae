"""Vectors and matrices of space as tuples, over any numbers, and over rates that are linear combinations of numbers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Generic, Protocol, Self, TypeAlias, TypeVar

from symgen.model.expressions.expression import Expression
from symgen.model.mechanism import Vector3


class FieldElement(Protocol):
    """Numbers that can be added, multiplied and divided."""

    def __add__(self, other: Self, /) -> Self: ...
    def __sub__(self, other: Self, /) -> Self: ...
    def __mul__(self, other: Self, /) -> Self: ...
    def __truediv__(self, other: Self, /) -> Self: ...
    def __neg__(self) -> Self: ...


P = TypeVar("P", bound=FieldElement)
V = TypeVar("V")
Triple: TypeAlias = tuple[P, P, P]
Rates: TypeAlias = tuple[V, V, V]
Rows: TypeAlias = tuple[Triple[P], Triple[P], Triple[P]]


class Arithmetic(Protocol[P, V]):
    """Where numbers `P` of the configuration and rates `V` come from."""

    def value(self, expression: Expression) -> P:
        """The value of an expression of coordinates, parameters and definitions."""
        ...

    def rate(self, expression: Expression) -> V:
        """Its time derivative."""
        ...

    def number(self, value: int) -> P:
        """A whole number."""
        ...

    def function(self, name: str, operand: P) -> P:
        """sin, cos or sqrt of a number."""
        ...

    def combination(self, terms: Iterable[tuple[P, V]]) -> V:
        """Sum of products of a number and a rate; 0 for no terms."""
        ...

    def named(self, name: str, value: P, /) -> P:
        """The number under a name of its own, where the arithmetic keeps names."""
        ...


class Space(Generic[P, V]):
    """Constants of an arithmetic, and what mixes its numbers and rates."""

    def __init__(self, arithmetic: Arithmetic[P, V]) -> None:
        self.arithmetic = arithmetic
        self.one, self.zero = arithmetic.number(1), arithmetic.number(0)
        self.identity: Rows[P] = (
            (self.one, self.zero, self.zero), (self.zero, self.one, self.zero), (self.zero, self.zero, self.one),
        )  # fmt: skip
        self.origin: Triple[P] = (self.zero, self.zero, self.zero)
        nothing = arithmetic.combination(())
        self.still: Rates[V] = (nothing, nothing, nothing)

    def values(self, vector: Vector3) -> Triple[P]:
        """The values of three expressions."""
        x, y, z = (self.arithmetic.value(entry) for entry in vector)
        return x, y, z

    def rates(self, vector: Vector3) -> Rates[V]:
        """Their time derivatives."""
        x, y, z = (self.arithmetic.rate(entry) for entry in vector)
        return x, y, z

    def named(self, name: str, rows: Rows[P]) -> Rows[P]:
        """A matrix with a name for each entry."""
        named = self.arithmetic.named
        first, second, third = (
            (named(f"{name}_{i}1", row[0]), named(f"{name}_{i}2", row[1]), named(f"{name}_{i}3", row[2]))
            for i, row in enumerate(rows, 1)
        )
        return first, second, third

    def scaled(self, axis: Triple[P], rate: V) -> Rates[V]:
        """axis * rate."""
        combination = self.arithmetic.combination
        return combination([(axis[0], rate)]), combination([(axis[1], rate)]), combination([(axis[2], rate)])

    def turned(self, matrix: Rows[P], rates: Rates[V]) -> Rates[V]:
        """matrix * rates."""
        if matrix is self.identity:
            return rates
        x, y, z = (self.arithmetic.combination(zip(row, rates, strict=True)) for row in matrix)
        return x, y, z

    def summed(self, left: Rates[V], right: Rates[V]) -> Rates[V]:
        """left + right."""
        return self._mixed(left, self.one, right)

    def reduced(self, left: Rates[V], right: Rates[V]) -> Rates[V]:
        """left - right."""
        return self._mixed(left, -self.one, right)

    def crossed(self, rates: Rates[V], arm: Triple[P]) -> Rates[V]:
        """rates x arm."""
        combination = self.arithmetic.combination
        return (
            combination(((arm[2], rates[1]), (-arm[1], rates[2]))),
            combination(((arm[0], rates[2]), (-arm[2], rates[0]))),
            combination(((arm[1], rates[0]), (-arm[0], rates[1]))),
        )

    def inner(self, vector: Triple[P], rates: Rates[V]) -> V:
        """vector . rates."""
        return self.arithmetic.combination(zip(vector, rates, strict=True))

    def _mixed(self, left: Rates[V], factor: P, right: Rates[V]) -> Rates[V]:
        x, y, z = (self.arithmetic.combination(((self.one, a), (factor, b))) for a, b in zip(left, right, strict=True))
        return x, y, z


def plus(left: Triple[P], right: Triple[P]) -> Triple[P]:
    """left + right."""
    return left[0] + right[0], left[1] + right[1], left[2] + right[2]


def minus(left: Triple[P], right: Triple[P]) -> Triple[P]:
    """left - right."""
    return left[0] - right[0], left[1] - right[1], left[2] - right[2]


def cross(left: Triple[P], right: Triple[P]) -> Triple[P]:
    """left x right."""
    (x, y, z), (a, b, c) = left, right
    return y * c - z * b, z * a - x * c, x * b - y * a


def triple(values: Sequence[P]) -> Triple[P]:
    """Three values as a vector."""
    x, y, z = values
    return x, y, z


def inner(left: Sequence[P], right: Sequence[P]) -> P:
    """left . right."""
    return left[0] * right[0] + left[1] * right[1] + left[2] * right[2]


def applied(matrix: Rows[P], vector: Triple[P]) -> Triple[P]:
    """matrix * vector."""
    return inner(matrix[0], vector), inner(matrix[1], vector), inner(matrix[2], vector)


def transposed(matrix: Rows[P]) -> Rows[P]:
    """The transposed matrix."""
    a, b, c = matrix
    return (a[0], b[0], c[0]), (a[1], b[1], c[1]), (a[2], b[2], c[2])


def product(left: Rows[P], right: Rows[P]) -> Rows[P]:
    """left * right."""
    columns = transposed(right)
    first, second, third = ((inner(row, columns[0]), inner(row, columns[1]), inner(row, columns[2])) for row in left)
    return first, second, third


def acceleration_field(spin: Triple[P], swing: Triple[P]) -> Rows[P]:
    """[a]x + [w]x [w]x of an angular velocity w and acceleration a, with each product of two rates once."""
    (x, y, z), (a, b, c) = spin, swing
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    return (-(yy + zz), xy - c, xz + b), (xy + c, -(xx + zz), yz - a), (xz - b, yz + a, -(xx + yy))
