"""Numbers for scalars: double precision, for decisions at generation time that are made with wide margins."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.graph.scalar import Scalar
from symgen.graph.traverse import topological

FUNCTIONS: dict[str, Callable[..., float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "atan2": math.atan2,
    "exp": math.exp,
    "log": math.log,
    "sinh": math.sinh,
    "cosh": math.cosh,
    "tanh": math.tanh,
    "abs": abs,
    "copysign": math.copysign,
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "min": min,
    "max": max,
    "ratio_or_zero": lambda a, b: a / b if b else 0.0,
}


class Evaluator:
    """Evaluates a fixed list of scalars at many points."""

    def __init__(self, outputs: Sequence[Scalar]) -> None:
        self.outputs = outputs
        self.order = topological(outputs)

    def __call__(self, point: Mapping[str, float]) -> list[float]:
        """The outputs with symbols at `point`; NaN where a function is undefined."""
        values: dict[int, float] = {}
        for node in self.order:
            values[node.serial] = _value(node, [values[argument.serial] for argument in node.args], point)
        return [values[output.serial] for output in self.outputs]


def _value(node: Scalar, args: list[float], point: Mapping[str, float]) -> float:
    if node.op == "symbol":
        return point[str(node.payload)]
    if node.op == "const":
        assert isinstance(node.payload, Fraction)
        return float(node.payload)
    try:
        if node.op == "pow":
            assert isinstance(node.payload, Fraction)
            return math.pow(args[0], float(node.payload))
        if node.op not in FUNCTIONS:
            raise SymgenBug(f"evaluate: unknown operation {node.op}")
        return float(FUNCTIONS[node.op](*args))
    except (ValueError, ZeroDivisionError, OverflowError):
        return math.nan
