"""Derivatives of a combination of outputs by every value of a kernel, in one walk from its end (the reverse mode).

Griewank and Walther, Evaluating Derivatives, chapter 3.  In floating point: they tell how much, not how exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from symgen.ir.kernel import Kernel, Literal, Local, Operand, OperationName, Statement


def adjoints(kernel: Kernel, values: Mapping[str, float], weights: Sequence[float]) -> dict[str, float]:
    """d(sum of weights times outputs)/d(local) by locals, at the `values` that all locals have at a state."""
    found: dict[str, float] = {}

    def add(operand: Operand, share: float) -> None:
        if isinstance(operand, Local):
            found[operand.name] = found.get(operand.name, 0.0) + share

    def value(operand: Operand) -> float:
        return float(operand.value) if isinstance(operand, Literal) else values[operand.name]

    for output, weight in zip(kernel.outputs, weights, strict=True):
        add(output, weight)
    for statement in reversed(kernel.statements):
        given = [found.get(target, 0.0) for target in statement.targets]
        if any(given):
            operands = statement.operands
            slopes = _slopes(statement, [value(x) for x in operands], [values[target] for target in statement.targets])
            for operand, slope in zip(operands, slopes, strict=True):
                add(operand, sum(g * s for g, s in zip(given, slope, strict=True)))
    return found


def _slopes(statement: Statement, x: Sequence[float], y: Sequence[float]) -> list[tuple[float, ...]]:
    """The derivatives of the targets, whose values are y, by each operand; 0 where one is not finite."""
    if statement.operation == "sincos":
        return [(y[1], -y[0])]
    try:
        slopes = _SLOPES[statement.operation](x, y[0])
    except (ZeroDivisionError, OverflowError, ValueError):
        return [(0.0,)] * len(x)
    return [(slope if math.isfinite(slope) else 0.0,) for slope in slopes]


def _quotient(x: Sequence[float], y: float) -> tuple[float, ...]:
    return (1 / x[1], -y / x[1]) if x[1] else (0.0, 0.0)


def _sign(x: float) -> float:
    return math.copysign(1.0, x)


_SLOPES: dict[OperationName, Callable[[Sequence[float], float], tuple[float, ...]]] = {
    "add": lambda _x, _y: (1.0, 1.0),
    "sub": lambda _x, _y: (1.0, -1.0),
    "mul": lambda x, _y: (x[1], x[0]),
    "div": _quotient,
    "ratio_or_zero": _quotient,
    "neg": lambda _x, _y: (-1.0,),
    "abs": lambda x, _y: (_sign(x[0]),),
    "sqrt": lambda _x, y: (0.5 / y,),
    "copysign": lambda x, _y: (_sign(x[0]) * _sign(x[1]), 0.0),
    "min": lambda x, _y: (1.0, 0.0) if x[0] < x[1] else (0.0, 1.0),
    "max": lambda x, _y: (1.0, 0.0) if x[0] > x[1] else (0.0, 1.0),
    "tan": lambda _x, y: (1 + y * y,),
    "asin": lambda x, _y: (1 / math.sqrt(1 - x[0] * x[0]),),
    "acos": lambda x, _y: (-1 / math.sqrt(1 - x[0] * x[0]),),
    "atan": lambda x, _y: (1 / (1 + x[0] * x[0]),),
    "atan2": lambda x, _y: (x[1] / (x[0] * x[0] + x[1] * x[1]), -x[0] / (x[0] * x[0] + x[1] * x[1])),
    "exp": lambda _x, y: (y,),
    "log": lambda x, _y: (1 / x[0],),
    "sinh": lambda x, _y: (math.cosh(x[0]),),
    "cosh": lambda x, _y: (math.sinh(x[0]),),
    "tanh": lambda _x, y: (1 - y * y,),
    "pow": lambda x, y: (x[1] * y / x[0], 0.0),
}
