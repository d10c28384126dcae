"""What a symbolic tool has to offer to be a peer: scalars with operators, derivatives, names, C."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, ClassVar, Protocol, TypeAlias

from symgen.laboratory.bench.peers.engines.straight import StraightLines
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.model import Model

Symbol: TypeAlias = Any  # a scalar of the tool; supports + - * / and unary minus
Matrix: TypeAlias = list[list[Symbol]]
Inputs: TypeAlias = dict[str, list[Symbol]]


class Engine(Protocol):
    """One tool, for the length of one kernel."""

    tool: ClassVar[str]  # the name in tables

    def symbols(self, array: str, length: int) -> list[Symbol]:
        """The entries of an input array."""
        ...

    def number(self, value: Fraction) -> Symbol:
        """An exact number."""
        ...

    def pi(self) -> Symbol:
        """The number π."""
        ...

    def power(self, base: Symbol, exponent: Fraction) -> Symbol:
        """base ** exponent."""
        ...

    def call(self, function: str, arguments: Sequence[Symbol]) -> Symbol:
        """One of the functions of the model language."""
        ...

    def derivative(self, value: Symbol, by: Symbol) -> Symbol:
        """∂value/∂by."""
        ...

    def gradient(self, value: Symbol, by: Sequence[Symbol]) -> list[Symbol]:
        """The derivatives by each of several symbols, as the tool takes them together."""
        return [self.derivative(value, x) for x in by]

    def rates(self, values: Sequence[Symbol], by: Sequence[Symbol], direction: Sequence[Symbol]) -> list[Symbol]:
        """The derivatives of all values along a direction."""
        totals = []
        for value in values:
            total = self.number(Fraction(0))
            for x, step in zip(by, direction, strict=True):
                total = total + self.derivative(value, x) * step
            totals.append(total)
        return totals

    def is_zero(self, value: Symbol) -> bool:
        """Whether the tool itself has found the value to be the constant 0."""
        ...

    def name(self, value: Symbol) -> Symbol:
        """The value as an intermediate of its own, where the tool needs to be told."""
        ...

    def straight(self, inputs: Inputs, outputs: Sequence[Symbol]) -> StraightLines | None:  # noqa: ARG002 - of some
        """Straight lines, of a tool whose C is nothing else; None for others."""
        return None

    def c_function(self, name: str, inputs: Inputs, outputs: Sequence[Symbol]) -> tuple[str, tuple[str, ...], bool]:
        """C source, the functions that count, and whether `name` takes CasADi's arg/res arrays instead of pointers."""
        ...


def translate(engine: Engine, expression: Expression, scope: dict[str, Symbol]) -> Symbol:
    """An expression of the model file in the tool's scalars."""

    def of(part: Expression) -> Symbol:
        return translate(engine, part, scope)

    match expression:
        case Number(value=value):
            return engine.number(value)
        case Pi():
            return engine.pi()
        case Name(name=name):
            return scope[name]
        case Negation(operand=operand):
            return -of(operand)
        case Binary(operator="+", left=left, right=right):
            return of(left) + of(right)
        case Binary(operator="-", left=left, right=right):
            return of(left) - of(right)
        case Binary(operator="*", left=left, right=right):
            return of(left) * of(right)
        case Binary(left=left, right=right):
            return of(left) / of(right)
        case Power(base=base, exponent=exponent):
            return engine.power(of(base), exponent)
        case Call(function=function, arguments=arguments):
            return engine.call(function, [of(argument) for argument in arguments])


def scope_of(engine: Engine, model: Model, inputs: Inputs) -> dict[str, Symbol]:
    """Every name of the model file as a scalar of the tool."""
    scope = {coordinate.name: inputs["q"][i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {coordinate.rate: inputs["qd"][i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {parameter.name: inputs["p"][i] for i, parameter in enumerate(model.parameters)}
    for definition in model.definitions:
        scope[definition.name] = translate(engine, definition.value, scope)
    return scope
