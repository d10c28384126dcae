"""A tool of its own that shares equal values and folds numbers, and nothing more: it writes straight lines of C."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol
from symgen.laboratory.bench.peers.engines.straight import StraightLines, loaded, third_of

_FOLDED: Mapping[str, Callable[[float, float], float]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv,
}  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Value:
    """An operation on values, an entry of an input, or a number; equal ones of an engine are the same object."""

    engine: SsaEngine
    place: int
    operation: str
    operands: tuple[Value, ...] = ()
    number: float | None = None
    entry: tuple[str, int] | None = None

    def __add__(self, other: Value) -> Value:
        return self.engine.sum(self, other)

    def __sub__(self, other: Value) -> Value:
        return self.engine.difference(self, other)

    def __mul__(self, other: Value) -> Value:
        return self.engine.product(self, other)

    def __truediv__(self, other: Value) -> Value:
        return self.engine.quotient(self, other)

    def __neg__(self) -> Value:
        return self.engine.negative(self)


class SsaEngine(Engine):
    """Operations with 0 and 1 and on numbers alone are folded, signs are moved outwards, equal operations are one."""

    tool: ClassVar[str] = "SSA"

    def __init__(self) -> None:
        self._known: dict[tuple[object, ...], Value] = {}

    def symbols(self, array: str, length: int) -> list[Symbol]:
        """The entries of an input array."""
        return [self._shared("entry", (), None, (array, i)) for i in range(length)]

    def number(self, value: Fraction) -> Symbol:
        """A number, rounded to a float64."""
        return self._constant(float(value))

    def pi(self) -> Symbol:
        """The float64 nearest to π."""
        return self._constant(math.pi)

    def power(self, base: Symbol, exponent: Fraction) -> Symbol:
        """By products, a root and a quotient."""
        if exponent < 0:
            return self._constant(1.0) / self.power(base, -exponent)
        whole = self._constant(1.0)
        for _ in range(int(exponent)):
            whole = whole * base
        if (rest := exponent % 1) == 0:
            return whole
        assert rest == Fraction(1, 2), "the model language has halves at most"
        return whole * self.call("sqrt", [base])

    def call(self, function: str, arguments: Sequence[Symbol]) -> Symbol:
        """The function of <math.h> with that name."""
        numbers = [argument.number for argument in arguments]
        if None not in numbers:
            return self._constant(getattr(math, function)(*numbers))
        return self._value(function, *arguments)

    def derivative(self, value: Symbol, by: Symbol) -> Symbol:
        """By the chain rule, forwards; of sines, cosines and roots alone among the functions."""
        known: dict[int, Value] = {}
        for node in _ordered([value]):
            known[node.place] = self._slope(node, by, [known[operand.place] for operand in node.operands])
        return known[value.place]

    def is_zero(self, value: Symbol) -> bool:
        """Whether the value was folded to 0."""
        return bool(value.number == 0)

    def name(self, value: Symbol) -> Symbol:
        """The value itself: every one has a name."""
        return value

    def straight(self, inputs: Inputs, outputs: Sequence[Symbol]) -> StraightLines:
        """One line for each value, operands first."""
        entries: dict[tuple[str, int], None] = {}
        names: dict[int, str] = {}
        values: list[str] = []
        for node in _ordered(outputs):
            operands = [names[operand.place] for operand in node.operands]
            if node.number is not None:
                names[node.place] = f"(REAL){node.number!r}"
            elif node.entry is not None:
                entries[node.entry] = None
                names[node.place] = loaded(*node.entry)
            else:
                names[node.place] = f"v{len(values)}"
                values.append(_written(node.operation, operands))
        arrays = ("q", "qd", third_of(list(inputs)), "p")
        return StraightLines(arrays, tuple(entries), tuple(values), tuple(names[output.place] for output in outputs))

    def c_function(self, name: str, inputs: Inputs, outputs: Sequence[Symbol]) -> tuple[str, tuple[str, ...], bool]:
        """The lines as a function of one state."""
        return self.straight(inputs, outputs).function(name), (name,), False

    def negative(self, a: Value) -> Value:
        """-a."""
        if a.number is not None:
            return self._constant(-a.number)
        return a.operands[0] if a.operation == "neg" else self._value("neg", a)

    def sum(self, a: Value, b: Value) -> Value:
        """a + b."""
        if a.number == 0 or b.number == 0:
            return b if a.number == 0 else a
        if b.operation == "neg":
            return self.difference(a, b.operands[0])
        if a.operation == "neg":
            return self.difference(b, a.operands[0])
        return self._folded("+", *sorted((a, b), key=_place))

    def difference(self, a: Value, b: Value) -> Value:
        """a - b."""
        if b.number == 0:
            return a
        if a.number == 0:
            return self.negative(b)
        if a is b:
            return self._constant(0.0)
        return self.sum(a, b.operands[0]) if b.operation == "neg" else self._folded("-", a, b)

    def product(self, a: Value, b: Value) -> Value:
        """a b."""
        for one, other in ((a, b), (b, a)):
            if one.number == 0:
                return self._constant(0.0)
            if one.number == 1:
                return other
            if one.number == -1:
                return self.negative(other)
            if one.operation == "neg":
                return self.negative(self.product(one.operands[0], other))
        return self._folded("*", *sorted((a, b), key=_place))

    def quotient(self, a: Value, b: Value) -> Value:
        """a / b."""
        if a.number == 0 or b.number == 1:
            return a
        if a.operation == "neg":
            return self.negative(self.quotient(a.operands[0], b))
        return self._folded("/", a, b)

    def _folded(self, operation: str, a: Value, b: Value) -> Value:
        if a.number is not None and b.number is not None:
            return self._constant(_FOLDED[operation](a.number, b.number))
        return self._value(operation, a, b)

    def _constant(self, number: float) -> Value:
        return self._shared("number", (), number + 0.0)

    def _value(self, operation: str, *operands: Value) -> Value:
        return self._shared(operation, operands, None)

    def _shared(
        self, operation: str, operands: tuple[Value, ...], number: float | None, entry: tuple[str, int] | None = None
    ) -> Value:
        key = operation, tuple(map(_place, operands)), number, entry
        if key not in self._known:
            self._known[key] = Value(self, len(self._known), operation, operands, number, entry)
        return self._known[key]

    def _slope(self, node: Value, by: Value, slopes: Sequence[Value]) -> Value:
        if not slopes:
            return self._constant(1.0 if node is by else 0.0)
        if all(slope.number == 0 for slope in slopes):
            return self._constant(0.0)
        first, *_ = node.operands
        match node.operation:
            case "+":
                return slopes[0] + slopes[1]
            case "-":
                return slopes[0] - slopes[1]
            case "neg":
                return -slopes[0]
            case "*":
                return slopes[0] * node.operands[1] + first * slopes[1]
            case "/":
                return (slopes[0] - node * slopes[1]) / node.operands[1]
            case "sin":
                return self._value("cos", first) * slopes[0]
            case "cos":
                return -(self._value("sin", first) * slopes[0])
            case "sqrt":
                return slopes[0] / (node + node)
        raise NotImplementedError(f"the derivative of {node.operation}")


def _place(value: Value) -> int:
    return value.place


def _ordered(outputs: Sequence[Value]) -> list[Value]:
    """What the outputs need, operands first: as they were made."""
    seen: set[int] = set()
    needed: list[Value] = []
    stack = list(outputs)
    while stack:
        node = stack.pop()
        if node.place not in seen:
            seen.add(node.place)
            needed.append(node)
            stack += node.operands
    return sorted(needed, key=_place)


def _written(operation: str, operands: Sequence[str]) -> str:
    if operation in _FOLDED:
        return f" {operation} ".join(operands)
    return f"-{operands[0]}" if operation == "neg" else f"{operation}({', '.join(operands)})"
