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
        return _BY_KIND[expression.__class__](self, expression)

    def number(self, number: Number) -> Dual:
        """A literal."""
        return self.numbers.rational(number.value), {}

    def pi(self, _: Pi) -> Dual:
        """The constant."""
        return self.numbers.pi, {}

    def negation(self, negation: Negation) -> Dual:
        """What has the other sign."""
        value, gradient = self.of(negation.operand)
        return -value, _scaled(gradient, -1.0)

    def binary(self, binary: Binary) -> Dual:
        """Sums, products and quotients."""
        return _BINARY[binary.operator](*self.of(binary.left), *self.of(binary.right))

    def power(self, power: Power) -> Dual:
        """A power with a number."""
        value, gradient = self.of(power.base)
        exponent, raised = power.exponent, self.numbers.power
        if not gradient:
            return raised(value, exponent), {}
        slope = self.numbers.rational(exponent) * raised(value, exponent - 1)
        return raised(value, exponent), _scaled(gradient, slope)

    def call(self, call: Call) -> Dual:
        """A function."""
        known = self.numbers.functions
        if call.function == "atan2":
            (y, dy), (x, dx) = map(self.of, call.arguments)
            square = x * x + y * y
            return known["atan2"](y, x), _combined(dy, x / square, dx, -y / square)
        value, gradient = self.of(call.arguments[0])
        if not gradient:
            return known[call.function](value), {}
        return known[call.function](value), _scaled(gradient, _DERIVATIVES[call.function](known, value))

    def name(self, given: Name) -> Dual:
        """A coordinate, a parameter, a component or a definition."""
        name = given.name
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


_Gradient: TypeAlias = dict[int, float]
_BY_KIND: Mapping[type, Callable[..., Dual]] = {
    Number: Gradients.number,
    Pi: Gradients.pi,
    Name: Gradients.name,
    Negation: Gradients.negation,
    Binary: Gradients.binary,
    Power: Gradients.power,
    Call: Gradients.call,
}
_BINARY: Mapping[str, Callable[[float, _Gradient, float, _Gradient], Dual]] = {
    "+": lambda a, da, b, db: (a + b, _combined(da, 1.0, db, 1.0)),
    "-": lambda a, da, b, db: (a - b, _combined(da, 1.0, db, -1.0)),
    "*": lambda a, da, b, db: (a * b, _combined(da, b, db, a)),
    "/": lambda a, da, b, db: (a / b, _combined(da, 1 / b, db, -a / (b * b)) if da or db else {}),
}


def _scaled(gradient: _Gradient, factor: float) -> _Gradient:
    return {index: factor * value for index, value in gradient.items()} if gradient else gradient


def _combined(a: _Gradient, alpha: float, b: _Gradient, beta: float) -> _Gradient:
    if not a:
        return _scaled(b, beta)
    if not b:
        return a if alpha == 1.0 else _scaled(a, alpha)
    result = dict(a) if alpha == 1.0 else _scaled(a, alpha)
    for index, value in b.items():
        result[index] = result.get(index, 0.0) + beta * value
    return result
