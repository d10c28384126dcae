"""Expressions as polynomials in the rates, with coefficients in floats or other numbers at one configuration.

Enough to decide whether T is quadratic and a constraint linear in the rates: each coefficient is carried with the sum
of the magnitudes it is made of, so that "zero" has a scale.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TypeAlias

from symgen.diagnostics import Span
from symgen.model.configurations.numbers import FLOATS, Numbers
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.mechanism import is_component

Monomial: TypeAlias = tuple[str, ...]
Polynomial: TypeAlias = dict[Monomial, tuple[float, float]]

# The degree in the rates up to which monomials are told apart; those beyond it are only counted.
HIGHEST_DEGREE = 3
BEYOND: Monomial = ("...",) * (HIGHEST_DEGREE + 1)
# Of the terms of a coefficient, up to which their sum is rounding.
RELATIVE_ZERO = 1e-9


class NotPolynomialError(Exception):
    """The expression is no polynomial in the rates: what it does with a rate, and where."""

    def __init__(self, what: str, span: Span | None) -> None:
        super().__init__(what)
        self.what, self.span = what, span


class Expansion:
    """Expands expressions at one configuration: `values` of coordinates and parameters, `rates`, `definitions`.

    `components` says what the components of points and frames are.
    """

    def __init__(
        self,
        values: Mapping[str, float],
        rates: frozenset[str],
        definitions: Mapping[str, Expression],
        components: Callable[[str], Polynomial] | None = None,
        numbers: Numbers = FLOATS,
    ) -> None:
        self._numbers = numbers
        self._values, self._rates, self._definitions, self._components = values, rates, definitions, components
        self._expanded: dict[str, Polynomial | Exception] = {}

    def of(self, expression: Expression) -> Polynomial:
        """The polynomial; NotPolynomialError, or ArithmeticError and ValueError outside the domain."""
        match expression:
            case Number(value=value):
                return _constant(self._numbers.rational(value))
            case Pi():
                return _constant(self._numbers.pi)
            case Name(name=name):
                return self._name(name)
            case Negation(operand=operand):
                return {monomial: (-value, size) for monomial, (value, size) in self.of(operand).items()}
            case Binary(operator="/", left=left, right=right):
                divisor = self._number(right, "divides by a rate")
                return {
                    monomial: (value / divisor, size / abs(divisor))
                    for monomial, (value, size) in self.of(left).items()
                }
            case Binary(operator="*", left=left, right=right):
                return _product(self.of(left), self.of(right))
            case Binary(operator=operator, left=left, right=right):
                return _sum(self.of(left), self.of(right), 1 if operator == "+" else -1)
            case Power(base=base, exponent=exponent):
                polynomial = self.of(base)
                if not _has_rates(polynomial):
                    return _constant(self._numbers.power(_value(polynomial), exponent))
                if exponent.denominator != 1 or exponent < 0:
                    raise NotPolynomialError(f"has a rate to the power {exponent}", expression.span)
                result = polynomial if exponent > 0 else _constant(1.0)
                for _ in range(min(int(exponent), HIGHEST_DEGREE + 1) - 1):
                    result = _product(result, polynomial)
                return result
            case Call(function=function, arguments=arguments):
                numbers = [self._number(argument, f"takes `{function}` of a rate") for argument in arguments]
                return _constant(self._numbers.functions[function](*numbers))

    def _name(self, name: str) -> Polynomial:
        if name in self._rates:
            return {(name,): (1.0, 1.0)}
        if self._components is not None and is_component(name):
            return self._components(name)
        if name not in self._definitions:
            return _constant(self._values[name])
        if not self._expanded:
            self._expand_definitions()
        expanded = self._expanded[name]
        if isinstance(expanded, Exception):
            raise expanded
        return expanded

    def _expand_definitions(self) -> None:
        """All of them in the order of use, so that a long chain does not become a deep recursion."""
        for name, definition in self._definitions.items():
            try:
                self._expanded[name] = self.of(definition)
            except (NotPolynomialError, ArithmeticError, ValueError) as error:
                self._expanded[name] = error

    def _number(self, expression: Expression, otherwise: str) -> float:
        polynomial = self.of(expression)
        if _has_rates(polynomial):
            raise NotPolynomialError(otherwise, expression.span)
        return _value(polynomial)


def is_zero(coefficient: tuple[float, float]) -> bool:
    """Whether a coefficient is zero up to rounding of the terms it is the sum of."""
    value, size = coefficient
    return abs(value) <= RELATIVE_ZERO * size


def _constant(value: float) -> Polynomial:
    if not math.isfinite(value):
        raise OverflowError
    return {(): (value, abs(value))}


def _value(polynomial: Polynomial) -> float:
    return polynomial.get((), (0.0, 0.0))[0]


def _has_rates(polynomial: Polynomial) -> bool:
    return any(monomial and not is_zero(coefficient) for monomial, coefficient in polynomial.items())


def _sum(left: Polynomial, right: Polynomial, sign: int) -> Polynomial:
    result = dict(left)
    for monomial, (value, size) in right.items():
        before, size_before = result.get(monomial, (0.0, 0.0))
        result[monomial] = (before + sign * value, size_before + size)
    return result


def _product(left: Polynomial, right: Polynomial) -> Polynomial:
    result: Polynomial = {}
    for a, (a_value, a_size) in left.items():
        for b, (b_value, b_size) in right.items():
            monomial = tuple(sorted(a + b))
            value, size = a_value * b_value, a_size * b_size
            if len(monomial) > HIGHEST_DEGREE:
                # Terms of high degree are only counted; their magnitudes must not cancel each other.
                monomial, value = BEYOND, abs(value)
            before, size_before = result.get(monomial, (0.0, 0.0))
            result[monomial] = (before + value, size_before + size)
    return result
