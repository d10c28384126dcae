"""Numbers for scalars: double precision, for decisions at generation time that are made with wide margins.

Every machine gets the same ones, up to functions other than roots, sines and cosines.
"""

from __future__ import annotations

import math
import operator
import random
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.runtime.effort import spend
from symgen.symbolic.angles.sines import cosine, sine
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached, topological

FUNCTIONS: dict[str, Callable[..., float]] = {
    "sqrt": math.sqrt,
    "sin": sine,
    "cos": cosine,
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
    "rounded": lambda x: x,
    "copysign": math.copysign,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "min": min,
    "max": max,
    "ratio_or_zero": lambda a, b: a / b if b else 0.0,
}


def inner_point(scalars: Sequence[Scalar]) -> dict[str, float]:
    """Numbers at random for the symbols of scalars, inside the domains of most functions; the same for each name."""
    names = (str(node.payload) for node in reached(scalars) if node.op == "symbol")
    return {name: random.Random(name).uniform(0.1, 0.9) for name in names}


class Evaluator:
    """Evaluates a fixed list of scalars at many points."""

    def __init__(self, outputs: Sequence[Scalar]) -> None:
        self.outputs = outputs
        order = topological(outputs)
        place = {node: k for k, node in enumerate(order)}
        self._start = [0.0] * len(order)
        self._symbols: list[tuple[int, str]] = []
        # the place of a second operand is negative where there is none
        self._steps: list[tuple[int, Callable[..., float], int, int]] = []
        for k, node in enumerate(order):
            if node.op == "symbol":
                self._symbols.append((k, str(node.payload)))
            elif node.constant is not None:
                self._start[k] = float(node.constant)
            else:
                first, second = (*(place[argument] for argument in node.args), -1)[:2]
                self._steps.append((k, _function(node), first, second))
        self._places = [place[output] for output in outputs]

    def __call__(self, point: Mapping[str, float]) -> list[float]:
        """The outputs with symbols at `point`; NaN where a function is undefined."""
        spend(len(self._steps))
        values = self._start.copy()
        for k, name in self._symbols:
            values[k] = point[name]
        for k, function, first, second in self._steps:
            try:
                values[k] = function(values[first]) if second < 0 else function(values[first], values[second])
            except (ValueError, ZeroDivisionError, OverflowError):
                values[k] = math.nan
        return [values[place] for place in self._places]


def _function(node: Scalar) -> Callable[..., float]:
    if node.op == "pow":
        assert isinstance(node.payload, Fraction)
        exponent = float(node.payload)
        return lambda base: math.pow(base, exponent)
    if node.op not in FUNCTIONS:
        raise SymgenBug(f"evaluate: unknown operation {node.op}")
    return FUNCTIONS[node.op]
