"""Scalars and their gradients in 40 decimal digits: the same numbers on every machine.

Values come from one sweep over the graph, gradients from one sweep back for each output (Griewank and Walther,
Evaluating Derivatives, ch. 3).  Sines and cosines are Taylor sums of a halved angle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal, localcontext

from symgen.runtime.effort import DECIMAL, spend
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.traverse import topological

DIGITS = 40
HALVINGS = 5
ZERO, ONE, TWO = Decimal(0), Decimal(1), Decimal(2)


class UndefinedError(Exception):
    """A function has no value here, or no rule in this module."""


def sine_cosine(angle: Decimal) -> tuple[Decimal, Decimal]:
    """(sin, cos) to about 38 digits; |angle| is a few turns at most."""
    turn = 2 * Decimal(PI.numerator) / Decimal(PI.denominator)
    x = (angle % turn) / 2**HALVINGS
    square, term, sine, cosine, k = x * x, x, x, ONE, 1
    even = ONE
    while abs(term) > Decimal(10) ** -(DIGITS + 2) and k < 60:
        even = -even * square / (k * (k + 1))
        cosine += even
        term = -term * square / ((k + 1) * (k + 2))
        sine += term
        k += 2
    for _ in range(HALVINGS):
        sine, cosine = TWO * sine * cosine, ONE - TWO * sine * sine
    return sine, cosine


class DecimalEvaluator:
    """Values and gradients of a fixed list of scalars."""

    def __init__(self, outputs: Sequence[Scalar]) -> None:
        self._outputs = [*outputs]
        self._order = topological(outputs)

    def values(self, point: Mapping[str, Decimal]) -> list[Decimal]:
        """The outputs; UndefinedError where one has no value."""
        known = self._sweep(point)
        return [known[output] for output in self._outputs]

    def gradients(
        self, point: Mapping[str, Decimal], names: Sequence[str]
    ) -> tuple[list[Decimal], list[list[Decimal]]]:
        """The outputs and their derivatives by the named symbols."""
        with localcontext() as context:
            context.prec = DIGITS
            known = self._sweep(point)
            try:
                rows = [self._slopes(output, known, names) for output in self._outputs]
            except ArithmeticError as error:
                raise UndefinedError(str(error)) from error
            return [known[output] for output in self._outputs], rows

    def _slopes(self, output: Scalar, known: Mapping[Scalar, Decimal], names: Sequence[str]) -> list[Decimal]:
        spend(DECIMAL * len(self._order))
        adjoint = {output: ONE}
        slopes: dict[str, Decimal] = {}
        for node in reversed(self._order):
            weight = adjoint.get(node)
            if weight is None or not weight:
                continue
            if node.op == "symbol":
                slopes[str(node.payload)] = weight
            for argument, partial in zip(node.args, _partials(node, known), strict=True):
                adjoint[argument] = adjoint.get(argument, ZERO) + weight * partial
        return [slopes.get(name, ZERO) for name in names]

    def _sweep(self, point: Mapping[str, Decimal]) -> dict[Scalar, Decimal]:
        spend(DECIMAL * len(self._order))
        known: dict[Scalar, Decimal] = {}
        pairs: dict[Scalar, tuple[Decimal, Decimal]] = {}
        with localcontext() as context:
            context.prec = DIGITS
            try:
                for node in self._order:
                    if node.op in ("sin", "cos"):
                        angle = node.args[0]
                        if angle not in pairs:
                            pairs[angle] = sine_cosine(known[angle])
                        known[node] = pairs[angle][node.op == "cos"]
                    else:
                        known[node] = _value(node, [known[argument] for argument in node.args], point)
            except ArithmeticError as error:  # beyond the range of decimals, too
                raise UndefinedError(str(error)) from error
        return known


def _value(node: Scalar, args: list[Decimal], point: Mapping[str, Decimal]) -> Decimal:
    if node.constant is not None:
        return Decimal(node.constant.numerator) / Decimal(node.constant.denominator)
    match node.op:
        case "symbol":
            return point[str(node.payload)]
        case "add":
            return args[0] + args[1]
        case "sub":
            return args[0] - args[1]
        case "mul":
            return args[0] * args[1]
        case "div":
            return args[0] / args[1]
        case "ratio_or_zero":
            return args[0] / args[1] if args[1] else ZERO
        case "neg":
            return -args[0]
        case "abs":
            return abs(args[0])
        case "sqrt":
            return args[0].sqrt()
        case "copysign":
            return abs(args[0]).copy_sign(args[1])
        case "exp":
            return args[0].exp()
        case "log":
            return args[0].ln()
        case "tan":
            sine, cosine = sine_cosine(args[0])
            return sine / cosine
        case _:
            raise UndefinedError(node.op)


def _partials(node: Scalar, known: Mapping[Scalar, Decimal]) -> tuple[Decimal, ...]:
    args = [known[argument] for argument in node.args]
    value = known[node]
    match node.op:
        case "add":
            return ONE, ONE
        case "sub":
            return ONE, -ONE
        case "mul":
            return args[1], args[0]
        case "div":
            return ONE / args[1], -value / args[1]
        case "ratio_or_zero":
            return (ONE / args[1], -value / args[1]) if args[1] else (ZERO, ZERO)
        case "neg":
            return (-ONE,)
        case "abs":
            return (ONE.copy_sign(args[0]),)
        case "sqrt":
            return (ONE / (TWO * value) if value else ZERO,)
        case "copysign":
            return ONE.copy_sign(args[1]) * ONE.copy_sign(args[0]), ZERO
        case "sin":
            return (sine_cosine(args[0])[1],)
        case "cos":
            return (-sine_cosine(args[0])[0],)
        case "exp":
            return (value,)
        case "log":
            return (ONE / args[0],)
        case "tan":
            return (ONE + value * value,)
        case _:
            return (ZERO,) * len(args)
