"""Expressions as the arithmetic of kinematics: numbers are expressions, rates are linear forms of expressions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import TypeAlias

from symgen.diagnostics import SymgenBug
from symgen.model.expressions.combine import divided, minus, negated, plus, times
from symgen.model.expressions.derivative import ONE, derivative
from symgen.model.expressions.expression import Binary, Call, Expression, FunctionName, Name, Negation, Number, Pi
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.mechanism import ZERO
from symgen.model.model import Coordinate, Definition
from symgen.records import dataclass

FUNCTIONS: dict[str, FunctionName] = {"sin": "sin", "cos": "cos", "sqrt": "sqrt"}


@dataclass(frozen=True, slots=True)
class ExpressionNumber:
    """An expression with arithmetic."""

    expression: Expression

    def __add__(self, other: ExpressionNumber) -> ExpressionNumber:
        return ExpressionNumber(plus(self.expression, other.expression))

    def __sub__(self, other: ExpressionNumber) -> ExpressionNumber:
        return ExpressionNumber(minus(self.expression, other.expression))

    def __mul__(self, other: ExpressionNumber) -> ExpressionNumber:
        return ExpressionNumber(times(self.expression, other.expression))

    def __truediv__(self, other: ExpressionNumber) -> ExpressionNumber:
        return ExpressionNumber(divided(self.expression, other.expression))

    def __neg__(self) -> ExpressionNumber:
        return ExpressionNumber(negated(self.expression))


Form: TypeAlias = dict[str, ExpressionNumber]
"""Coefficients of the rates by coordinate."""


class ExpressionArithmetic:
    """The arithmetic of `Kinematics` in expressions; what is compound gets a name in `definitions`."""

    def __init__(self, coordinates: tuple[Coordinate, ...], known: Mapping[str, Expression]) -> None:
        self._coordinates = [coordinate.name for coordinate in coordinates]
        self._known = known
        self.definitions: list[Definition] = []
        self._slopes: dict[tuple[str, str], Expression] = {}

    def value(self, expression: Expression) -> ExpressionNumber:
        """The expression itself."""
        return ExpressionNumber(expression)

    def rate(self, expression: Expression) -> Form:
        """Its gradient."""
        used = self._names_below(expression)
        nested = [name for name in self._known if name in used]
        gradient = {name: self._slope(expression, name, nested) for name in self._coordinates if name in used}
        return {name: ExpressionNumber(slope) for name, slope in gradient.items() if exact_value(slope) != 0}

    def _slope(self, expression: Expression, name: str, nested: Iterable[str]) -> Expression:
        """The derivative by a coordinate; `nested` are the definitions below the expression, in the order of use.

        Derivatives of definitions have names of their own, so that they stay short however definitions nest.
        """

        def of(symbol: str) -> Expression:
            if symbol in self._known:
                return self._slopes[symbol, name]
            return ONE if symbol == name else ZERO

        for one in nested:
            if (one, name) not in self._slopes:
                slope = derivative(self._known[one], of)
                number = exact_value(slope)
                self._slopes[one, name] = (
                    self.named(f"slope.{one}.{name}", ExpressionNumber(slope)).expression
                    if number is None
                    else Number(number)
                )
        return derivative(expression, of)

    def number(self, value: int) -> ExpressionNumber:
        """A whole number."""
        return ExpressionNumber(Number(Fraction(value)))

    def function(self, name: str, operand: ExpressionNumber) -> ExpressionNumber:
        """sin, cos or sqrt."""
        return ExpressionNumber(Call(FUNCTIONS[name], (operand.expression,)))

    def combination(self, terms: Iterable[tuple[ExpressionNumber, Form]]) -> Form:
        """Sum of products, each compound coefficient named."""
        total: Form = {}
        for factor, form in terms:
            for name, coefficient in form.items():
                total[name] = total.get(name, ExpressionNumber(ZERO)) + factor * coefficient
        return {
            name: self.named(f"rate.{name}", coefficient)
            for name, coefficient in total.items()
            if exact_value(coefficient.expression) != 0
        }

    def named(self, name: str, value: ExpressionNumber, /) -> ExpressionNumber:
        """A name for the value, unless it is as short as a name."""
        match value.expression:
            case Number() | Pi() | Name() | Negation(operand=Number() | Pi() | Name()):
                return value
        name = f"{name}.{len(self.definitions)}"
        self.definitions.append(Definition(name, value.expression))
        return ExpressionNumber(Name(name))

    def _names_below(self, expression: Expression) -> set[str]:
        names: set[str] = set()
        pending = [expression]
        while pending:
            for name in names_in(pending.pop()):
                if name.name not in names:
                    names.add(name.name)
                    if name.name in self._known:
                        pending.append(self._known[name.name])
        return names


def rate_of(form: Form) -> Expression:
    """The sum of the coefficients times the rates."""
    total: Expression = ZERO
    for name, coefficient in form.items():
        total = plus(total, times(coefficient.expression, Name(f"{name}_dot")))
    return total


def coefficients(
    velocity: Expression,
    rates_of_name: Callable[[str], Form | None],
    definitions: Mapping[str, Expression],
    combination: Callable[[Iterable[tuple[ExpressionNumber, Form]]], Form],
) -> Form:
    """The coefficients of an expression that is linear in the rates; `rates_of_name` has those of names."""
    one, minus_one = ExpressionNumber(Number(Fraction(1))), ExpressionNumber(Number(Fraction(-1)))

    def of(part: Expression) -> Form:
        match part:
            case Name(name=name):
                form = rates_of_name(name)
                return of(definitions[name]) if form is None and name in definitions else form or {}
            case Negation(operand=operand):
                return combination([(minus_one, of(operand))])
            case Binary(operator="+" | "-" as operator, left=left, right=right):
                return combination([(one, of(left)), (one if operator == "+" else minus_one, of(right))])
            case Binary(operator="*", left=left, right=right):
                return combination([(ExpressionNumber(right), of(left)), (ExpressionNumber(left), of(right))])
            case Binary(operator="/", left=left, right=right):
                return combination([(ExpressionNumber(divided(one.expression, right)), of(left))])
            case Number() | Pi() | Call():
                return {}
            case _:
                raise SymgenBug(f"energy form: not linear in the rates: {part}")

    return of(velocity)
