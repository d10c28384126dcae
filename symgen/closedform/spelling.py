"""From ring elements and model expressions to SymPy expressions, in the style of the paper.

Every factor is printed in its shorter form: as a polynomial in sines and cosines, or as a Fourier sum of sines and
cosines of angle combinations.  Numerators pair sin(x) cos(x) to sin(2 x)/2, denominators are Fourier sums.
SymPy symbols carry the model's names and no assumptions.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import sympy
from sympy import QQ, Add, Expr, Integer, Mul, Rational, Symbol, cos, sin, tan
from sympy.polys.rings import PolyElement

from symgen.closedform.homogeneous import factorise
from symgen.closedform.quotient import Quotient, polynomial
from symgen.closedform.ring import TrigRing
from symgen.model.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power

# A Fourier sum of more waves is not worth making: it is never the shortest form.
MOST_WAVES = 1_000


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
    """Prints elements of one ring; `dynamic` names (rates, accelerations, ...) are what long sums are collected by."""

    def __init__(self, ring: TrigRing, dynamic: Collection[str] = ()) -> None:
        self.ring = ring
        self.dynamic = frozenset(ring.position[name] for name in dynamic)
        self.symbols: list[Expr] = [Symbol(name) for name in ring.variables]
        self.angles: list[Expr] = []
        for atom in ring.basis.atoms:
            angle = sum((Rational(f.numerator, f.denominator) * spell_expression(base) for base, f in atom), Integer(0))
            self.angles.append(angle)
            self.symbols += [sin(angle), cos(angle)]
        self.symbols += [spell_expression(atom.expression) for atom in ring.opaque]
        self._known: dict[PolyElement, tuple[Rational, Expr]] = {}
        self._factored: dict[PolyElement, Expr] = {}

    def polynomial(self, p: PolyElement) -> Expr:
        """A ring element in normal form, factored."""
        if p not in self._factored:
            self._factored[p] = self.quotient(polynomial(self.ring, p))
        return self._factored[p]

    def quotient(self, value: Quotient) -> Expr:
        """A fraction in lowest terms, both parts factored."""
        if not value:
            return Integer(0)
        constant, tops = factorise(self.ring, value.numerator)
        divisor, bottoms = factorise(self.ring, value.denominator)
        scale = _rational(constant.LC) / _rational(divisor.LC)
        powers: dict[int, int] = {}
        sums: list[tuple[PolyElement, int]] = []
        for factor, multiplicity in tops:
            position = self._generator(factor)
            if position is None:
                sums.append((factor, multiplicity))
            else:
                powers[position] = powers.get(position, 0) + multiplicity
        expressions: list[Expr] = []
        for factor, multiplicity in self._merge(sums):
            part, expression = self.shorter(factor)
            scale *= part**multiplicity
            expressions.append(expression**multiplicity)
        for factor, multiplicity in bottoms:
            position = self._generator(factor)
            if position is None:
                part, expression = self.fourier(factor)
                scale /= part**multiplicity
                expressions.append(expression ** (-multiplicity))
            else:
                powers[position] = powers.get(position, 0) - multiplicity
        return scale * self._powers(powers, pair=True) * Mul(*expressions)

    def _merge(self, factors: list[tuple[PolyElement, int]]) -> list[tuple[PolyElement, int]]:
        """Multiply two factors that are shorter as one: (cos x - sin x) (cos x + sin x) is cos(2 x)."""
        for i, (p, k) in enumerate(factors):
            for j in range(i + 1, len(factors)):
                q, m = factors[j]
                if (
                    k != m
                    or len(p) * len(q) > 36
                    or not set(self.ring.shape(p) + self.ring.shape(q)) <= self.ring.angle_positions
                ):
                    continue
                product = self.ring.normal(p * q)
                if _length(self.shorter(product)) < _length(self.shorter(p)) + _length(self.shorter(q)):
                    rest = [f for index, f in enumerate(factors) if index not in (i, j)]
                    return self._merge([(product, k), *rest])
        return factors

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

    def shorter(self, p: PolyElement) -> tuple[Rational, Expr]:
        """(scale, sum) of a factor in the shortest of its forms: polynomial, Fourier sum, or collected by rates."""
        if p not in self._known:
            forms = [self._plain(p)]
            normal = self.ring.normal(p)
            if normal != p:
                forms.append(self._plain(normal))
            if sum(2 ** sum(monomial[i] for i in self.ring.angle_positions) for monomial in p) <= MOST_WAVES:
                forms.append(self.fourier(p))
            collected = self._collected(normal)
            if collected is not None:
                forms.append((Integer(1), collected))
            self._known[p] = _upright(*min(forms, key=_length))
        return self._known[p]

    def _plain(self, p: PolyElement) -> tuple[Rational, Expr]:
        """The sum of monomials as it stands, the rational content apart."""
        content, primitive = p.primitive()
        return _rational(content), self._sum(primitive)

    def _sum(self, p: PolyElement) -> Expr:
        terms = []
        for monomial, coefficient in p.terms():
            product = self._powers({i: e for i, e in enumerate(monomial) if e}, pair=False)
            terms.append(_rational(coefficient) * product)
        return Add(*terms)

    def _collected(self, p: PolyElement) -> Expr | None:
        """The sum over the monomials in rates and accelerations, every coefficient factored."""
        groups: dict[tuple[int, ...], PolyElement] = {}
        for monomial, coefficient in p.items():
            outer = tuple(e if i in self.dynamic else 0 for i, e in enumerate(monomial))
            inner = tuple(0 if i in self.dynamic else e for i, e in enumerate(monomial))
            groups.setdefault(outer, self.ring.polys.zero.copy())[inner] = coefficient
        if len(groups) < 2:
            return None
        terms = []
        for outer in sorted(groups, reverse=True):
            terms.append(self._powers({i: e for i, e in enumerate(outer) if e}, False) * self.polynomial(groups[outer]))
        return Add(*terms)

    def fourier(self, p: PolyElement) -> tuple[Rational, Expr]:
        """(scale, sum) with p = scale * sum: sines and cosines of angle combinations, coprime integer coefficients."""
        series = fourier_series(self.ring, p)
        scale = QQ(0)
        for parts in series.values():
            for part in parts:
                if part:
                    scale = QQ.gcd(scale, part.content())
        terms = []
        for frequencies, (cosine, sine) in series.items():
            angle = sum((k * angle for k, angle in zip(frequencies, self.angles, strict=True)), Integer(0))
            for part, function in ((cosine, cos), (sine, sin)):
                if part:
                    terms.append(self._coefficient(part.quo_ground(scale)) * function(angle))
        return _rational(scale), Add(*terms)

    def _coefficient(self, p: PolyElement) -> Expr:
        """A coefficient of a Fourier sum: its common monomial and rational content taken out, the rest in one piece."""
        content, rest = p.primitive()
        common = tuple(min(exponents) for exponents in zip(*rest, strict=True))
        reduced = self.ring.polys.zero.copy()
        for monomial, coefficient in rest.items():
            reduced[tuple(e - c for e, c in zip(monomial, common, strict=True))] = coefficient
        sign, expression = _upright(Integer(1), self._sum(reduced))
        factor = _rational(content) * sign * self._powers({i: e for i, e in enumerate(common) if e}, pair=False)
        return Mul(factor, expression)


def _upright(scale: Rational, expression: Expr) -> tuple[Rational, Expr]:
    """The sum with its sign turned so that most of its terms are positive."""
    terms = Add.make_args(expression)
    negative = sum(bool(term.could_extract_minus_sign()) for term in terms)
    if 2 * negative > len(terms):
        return -scale, Add(*(-term for term in terms))
    return scale, expression


def _length(form: tuple[Rational, Expr]) -> int:
    scale, expression = form
    return int(expression.count_ops()) + int(abs(scale) != 1)


def fourier_series(ring: TrigRing, p: PolyElement) -> dict[tuple[int, ...], tuple[PolyElement, PolyElement]]:
    """Frequencies of the atoms to the coefficients of cosine and sine; the first non-zero frequency is positive."""
    waves: dict[tuple[int, ...], tuple[PolyElement, PolyElement]] = {}
    for monomial, coefficient in p.terms():
        rest = list(monomial)
        for position in ring.angle_positions:
            rest[position] = 0
        degree = sum(monomial[position] for position in ring.angle_positions)
        scale = ring.polys.zero.copy()
        scale[tuple(rest)] = coefficient / 2**degree
        for frequencies, (real, imaginary) in _wave_product(ring, monomial).items():
            leading = next((k for k in frequencies if k), 0)
            key = tuple(-k for k in frequencies) if leading < 0 else frequencies
            if leading < 0:
                imaginary = -imaginary
            cosine, sine = waves.get(key, (ring.zero, ring.zero))
            waves[key] = (
                cosine + scale.mul_ground(QQ(real)) if real else cosine,
                sine - scale.mul_ground(QQ(imaginary)) if imaginary else sine,
            )
    constant = (0,) * len(ring.sine)
    if constant in waves:
        waves[constant] = (waves[constant][0], ring.zero)
    return {key: value for key, value in sorted(waves.items()) if value[0] or value[1]}


def _wave_product(ring: TrigRing, monomial: tuple[int, ...]) -> dict[tuple[int, ...], tuple[int, int]]:
    """2^degree times the sines and cosines of a monomial as complex exponentials, coefficients (real, imaginary)."""
    waves: dict[tuple[int, ...], tuple[int, int]] = {(): (1, 0)}
    for s, c in zip(ring.sine, ring.cosine, strict=True):
        if not monomial[s] and not monomial[c]:
            waves = {(*frequencies, 0): value for frequencies, value in waves.items()}
            continue
        single: dict[int, tuple[int, int]] = {0: (1, 0)}
        for kind, power in ((0, monomial[s]), (1, monomial[c])):
            for _ in range(power):
                step: dict[int, tuple[int, int]] = {}
                for k, (x, y) in single.items():
                    for shift in (1, -1):
                        # 2 cos = e + 1/e, 2 sin = -i (e - 1/e)
                        add = (x, y) if kind else (y * shift, -x * shift)
                        old = step.get(k + shift, (0, 0))
                        step[k + shift] = (old[0] + add[0], old[1] + add[1])
                single = step
        waves = {
            (*frequencies, k): (x * u - y * v, x * v + y * u)
            for frequencies, (x, y) in waves.items()
            for k, (u, v) in single.items()
        }
    return waves


def _rational(value: Any) -> Rational:
    return Rational(int(value.numerator), int(value.denominator))
