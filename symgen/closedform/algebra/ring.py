"""The ring Q[names, opaque atoms][s_i, c_i] / (s_i^2 + c_i^2 - 1) and its field of fractions.

Elements are SymPy's sparse polynomials.  {s_i^2 + c_i^2 - 1} is a Groebner basis with coprime leading terms, so "every
s_i to the power 0 or 1" is a canonical form: two elements are equal exactly when their normal forms are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import Any

from sympy import QQ
from sympy.polys.rings import PolyElement, PolyRing

from symgen.closedform.algebra.angles import AngleBasis
from symgen.closedform.algebra.limits import WorkCounter
from symgen.closedform.algebra.used import UsedGenerators
from symgen.model.expressions.expression import Expression, Name
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Opaque:
    """An atom the ring knows nothing about but its derivative: a root, exp, atan, ... of ring elements."""

    expression: Expression
    outer_derivatives: tuple[tuple[Expression, Expression], ...]
    """(argument, partial derivative of the atom with respect to that argument) as expressions."""


# Looking for squares of so many sines is included in the cost of a product; every further one costs as much again.
FREE_ANGLES = 6

# A product of so many products of terms is cheaper by way of flint.
LONG_PRODUCT = 60


def content(p: PolyElement) -> Any:
    """The greatest common divisor of the coefficients, a rational number; SymPy takes it two by two."""
    coefficients = p.values()
    return QQ(gcd(*[int(c.numerator) for c in coefficients]), lcm(*[int(c.denominator) for c in coefficients]))


def primitive(p: PolyElement) -> tuple[Any, PolyElement]:
    """(content, p / content), where p is not zero."""
    common = content(p)
    return common, p if common == 1 else p.quo_ground(common)


class TrigRing:
    """The polynomial ring with one (s, c) pair per atom of `basis`, variables by name and opaque atoms."""

    def __init__(
        self, variables: Sequence[str], configuration: Sequence[str], basis: AngleBasis, opaque: Sequence[Opaque]
    ) -> None:
        self.work = WorkCounter()
        self.variables = tuple(variables)
        self.configuration = frozenset(configuration)
        self.basis = basis
        self.opaque = tuple(opaque)
        pairs = [f"_{kind}{index}" for index in range(len(basis.atoms)) for kind in "sc"]
        atoms = [f"_w{index}" for index in range(len(self.opaque))]
        self.polys = PolyRing([*self.variables, *pairs, *atoms], QQ)
        self.position: Mapping[str, int] = {name: i for i, name in enumerate(self.variables)}
        first = len(self.variables)
        self.sine = tuple(first + 2 * i for i in range(len(basis.atoms)))
        self.cosine = tuple(first + 2 * i + 1 for i in range(len(basis.atoms)))
        self.opaque_position = tuple(first + 2 * len(basis.atoms) + i for i in range(len(self.opaque)))
        self.angle_positions = frozenset(self.sine + self.cosine)

    @cached_property
    def is_complete(self) -> bool:
        """Whether equality is decided by normal forms: no opaque atoms, every angle a combination of names."""
        return not self.opaque and all(isinstance(base, Name) for atom in self.basis.atoms for base, _ in atom)

    @cached_property
    def zero(self) -> PolyElement:
        """The polynomial 0."""
        return self.polys.zero

    @cached_property
    def one(self) -> PolyElement:
        """The polynomial 1."""
        return self.polys.one

    def constant(self, value: Fraction | int) -> PolyElement:
        """A rational number as a polynomial."""
        value = Fraction(value)
        return self.polys.ground_new(QQ(value.numerator, value.denominator))

    def generator(self, index: int) -> PolyElement:
        """The generator at a position of the monomials."""
        return self.polys.gens[index]

    def normal(self, p: PolyElement) -> PolyElement:
        """The canonical form: every s_i to the power 0 or 1."""
        self._look_for_squares(len(p))
        powers = slice(self.sine[0], self.cosine[-1], 2) if self.sine else slice(0)
        if all(max(monomial[powers], default=0) < 2 for monomial in p):
            return p
        for s, c in zip(self.sine, self.cosine, strict=True):
            if all(monomial[s] < 2 for monomial in p):
                continue
            by_power: dict[int, PolyElement] = {}
            for monomial, coefficient in p.items():
                pairs, rest = divmod(monomial[s], 2)
                target = by_power.setdefault(pairs, self.polys.zero.copy())
                target[(*monomial[:s], rest, *monomial[s + 1 :])] = coefficient
            p = by_power.pop(0, self.polys.zero.copy())
            square = 1 - self.generator(c) ** 2
            for pairs, part in by_power.items():
                p = p + part * square**pairs
        return p

    def _look_for_squares(self, terms: int) -> None:
        """Count the work of that."""
        self.work.spend(terms * max(0, len(self.sine) - FREE_ANGLES))

    def product(self, p: PolyElement, q: PolyElement) -> PolyElement:
        """The product in normal form."""
        self.work.spend(len(p) * len(q))
        if len(p) * len(q) < LONG_PRODUCT:
            return self.normal(p * q)
        used = UsedGenerators(self, (p, q))
        result = used.image(p) * used.image(q)
        self._look_for_squares(len(result))
        degrees = result.degrees()
        for s, c in used.pairs:
            if degrees[s] > 1:
                _, result = divmod(result, used.generator(s) ** 2 + used.generator(c) ** 2 - 1)
        return used.element(result)

    def shape(self, p: PolyElement) -> tuple[int, ...]:
        """The positions of the generators that occur."""
        if len(p) == 1:
            (monomial,) = p
            return tuple([i for i, exponent in enumerate(monomial) if exponent])
        return tuple([i for i, used in enumerate(map(any, zip(*p, strict=True))) if used]) if p else ()

    def multiple_angle(self, multiples: Sequence[int], quarter_turns: int) -> tuple[PolyElement, PolyElement]:
        """(sin, cos) of an integer combination of the atoms plus quarter turns, by the addition theorems."""
        sine, cosine = self.zero, self.one
        for index, count in enumerate(multiples):
            s, c = self.generator(self.sine[index]), self.generator(self.cosine[index])
            for _ in range(abs(count)):
                step = s if count > 0 else -s
                sine, cosine = self.normal(sine * c + cosine * step), self.normal(cosine * c - sine * step)
        for _ in range(quarter_turns % 4):
            sine, cosine = cosine, -sine
        return sine, cosine
