"""Scalars and their gradients in 40 digits: the same numbers on every machine.

Values come from one sweep over the graph, gradients from one sweep back for each output (Griewank and Walther,
Evaluating Derivatives, ch. 3), in the ball arithmetic of Arb (Johansson, IEEE Trans. Computers 66, 2017), of which the
midpoints count.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from fractions import Fraction
from typing import Any, TypeAlias

from flint import arb, ctx, fmpq

from symgen.runtime.effort import PRECISE, spend
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

# A number of Arb without a bound.
Precise: TypeAlias = Any
# Binary digits, 40 decimal ones.
GRADIENT_BITS = 136


class UndefinedError(Exception):
    """A function has no value here, or no rule in this module."""


def precision() -> AbstractContextManager[None]:
    """The working precision, for a while."""
    working: AbstractContextManager[None] = ctx.workprec(GRADIENT_BITS)
    return working


def precise(value: Fraction | float) -> Precise:
    """A number at the working precision."""
    with precision():
        return arb(fmpq(value.numerator, value.denominator)).mid() if isinstance(value, Fraction) else arb(value)


class PreciseEvaluator:
    """Values and gradients of a fixed list of scalars."""

    def __init__(self, outputs: Sequence[Scalar]) -> None:
        self._outputs = [*outputs]
        self._order = topological(outputs)

    def values(self, point: Mapping[str, Precise]) -> list[Precise]:
        """The outputs; UndefinedError where one has no value."""
        with precision():
            known = self._sweep(point)
            return _midpoints([known[output] for output in self._outputs])

    def gradients(
        self, point: Mapping[str, Precise], names: Sequence[str]
    ) -> tuple[list[Precise], list[list[Precise]]]:
        """The outputs and their derivatives by the named symbols."""
        with precision():
            known = self._sweep(point)
            rows = [_midpoints(self._slopes(output, known, names)) for output in self._outputs]
            return _midpoints([known[output] for output in self._outputs]), rows

    def _slopes(self, output: Scalar, known: Mapping[Scalar, Precise], names: Sequence[str]) -> list[Precise]:
        spend(PRECISE * len(self._order))
        zero = arb(0)
        adjoint = {output: arb(1)}
        slopes: dict[str, Precise] = {}
        for node in reversed(self._order):
            weight = adjoint.get(node)
            if weight is None or weight == 0:
                continue
            if node.op == "symbol":
                slopes[str(node.payload)] = weight
            elif node.args:
                for argument, partial in zip(node.args, _partials(node, known), strict=True):
                    adjoint[argument] = adjoint.get(argument, zero) + weight * partial
        return [slopes.get(name, zero) for name in names]

    def _sweep(self, point: Mapping[str, Precise]) -> dict[Scalar, Precise]:
        spend(PRECISE * len(self._order))
        known: dict[Scalar, Precise] = {}
        for node in self._order:
            if node.op == "symbol":
                known[node] = point[str(node.payload)]
            elif node.constant is not None:
                known[node] = arb(fmpq(node.constant.numerator, node.constant.denominator))
            elif node.op in _VALUES:
                known[node] = _VALUES[node.op](*(known[argument] for argument in node.args))
            else:
                raise UndefinedError(node.op)
        return known


def _midpoints(values: Sequence[Precise]) -> list[Precise]:
    if not all(value.is_finite() for value in values):
        raise UndefinedError("a value or slope is not finite")
    return [value.mid() for value in values]


def _sign(x: Precise) -> int:
    return -1 if x < 0 else 1


def _ratio_or_zero(a: Precise, b: Precise) -> Precise:
    return arb(0) if b.contains(0) else a / b


_VALUES: dict[str, Callable[..., Precise]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "ratio_or_zero": _ratio_or_zero,
    "neg": lambda a: -a,
    "abs": abs,
    "sqrt": lambda a: a.mid().sqrt(),  # which has no value for a bound that reaches below 0
    "copysign": lambda a, b: _sign(b) * abs(a),
    "sin": arb.sin,
    "cos": arb.cos,
    "exp": arb.exp,
    "log": arb.log,
    "tan": arb.tan,
}


def _partials(node: Scalar, known: Mapping[Scalar, Precise]) -> tuple[Precise, ...]:
    args = [known[argument] for argument in node.args]
    value = known[node]
    match node.op:
        case "add":
            return 1, 1
        case "sub":
            return 1, -1
        case "mul":
            return args[1], args[0]
        case "div":
            return 1 / args[1], -value / args[1]
        case "ratio_or_zero":
            return (0, 0) if args[1].contains(0) else (1 / args[1], -value / args[1])
        case "neg":
            return (-1,)
        case "abs":
            return (_sign(args[0]),)
        case "sqrt":
            return (0 if value == 0 else 1 / (2 * value),)
        case "copysign":
            return _sign(args[1]) * _sign(args[0]), 0
        case "sin":
            return (args[0].cos(),)
        case "cos":
            return (-args[0].sin(),)
        case "exp":
            return (value,)
        case "log":
            return (1 / args[0],)
        case _:  # the tangent
            return (1 + value * value,)
