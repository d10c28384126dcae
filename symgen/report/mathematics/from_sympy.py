"""SymPy expressions as layout, in an order that depends on the model alone.

Factors stand as in a textbook: numbers, parameters, coordinates, rates, sums in parentheses, functions; terms follow
the order of their factors, the constant last.  SymPy's own printing order is neither that nor cheap.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction as Rational
from typing import Any, TypeAlias

import sympy
from sympy.core.function import AppliedUndef

from symgen.diagnostics import SymgenBug
from symgen.report.mathematics.layout import (
    Array,
    Fraction,
    Layout,
    Letter,
    Numeral,
    Root,
    Sum,
    minus,
    signed,
    size,
)
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.numerals import decimal_coefficient, long_number, rational_layout
from symgen.report.mathematics.setting import call, power, product

Key: TypeAlias = tuple[Any, ...]
Order: TypeAlias = Mapping[str, tuple[int, int]]
PARAMETER, COORDINATE, RATE, ACCELERATION, GROUP, FUNCTION = range(6)


class SympyLayout:
    """Translates SymPy expressions; `order` gives name -> (kind, place) for the order of factors and terms."""

    def __init__(self, order: Order) -> None:
        self._order = order
        self._layouts: dict[Any, Layout] = {}
        self._keys: dict[Any, Key] = {}

    def matrix(self, matrix: Any) -> Array:
        """A SymPy matrix with parentheses."""
        rows, columns = matrix.shape
        return Array(tuple(tuple(self.expression(matrix[i, j]) for j in range(columns)) for i in range(rows)))

    def expression(self, expression: Any) -> Layout:
        """One SymPy expression; raises SymgenBug for a kind of node nothing here can set."""
        layout = self._layouts.get(expression)
        if layout is None:
            layout = self._layouts[expression] = self._translate(expression)
        return layout

    def _translate(self, node: Any) -> Layout:
        if node.is_Symbol:
            return name_layout(node.name)
        if node.is_Rational:
            return rational_layout(Rational(int(node.p), int(node.q)))
        if node.is_Float:
            return rational_layout(Rational(str(node)), prefer_decimal=True)
        if node is sympy.pi:
            return Letter("π")
        if node is sympy.E:
            return Letter("e", "upright")
        if node.is_Add:
            return self._sum(node)
        if node.is_Mul or node.is_Pow:
            return self._product(node)
        if isinstance(node, (sympy.Max, sympy.Min)):
            arguments = sorted(node.args, key=self._term_key)
            return call(type(node).__name__.lower(), tuple(self.expression(argument) for argument in arguments))
        if isinstance(node, sympy.Function) and not isinstance(node, AppliedUndef):
            return call(type(node).__name__, tuple(self.expression(argument) for argument in node.args))
        raise SymgenBug(f"report: no way to set the SymPy node {type(node).__name__}: {node}")

    def _sum(self, node: Any) -> Layout:
        terms = [signed(self.expression(term)) for term in sorted(node.args, key=self._term_key)]
        leading = next((position for position, (sign, _) in enumerate(terms) if sign == "+"), 0)
        terms.insert(0, terms.pop(leading))
        return Sum(tuple(terms))

    def _product(self, node: Any) -> Layout:
        coefficient = Rational(1)
        over: list[tuple[Any, Any]] = []
        under: list[tuple[Any, Any]] = []
        for factor in node.args if node.is_Mul else (node,):
            if factor.is_Rational:
                coefficient *= Rational(int(factor.p), int(factor.q))
            elif factor.is_Pow and factor.exp.is_Rational and factor.exp.p < 0:
                under.append((factor.base, -factor.exp))
            elif factor.is_Pow:
                over.append((factor.base, factor.exp))
            else:
                over.append((factor, sympy.S.One))
        coefficient, over = _without_shared_sign(coefficient, over)
        coefficient, under = _without_shared_sign(coefficient, under)
        if decimal_coefficient(coefficient) and not under:
            coefficient, over = _multiplied_in(coefficient, over)
        numerator = [self._power(*pair) for pair in sorted(over, key=self._factor_key)]
        denominator = [self._power(*pair) for pair in sorted(under, key=self._factor_key)]
        result = _quotient(abs(coefficient), numerator, denominator)
        result = minus(result) if coefficient < 0 else result
        divided = self._divided(node, over, under)
        return result if divided is None or size(divided) >= size(result) else divided

    def _divided(self, node: Any, over: list[tuple[Any, Any]], under: list[tuple[Any, Any]]) -> Layout | None:
        """A sum over a product of names, term by term: shorter where most terms have these as factors."""
        if len(over) != 1 or not under or not all(base.is_Symbol for base, _ in under):
            return None
        ((base, exponent),) = over
        if not base.is_Add or exponent != 1:
            return None
        divided = sympy.Add(*(node / base * term for term in base.args))
        return self.expression(divided) if divided.is_Add else None

    def _power(self, base: Any, exponent: Any) -> Layout:
        inside = self.expression(base)
        if exponent == 1:
            return inside
        if exponent == sympy.S.Half:
            return Root(inside)
        return power(inside, Numeral(str(exponent)) if exponent.is_Rational else self.expression(exponent))

    def _factor_key(self, pair: tuple[Any, Any]) -> Key:
        base, exponent = pair
        return (*self._base_key(base), -float(exponent) if exponent.is_Rational else 0.0)

    def _base_key(self, base: Any) -> Key:
        key = self._keys.get(base)
        if key is None:
            if base.is_Symbol:
                kind, place = self._order.get(base.name, (PARAMETER, len(self._order)))
                key = (kind, place, base.name)
            elif isinstance(base, sympy.Function):
                key = (FUNCTION, 0, "", self._term_key(base.args[0]), str(type(base).__name__))
            elif base.is_Add:
                key = (GROUP, 0, "", tuple(sorted(self._term_key(term) for term in base.args)))
            else:
                key = (GROUP, 1, str(base))
            self._keys[base] = key
        return key

    def _term_key(self, term: Any) -> Key:
        if term.is_Rational:
            return (1,)
        factors = [
            (factor.base, factor.exp) if factor.is_Pow else (factor, sympy.S.One)
            for factor in (term.args if term.is_Mul else (term,))
            if not factor.is_Rational
        ]
        return (0, *sorted(self._factor_key(pair) for pair in factors))


def _without_shared_sign(
    coefficient: Rational, factors: list[tuple[Any, Any]]
) -> tuple[Rational, list[tuple[Any, Any]]]:
    """Sums all of whose terms are negative, with their signs turned."""
    turned = []
    for base, exponent in factors:
        if base.is_Add and exponent.is_Integer and exponent % 2 == 1 and all(_number(term) < 0 for term in base.args):
            base, coefficient = sympy.Add(*(-term for term in base.args)), -coefficient
        turned.append((base, exponent))
    return coefficient, turned


def _multiplied_in(coefficient: Rational, factors: list[tuple[Any, Any]]) -> tuple[Rational, list[tuple[Any, Any]]]:
    """0.0075 x + 0.0038 y for 0.0001 (75 x + 38 y): a decimal goes into a sum that it only takes digits from."""
    for place, (base, exponent) in enumerate(factors):
        if not base.is_Add or exponent != 1 or all(abs(_number(term)) == 1 for term in base.args):
            continue
        sizes = {abs(_number(term)) for term in base.args}
        shared = sizes.pop() if len(sizes) == 1 else 1 / abs(coefficient)
        scaled = sympy.Add(*(term / sympy.Rational(shared.numerator, shared.denominator) for term in base.args))
        return coefficient * shared, [*factors[:place], (scaled, exponent), *factors[place + 1 :]]
    return coefficient, factors


def _number(term: Any) -> Rational:
    """The rational factor of a term."""
    number = term.as_coeff_Mul()[0]
    return Rational(int(number.p), int(number.q)) if number.is_Rational else Rational(1)


def _quotient(coefficient: Rational, numerator: list[Layout], denominator: list[Layout]) -> Layout:
    """coefficient · numerator / denominator; numbers stand before a product and inside a fraction with symbols."""
    if not denominator:
        number = rational_layout(coefficient)
        return number if not numerator else product(numerator if coefficient == 1 else [number, *numerator])
    if long_number(coefficient):
        return Fraction(_inside([rational_layout(coefficient), *numerator]), _inside(denominator))
    if coefficient.denominator != 1:
        denominator = [Numeral(str(coefficient.denominator)), *denominator]
    if coefficient.numerator != 1 or not numerator:
        numerator = [Numeral(str(coefficient.numerator)), *numerator]
    return Fraction(_inside(numerator), _inside(denominator))


def _inside(factors: list[Layout]) -> Layout:
    """A product between fraction bars: a single factor needs no parentheses."""
    return factors[0] if len(factors) == 1 else product(factors)
