"""Values with their gradients in the coordinates, in floats or other numbers: forward differentiation, sparse."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from symgen.model.configurations.numbers import FLOATS, Numbers
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.mechanism import is_component

Dual: TypeAlias = tuple[float, dict[int, float]]

_Functions: TypeAlias = Mapping[str, Callable[..., float]]

_DERIVATIVES: dict[str, Callable[[_Functions, float], float]] = {
    "sin": lambda f, x: f["cos"](x),
    "cos": lambda f, x: -f["sin"](x),
    "tan": lambda f, x: 1 + f["tan"](x) ** 2,
    "asin": lambda f, x: 1 / f["sqrt"](1 - x * x),
    "acos": lambda f, x: -1 / f["sqrt"](1 - x * x),
    "atan": lambda _, x: 1 / (1 + x * x),
    "sqrt": lambda f, x: 0.5 / f["sqrt"](x),
    "exp": lambda f, x: f["exp"](x),
    "log": lambda _, x: 1 / x,
    "sinh": lambda f, x: f["cosh"](x),
    "cosh": lambda f, x: f["sinh"](x),
    "tanh": lambda f, x: 1 - f["tanh"](x) ** 2,
}


class Gradients:
    """Evaluates expressions and their gradients at one configuration; definitions are evaluated once.

    `components` says what the components of points and frames are, and their gradients.
    """

    def __init__(
        self,
        values: Mapping[str, float],
        index: Mapping[str, int],
        definitions: Mapping[str, Expression],
        components: Callable[[str], Dual] | None = None,
        numbers: Numbers = FLOATS,
    ) -> None:
        self.index, self.numbers = index, numbers
        self._values, self._definitions, self._components = values, definitions, components
        self._known: dict[str, Dual | Exception] = {}

    def of(self, expression: Expression) -> Dual:
        """Value and gradient; ArithmeticError or ValueError outside the domain."""
        match expression:
            case Number(value=literal):
                return self.numbers.rational(literal), {}
            case Pi():
                return self.numbers.pi, {}
            case Name(name=name):
                return self._name(name)
            case Negation(operand=operand):
                value, gradient = self.of(operand)
                return -value, _scaled(gradient, -1.0)
            case Binary(operator=operator, left=left, right=right):
                return _binary(operator, self.of(left), self.of(right))
            case Power(base=base, exponent=exponent):
                value, gradient = self.of(base)
                power = self.numbers.power
                if not gradient:
                    return power(value, exponent), {}
                slope = self.numbers.rational(exponent) * power(value, exponent - 1)
                return power(value, exponent), _scaled(gradient, slope)
            case Call(function="atan2", arguments=(first, second)):
                (y, dy), (x, dx) = self.of(first), self.of(second)
                square = x * x + y * y
                return self.numbers.functions["atan2"](y, x), _combined(dy, x / square, dx, -y / square)
            case Call(function=function, arguments=arguments):
                value, gradient = self.of(arguments[0])
                known = self.numbers.functions
                slope = _DERIVATIVES[function](known, value) if gradient else 0.0
                return known[function](value), _scaled(gradient, slope)

    def _name(self, name: str) -> Dual:
        if name in self.index:
            return self._values[name], {self.index[name]: 1.0}
        if self._components is not None and is_component(name):
            return self._components(name)
        if name not in self._definitions:
            return self._values[name], {}
        if not self._known:
            self._evaluate_definitions()
        known = self._known[name]
        if isinstance(known, Exception):
            raise known
        return known

    def _evaluate_definitions(self) -> None:
        """All of them in the order of use, so that a long chain does not become a deep recursion."""
        for name, definition in self._definitions.items():
            try:
                self._known[name] = self.of(definition)
            except (ArithmeticError, ValueError, KeyError) as error:
                # Definitions of rates have no place here; nothing that is evaluated here uses them.
                self._known[name] = error


def _binary(operator: str, left: Dual, right: Dual) -> Dual:
    (a, da), (b, db) = left, right
    match operator:
        case "+":
            return a + b, _combined(da, 1.0, db, 1.0)
        case "-":
            return a - b, _combined(da, 1.0, db, -1.0)
        case "*":
            return a * b, _combined(da, b, db, a)
        case _:
            return a / b, _combined(da, 1 / b, db, -a / (b * b))


def _scaled(gradient: dict[int, float], factor: float) -> dict[int, float]:
    return {index: factor * value for index, value in gradient.items()}


def _combined(a: dict[int, float], alpha: float, b: dict[int, float], beta: float) -> dict[int, float]:
    if not b:
        return a if alpha == 1.0 else _scaled(a, alpha)
    result = _scaled(a, alpha)
    for index, value in b.items():
        result[index] = result.get(index, 0.0) + beta * value
    return result
