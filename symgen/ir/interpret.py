"""Runs straight-line kernels in Python: the meaning of the IR, bit for bit what C and NumPy compute.

float32 operations are done in double and rounded: for + - * / and square roots that is the correctly rounded result,
because 53 >= 2 * 24 + 2 (Figueroa, When is double rounding innocuous?).
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from symgen.ir.kernel import Block, Check, Function, Kernel, Literal, Operand, Scalar, Statement, Status
from symgen.ir.pairs.wide_functions import is_wide, wide_function
from symgen.ir.rounding import round_to_float32


def _divide(a: float, b: float) -> float:
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def _guarded(function: Callable[..., float]) -> Callable[..., float]:
    def call(*args: float) -> float:
        try:
            return function(*args)
        except (ValueError, OverflowError):
            return math.nan

    return call


OPERATIONS: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": _divide,
    "neg": lambda a: -a,
    "abs": math.fabs,
    "sqrt": _guarded(math.sqrt),
    "copysign": math.copysign,
    "ratio_or_zero": lambda a, b: 0.0 if b == 0.0 else _divide(a, b),
    "min": lambda a, b: a if a < b else b,
    "max": lambda a, b: a if a > b else b,
    "tan": _guarded(math.tan),
    "asin": _guarded(math.asin),
    "acos": _guarded(math.acos),
    "atan": math.atan,
    "atan2": math.atan2,
    "exp": _guarded(math.exp),
    "log": _guarded(math.log),
    "sinh": _guarded(math.sinh),
    "cosh": _guarded(math.cosh),
    "tanh": math.tanh,
    "pow": _guarded(math.pow),
}


def round_float32(value: float) -> float:
    """The nearest float32, ties to even; infinity on overflow."""
    if math.isnan(value) or math.isinf(value):
        return value
    try:
        (rounded,) = struct.unpack("<f", struct.pack("<f", value))
    except OverflowError:
        return math.copysign(math.inf, value)
    return float(rounded)


def round_literal(value: Fraction, scalar: Scalar) -> float:
    """An exact number rounded once to the scalar type; infinite where no float32 reaches it."""
    if scalar == "float64":
        return float(value)
    try:
        return round_to_float32(value)
    except OverflowError:
        return math.copysign(math.inf, value)


class Interpreter:
    """Runs the kernels of one scalar type, with the portable sine and cosine or the C library's."""

    def __init__(self, sincos: Function | None, scalar: Scalar = "float64") -> None:
        self._sincos = sincos
        self._scalar: Scalar = scalar
        self._round: Callable[[float], float] = float if scalar == "float64" else round_float32

    def run(
        self, kernel: Kernel, arguments: Mapping[str, Sequence[float]], parameters: Sequence[float]
    ) -> tuple[Status, list[float]]:
        """The status and, where it is OK, the outputs."""
        values = self._loaded(kernel, arguments, parameters)
        for block in kernel.blocks:
            status = self._block(block, values)
            if status is not Status.OK:
                return status, []
        outputs = [self._operand(operand, values) for operand in kernel.outputs]
        if not all(map(math.isfinite, outputs)):
            return Status.NOT_FINITE, []
        return Status.OK, outputs

    def values(
        self, kernel: Kernel, arguments: Mapping[str, Sequence[float]], parameters: Sequence[float]
    ) -> dict[str, float]:
        """What every local of a regular state takes, whatever the checks say."""
        values = self._loaded(kernel, arguments, parameters)
        for statement in kernel.statements:
            self._statement(statement, values)
        return values

    def _loaded(
        self, kernel: Kernel, arguments: Mapping[str, Sequence[float]], parameters: Sequence[float]
    ) -> dict[str, float]:
        sources = {**arguments, "p": parameters}
        return {load.local: self._round(sources[load.argument][load.index]) for load in kernel.loads}

    def _block(self, block: Block, values: dict[str, float]) -> Status:
        for statement in block.statements:
            self._statement(statement, values)
        for check in block.checks:
            if not self._passes(check, values):
                first = Status.OK if check.first is None else self._block(check.first, dict(values))
                return check.status if first is Status.OK else first
        return Status.OK

    def _passes(self, check: Check, values: dict[str, float]) -> bool:
        value, limit = self._operand(check.value, values), self._operand(check.limit, values)
        return value >= limit if check.inclusive else value > limit

    def _operand(self, operand: Operand, values: dict[str, float]) -> float:
        if isinstance(operand, Literal):
            return round_literal(operand.value, self._scalar)
        return values[operand.name]

    def _statement(self, statement: Statement, values: dict[str, float]) -> None:
        operands = [self._operand(operand, values) for operand in statement.operands]
        if statement.operation == "sincos":
            results = self._pair(operands[0])
        elif is_wide(statement):
            results = self._called(wide_function(statement.operation, self._scalar), operands)
        else:
            results = (self._round(OPERATIONS[statement.operation](*operands)),)
        values.update(zip(statement.targets, results, strict=True))

    def _pair(self, x: float) -> tuple[float, ...]:
        if self._sincos is None:
            return self._round(_guarded(math.sin)(x)), self._round(_guarded(math.cos)(x))
        return self._called(self._sincos, (x,))

    def _called(self, function: Function, operands: Sequence[float]) -> tuple[float, ...]:
        values = dict(zip(function.parameters, operands, strict=True))
        for statement in function.statements:
            self._statement(statement, values)
        return tuple(values[name] for name in function.results)
