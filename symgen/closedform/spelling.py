"""From ring elements and model expressions to SymPy expressions, in the style of the paper.

Every factor is printed in its shorter form: as a polynomial in sines and cosines, or as a Fourier sum of sines and
cosines of angle combinations.  Numerators pair sin(x) cos(x) to sin(2 x)/2, denominators are Fourier sums.
SymPy symbols carry the model's names and no assumptions.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import lru_cache
from operator import sub
from typing import Any

import sympy
from sympy import QQ, Add, Expr, Integer, Mul, Rational, Symbol, cos, sin, tan
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.fourier import Series, fourier_series, least_length
from symgen.closedform.algebra.homogeneous import factorise
from symgen.closedform.algebra.quotient import Quotient, polynomial
from symgen.closedform.algebra.ring import TrigRing, content, primitive
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power

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
        self._squares: list[tuple[int, Any]] = []
        for opaque in ring.opaque:
            root = spell_expression(opaque.expression)
            square = root**2
            if square.is_Rational:
                self._squares.append((len(self.symbols), QQ(int(square.p), int(square.q))))
            self.symbols.append(root)
        self._dynamic = tuple(sorted(self.dynamic))
        self._products: dict[tuple[int, ...], Expr] = {}
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
        return scale * self._powers(powers) * Mul(*expressions)

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

    def _powers(self, powers: Mapping[int, int]) -> Expr:
        """A product of generators; sin cos becomes sin(2 x)/2 and sin/cos becomes tan."""
        powers = dict(powers)
        factors: list[Expr] = []
        for index, (s, c) in enumerate(zip(self.ring.sine, self.ring.cosine, strict=True)):
            a, b = powers.get(s, 0), powers.get(c, 0)
            if a <= 0 or b == 0:
                continue
            shared = min(a, abs(b))
            powers[s] = a - shared
            if b > 0:
                powers[c] = b - shared
                factors.append((sin(2 * self.angles[index]) / 2) ** shared)
            else:
                powers[c] = b + shared
                factors.append(tan(self.angles[index]) ** shared)
        factors += [self.symbols[position] ** exponent for position, exponent in sorted(powers.items())]
        return Mul(*factors)

    def _monomial(self, monomial: tuple[int, ...]) -> Expr:
        """A product of generators as it stands."""
        known = self._products.get(monomial)
        if known is None:
            factors = [self.symbols[i] if e == 1 else self.symbols[i] ** e for i, e in enumerate(monomial) if e]
            known = self._products[monomial] = Mul(*factors)
        return known

    def shorter(self, p: PolyElement) -> tuple[Rational, Expr]:
        """(scale, sum) of a factor in the shortest of its forms: polynomial, Fourier sum, or collected by rates."""
        if p not in self._known:
            plain = self._without_squares(p)
            normal = self.ring.normal(plain)
            if not normal:
                return Integer(1), Integer(0)
            forms = [self._plain(q) for q in ((plain,) if normal == plain else (plain, normal))]
            lengths = [_length(form) for form in forms]
            collected = self._collected(normal)
            length = None if collected is None else _length((Integer(1), collected))
            if sum([2 ** sum([monomial[i] for i in self.ring.angle_positions]) for monomial in plain]) <= MOST_WAVES:
                series = fourier_series(self.ring, plain)
                least = least_length(self.ring, series)
                # it is not built where another form is shorter anyway
                if least < min(lengths) and (length is None or least <= length):
                    forms.append(self._waves(series))
                    lengths.append(_length(forms[-1]))
            if collected is not None and length is not None:
                forms.append((Integer(1), collected))
                lengths.append(length)
            best = forms[lengths.index(min(lengths))]
            self._known[p] = _upright(*best)
        return self._known[p]

    def _without_squares(self, p: PolyElement) -> PolyElement:
        """The same with 3 for the square of sqrt(3): what coefficients have in common is seen then."""
        for position, square in self._squares:
            if any(monomial[position] > 1 for monomial in p):
                reduced = self.ring.polys.zero.copy()
                for monomial, coefficient in p.items():
                    pairs, single = divmod(monomial[position], 2)
                    place = (*monomial[:position], single, *monomial[position + 1 :])
                    reduced[place] = reduced.get(place, QQ(0)) + coefficient * square**pairs
                p = reduced
                p.strip_zero()
        return p

    def _plain(self, p: PolyElement) -> tuple[Rational, Expr]:
        """The sum of monomials as it stands, the rational content apart."""
        common, rest = primitive(p)
        return _rational(common), self._sum(rest)

    def _sum(self, p: PolyElement) -> Expr:
        terms = []
        for monomial, coefficient in p.terms():
            product = self._monomial(monomial)
            terms.append(product if coefficient == 1 else _rational(coefficient) * product)
        return Add(*terms)

    def _collected(self, p: PolyElement) -> Expr | None:
        """The sum over the monomials in rates and accelerations, every coefficient factored."""
        groups: dict[tuple[int, ...], PolyElement] = {}
        for monomial, coefficient in p.items():
            outer = tuple([monomial[i] for i in self._dynamic])
            inner = list(monomial)
            for i in self._dynamic:
                inner[i] = 0
            groups.setdefault(outer, self.ring.polys.zero.copy())[tuple(inner)] = coefficient
        if len(groups) < 2:
            return None
        terms = []
        for outer in sorted(groups, reverse=True):
            rates = [self.symbols[i] ** e for i, e in zip(self._dynamic, outer, strict=True) if e]
            terms.append(Mul(*rates) * self.polynomial(groups[outer]))
        return Add(*terms)

    def fourier(self, p: PolyElement) -> tuple[Rational, Expr]:
        """(scale, sum) with p = scale * sum: sines and cosines of angle combinations, coprime integer coefficients."""
        return self._waves(fourier_series(self.ring, self._without_squares(p)))

    def _waves(self, series: Series) -> tuple[Rational, Expr]:
        """(scale, sum) of a Fourier series."""
        scale = QQ(0)
        for parts in series.values():
            for part in parts:
                if part:
                    scale = QQ.gcd(scale, content(part))
        terms = []
        for frequencies, (cosine, sine) in series.items():
            angle = sum((k * angle for k, angle in zip(frequencies, self.angles, strict=True)), Integer(0))
            for part, function in ((cosine, cos), (sine, sin)):
                if part:
                    terms.append(self._coefficient(part.quo_ground(scale)) * function(angle))
        return _rational(scale), Add(*terms)

    def _coefficient(self, p: PolyElement) -> Expr:
        """A coefficient of a Fourier sum: its common monomial and rational content taken out, the rest in one piece."""
        share, rest = primitive(p)
        if len(rest) == 1:
            return _rational(share) * self._sum(rest)
        common = tuple(map(min, *rest))
        reduced = self.ring.polys.zero.copy()
        for monomial, coefficient in rest.items():
            reduced[tuple(map(sub, monomial, common))] = coefficient
        sign, expression = _upright(Integer(1), self._sum(reduced))
        factor = _rational(share) * sign * self._monomial(common)
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
    if not expression.is_Add:
        return _operations(expression) + int(abs(scale) != 1)
    negative = [term.as_coeff_Mul()[0].is_negative for term in expression.args]
    terms = sum([_operations(-term if minus else term) for term, minus in zip(expression.args, negative, strict=True)])
    return terms + len(negative) - 1 + int(all(negative)) + int(abs(scale) != 1)


@lru_cache(maxsize=4096)  # the same terms stand in many sums
def _operations(expression: Expr) -> int:
    """SymPy's count of operations, faster for what most terms are."""
    if expression.is_Symbol:
        return 0
    if expression.is_Function and len(expression.args) == 1:
        return 1 + _operations(expression.args[0])
    if expression.is_Pow and expression.exp.is_Integer and expression.exp.is_positive:
        return 1 + _operations(expression.base)
    if expression.is_Mul:
        coefficient, factors = expression.as_coeff_mul()
        whole = coefficient.is_Integer and coefficient.is_positive
        if whole and all(not factor.is_Pow or factor.exp.is_positive for factor in factors):
            return sum(map(_operations, factors)) + len(factors) - int(coefficient == 1)
    return int(expression.count_ops())


def _rational(value: Any) -> Rational:
    return Rational(int(value.numerator), int(value.denominator))
