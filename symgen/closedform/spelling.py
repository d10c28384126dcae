"""From ring elements and model expressions to SymPy expressions, in the style of the paper.

Every factor is printed in its shorter form: as a polynomial in sines and cosines, or as a Fourier sum of sines and
cosines of angle combinations.  Numerators pair sin(x) cos(x) to sin(2 x)/2, denominators are Fourier sums.
SymPy symbols carry the model's names and no assumptions.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import sympy
from sympy import QQ, Expr, Integer, Mul, Rational, Symbol, cos, sin, tan
from sympy.polys.rings import PolyElement

from symgen.closedform.homogeneous import factorise
from symgen.closedform.quotient import Quotient
from symgen.closedform.ring import TrigRing
from symgen.model.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power


def spell_expression(expression: Expression, values: Mapping[str, Expr] | None = None) -> Expr:
    """A model expression as SymPy builds it; names become symbols or what `values` gives for them."""
    names: Mapping[str, Expr] = values or {}
    match expression:
        case Number(value):
            return Rational(value.numerator, value.denominator)
        case Pi():
            return sympy.pi
        case Name(name):
            return names.get(name, Symbol(name))
        case Negation(operand):
            return -spell_expression(operand, names)
        case Binary(operator, left, right):
            a, b = spell_expression(left, names), spell_expression(right, names)
            return a + b if operator == "+" else a - b if operator == "-" else a * b if operator == "*" else a / b
        case Power(base, exponent):
            return spell_expression(base, names) ** Rational(exponent.numerator, exponent.denominator)
        case Call(function, arguments):
            return getattr(sympy, function)(*(spell_expression(a, names) for a in arguments))


class Speller:
    """Prints elements of one ring."""

    def __init__(self, ring: TrigRing) -> None:
        self.ring = ring
        self.symbols: list[Expr] = [Symbol(name) for name in ring.variables]
        self.angles: list[Expr] = []
        for atom in ring.basis.atoms:
            angle = sum((Rational(f.numerator, f.denominator) * spell_expression(base) for base, f in atom), Integer(0))
            self.angles.append(angle)
            self.symbols += [sin(angle), cos(angle)]
        self.symbols += [spell_expression(atom.expression) for atom in ring.opaque]
        self._known: dict[PolyElement, Expr] = {}

    def quotient(self, value: Quotient) -> Expr:
        """A fraction in lowest terms, both parts factored."""
        if not value:
            return Integer(0)
        constant, tops = factorise(self.ring, value.numerator)
        divisor, bottoms = factorise(self.ring, value.denominator)
        scale = _rational(constant.LC) / _rational(divisor.LC)
        powers: dict[int, int] = {}
        expressions: list[Expr] = []
        for factor, multiplicity in tops:
            position = self._generator(factor)
            if position is None:
                expressions.append(self.shorter(factor) ** multiplicity)
            else:
                powers[position] = powers.get(position, 0) + multiplicity
        for factor, multiplicity in bottoms:
            position = self._generator(factor)
            if position is None:
                fourier, denominator = self.fourier(factor)
                scale *= Integer(denominator) ** multiplicity
                expressions.append(fourier ** (-multiplicity))
            else:
                powers[position] = powers.get(position, 0) - multiplicity
        return scale * self._powers(powers, pair=True) * Mul(*expressions)

    def _generator(self, factor: PolyElement) -> int | None:
        """The position of the generator that a factor is, None when it is a sum."""
        if len(factor) != 1:
            return None
        (monomial,) = factor
        return int(monomial.index(1))

    def _powers(self, powers: Mapping[int, int], pair: bool) -> Expr:
        """A product of generators; sin cos becomes sin(2 x)/2 and sin/cos becomes tan when `pair`."""
        powers = dict(powers)
        result: Expr = Integer(1)
        for index, (s, c) in enumerate(zip(self.ring.sine, self.ring.cosine, strict=True)):
            a, b = powers.get(s, 0), powers.get(c, 0)
            if not pair or a <= 0 or b == 0:
                continue
            shared = min(a, abs(b))
            powers[s] = a - shared
            if b > 0:
                powers[c] = b - shared
                result *= (sin(2 * self.angles[index]) / 2) ** shared
            else:
                powers[c] = b + shared
                result *= tan(self.angles[index]) ** shared
        for position, exponent in sorted(powers.items()):
            result *= self.symbols[position] ** exponent
        return result

    def polynomial(self, p: PolyElement) -> Expr:
        """The sum of monomials as it stands."""
        terms = []
        for monomial, coefficient in p.terms():
            product = self._powers({i: e for i, e in enumerate(monomial) if e}, pair=False)
            terms.append(_rational(coefficient) * product)
        return sympy.Add(*terms)

    def shorter(self, p: PolyElement) -> Expr:
        """A factor in the shortest of its forms: homogeneous or normal polynomial, or Fourier sum."""
        if p not in self._known:
            plain = [self.polynomial(p)]
            normal = self.ring.normal(p)
            if normal != p:
                plain.append(self.polynomial(normal))
            fourier, denominator = self.fourier(p)
            self._known[p] = min([*plain, fourier / denominator], key=lambda e: int(e.count_ops()))
        return self._known[p]

    def fourier(self, p: PolyElement) -> tuple[Expr, int]:
        """(sum, d) with p = sum / d: the sum of sines and cosines of angle combinations with integer coefficients."""
        series = fourier_series(self.ring, p)
        common = 1
        for parts in series.values():
            for part in parts:
                for coefficient in part.coeffs():
                    common = sympy.ilcm(common, int(coefficient.denominator))
        terms = []
        for frequencies, (cosine, sine) in series.items():
            angle = sum((k * angle for k, angle in zip(frequencies, self.angles, strict=True)), Integer(0))
            for part, function in ((cosine, cos), (sine, sin)):
                if part:
                    terms.append(self._coefficient(part.mul_ground(QQ(int(common), 1))) * function(angle))
        return sympy.Add(*terms), int(common)

    def _coefficient(self, p: PolyElement) -> Expr:
        """A coefficient of a Fourier sum: a monomial, or a sum kept in one piece."""
        return self.polynomial(p)


def fourier_series(ring: TrigRing, p: PolyElement) -> dict[tuple[int, ...], tuple[PolyElement, PolyElement]]:
    """Frequencies of the atoms to the coefficients of cosine and sine; the first non-zero frequency is positive."""
    waves: dict[tuple[int, ...], tuple[PolyElement, PolyElement]] = {}
    for monomial, coefficient in p.terms():
        rest = list(monomial)
        for position in ring.angle_positions:
            rest[position] = 0
        scale = ring.polys.zero.copy()
        scale[tuple(rest)] = coefficient
        for frequencies, (real, imaginary) in _wave_product(ring, monomial).items():
            leading = next((k for k in frequencies if k), 0)
            key = tuple(-k for k in frequencies) if leading < 0 else frequencies
            if leading < 0:
                imaginary = -imaginary
            cosine, sine = waves.get(key, (ring.zero, ring.zero))
            waves[key] = (
                cosine + scale.mul_ground(QQ(real.numerator, real.denominator)),
                sine - scale.mul_ground(QQ(imaginary.numerator, imaginary.denominator)),
            )
    constant = (0,) * len(ring.sine)
    if constant in waves:
        waves[constant] = (waves[constant][0], ring.zero)
    return {key: value for key, value in sorted(waves.items()) if value[0] or value[1]}


def _wave_product(ring: TrigRing, monomial: tuple[int, ...]) -> dict[tuple[int, ...], tuple[Fraction, Fraction]]:
    """A monomial in sines and cosines as a sum of complex exponentials, coefficients (real, imaginary)."""
    waves: dict[tuple[int, ...], tuple[Fraction, Fraction]] = {(): (Fraction(1), Fraction(0))}
    half = Fraction(1, 2)
    for s, c in zip(ring.sine, ring.cosine, strict=True):
        single: dict[int, tuple[Fraction, Fraction]] = {0: (Fraction(1), Fraction(0))}
        for kind, power in ((0, monomial[s]), (1, monomial[c])):
            for _ in range(power):
                step: dict[int, tuple[Fraction, Fraction]] = {}
                for k, (x, y) in single.items():
                    for shift in (1, -1):
                        # cos = (e + 1/e)/2, sin = -i (e - 1/e)/2
                        add = (x * half, y * half) if kind else (y * half * shift, -x * half * shift)
                        old = step.get(k + shift, (Fraction(0), Fraction(0)))
                        step[k + shift] = (old[0] + add[0], old[1] + add[1])
                single = step
        waves = {
            (*frequencies, k): (x * u - y * v, x * v + y * u)
            for frequencies, (x, y) in waves.items()
            for k, (u, v) in single.items()
        }
    return waves


def _rational(value: object) -> Rational:
    return Rational(int(value.numerator), int(value.denominator))  # type: ignore[attr-defined]
