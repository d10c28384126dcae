"""Fractions of ring elements: exact arithmetic for matrices of a mechanism."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.homogeneous import cancel_plain, common_factor, divide
from symgen.closedform.algebra.ring import TrigRing, primitive


@dataclass(frozen=True, slots=True, eq=False)
class Quotient:
    """numerator / denominator in normal form, without a common trigonometric factor.

    The denominator has coprime integer coefficients and a positive leading one.
    """

    ring: TrigRing
    numerator: PolyElement
    denominator: PolyElement

    def __bool__(self) -> bool:
        return bool(self.numerator)

    @property
    def is_polynomial(self) -> bool:
        """Whether the denominator is 1."""
        return bool(self.denominator == 1)

    def __neg__(self) -> Quotient:
        return Quotient(self.ring, -self.numerator, self.denominator)

    def __add__(self, other: Quotient) -> Quotient:
        if not self:
            return other
        if not other:
            return self
        self.ring.work.spend(len(self.numerator) + len(other.numerator))
        if self.denominator == other.denominator:
            total = self.numerator + other.numerator
            return polynomial(self.ring, total) if self.is_polynomial else quotient(self.ring, total, self.denominator)
        shared = common_factor(self.ring, [self.denominator, other.denominator])
        left, right = divide(self.ring, self.denominator, shared), divide(self.ring, other.denominator, shared)
        total = self.ring.product(self.numerator, right) + self.ring.product(other.numerator, left)
        return quotient(self.ring, total, self.ring.product(left, other.denominator))

    def __sub__(self, other: Quotient) -> Quotient:
        return self + (-other)

    def __mul__(self, other: Quotient) -> Quotient:
        if not self or not other:
            return polynomial(self.ring, self.ring.zero)
        numerator = self.ring.product(self.numerator, other.numerator)
        if self.is_polynomial and other.is_polynomial:
            return polynomial(self.ring, numerator)
        return quotient(self.ring, numerator, self.ring.product(self.denominator, other.denominator))

    def __truediv__(self, other: Quotient) -> Quotient:
        if not other:
            raise ZeroDivisionError("division by an expression that is identically zero")
        numerator = self.ring.product(self.numerator, other.denominator)
        return quotient(self.ring, numerator, self.ring.product(self.denominator, other.numerator))

    def equals(self, other: Quotient) -> bool:
        """Equality in the field of fractions, decided by the normal form of the cross product."""
        left = self.ring.product(self.numerator, other.denominator)
        return bool(left == self.ring.product(other.numerator, self.denominator))


COST_OF_GCD = 20
"""Products of terms that a common factor costs per term of its arguments."""

Matrix: TypeAlias = tuple[tuple[Quotient, ...], ...]


def polynomial(ring: TrigRing, p: PolyElement) -> Quotient:
    """A ring element as a fraction."""
    return Quotient(ring, p, ring.one)


def quotient(ring: TrigRing, numerator: PolyElement, denominator: PolyElement) -> Quotient:
    """numerator / denominator, both in normal form, with the common factor cancelled."""
    if not numerator:
        return polynomial(ring, ring.zero)
    if not denominator.is_ground:
        ring.work.spend(COST_OF_GCD * (len(numerator) + len(denominator)))
        shared = common_factor(ring, [denominator, numerator])
        numerator, denominator = divide(ring, numerator, shared), divide(ring, denominator, shared)
        numerator, denominator = cancel_plain(ring, numerator, denominator)
    content, denominator = primitive(denominator)
    if denominator.LC < 0:
        content, denominator = -content, -denominator
    return Quotient(ring, numerator.mul_ground(1 / content), denominator)
