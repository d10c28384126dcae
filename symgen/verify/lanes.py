"""What rounding does to the result of a kernel, estimated at many states at once: where to look for its worst.

The reverse mode of automatic differentiation with a lane for each state, in float64.  Functions are those of NumPy,
whose last bits differ between machines: no verdict rests on them.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from symgen.ir.kernel import Kernel, Literal, Operand, OperationName, Statement
from symgen.verify.many_states import VECTORISED

# A float64 for each state; slopes have a row for each combination of outputs, too.
Lanes: TypeAlias = Any
# Combinations of outputs with random signs, which stand for all of them.
COMBINATIONS = 3
# The largest of 8 random changes of what is given, in root mean squares.
LARGEST = 1.5
# Their results need no rounding.
EXACT = frozenset({"neg", "abs", "copysign", "min", "max"})


def estimates(kernel: Kernel, given: Mapping[str, Lanes]) -> Lanes:
    """The rounding errors of a kernel in units of d + eps |y|, as if all were independent, and 0 where it refuses.

    `given` holds the arguments and the parameters `p`, a row for each state.  d is that of the kernel itself for
    arguments and parameters; what literals of the model add is left out, so that this is more than there is rather
    than less.
    """
    own, unit = _weighed(kernel, given)
    return np.sqrt(sum(own.values(), np.zeros(unit.shape))) / unit


def _weighed(kernel: Kernel, given: Mapping[str, Lanes]) -> tuple[dict[str, Lanes], Lanes]:
    """Mean squares of what one roundoff of each target does to combinations of outputs, and d + eps |y|.

    In units of the roundoff; infinite are the units where the kernel refuses.
    """
    count = len(next(iter(given.values())))
    generator = random.Random(kernel.name)
    signs = [[generator.choice((-1.0, 1.0)) for _ in kernel.outputs] for _ in range(COMBINATIONS)]
    with np.errstate(all="ignore"):
        values, regular = _values(kernel, given, count)
        outputs = [_value(x, values) for x in kernel.outputs]
        own, inputs = _shares(kernel, values, np.array(signs))
        unit = np.sqrt(sum(x * x for x in outputs)) + LARGEST * np.sqrt(inputs)
        regular &= np.isfinite(unit) & (unit > 0) & np.isfinite(sum(own.values(), np.zeros(count)))
    return {target: np.where(regular, share, 0.0) for target, share in own.items()}, np.where(regular, unit, np.inf)


def _value(operand: Operand, values: Mapping[str, Lanes]) -> Lanes:
    return float(operand.value) if isinstance(operand, Literal) else values[operand.name]


def _values(kernel: Kernel, given: Mapping[str, Lanes], count: int) -> tuple[dict[str, Lanes], Lanes]:
    """What every local is on the way of a regular state, and where no check fails."""
    values: dict[str, Lanes] = {load.local: given[load.argument][:, load.index] for load in kernel.loads}
    regular = np.ones(count, dtype=bool)
    for block in kernel.blocks:
        for statement in block.statements:
            x = [_value(operand, values) for operand in statement.operands]
            if statement.operation == "sincos":
                values |= zip(statement.targets, (np.sin(x[0]), np.cos(x[0])), strict=True)
            else:
                values[statement.targets[0]] = _VALUES[statement.operation](*x)
        for check in block.checks:
            value, limit = _value(check.value, values), _value(check.limit, values)
            regular &= value >= limit if check.inclusive else value > limit
    return values, regular


def _shares(kernel: Kernel, values: Mapping[str, Lanes], signs: Lanes) -> tuple[dict[str, Lanes], Lanes]:
    """Mean squares over combinations of outputs of what one roundoff of each target, and of all that is given, does
    to them."""
    slopes: dict[str, Lanes] = {}
    own: dict[str, Lanes] = {}
    inputs = np.zeros(1)

    def add(operand: Operand, slope: Lanes) -> None:
        if not isinstance(operand, Literal):
            known = slopes.get(operand.name)
            slopes[operand.name] = slope if known is None else known + slope

    for place, output in enumerate(kernel.outputs):
        add(output, signs[:, place : place + 1])
    for statement in reversed(kernel.statements):
        above = [slopes.pop(target, None) for target in statement.targets]
        if not _is_exact(statement):
            for target, slope in zip(statement.targets, above, strict=True):
                if slope is not None:
                    own[target] = np.mean((slope * values[target]) ** 2, axis=0)
        if statement.operation == "sincos":
            sine, cosine = (values[target] for target in statement.targets)
            along = (0.0 if slope is None else slope * x for slope, x in zip(above, (cosine, -sine), strict=True))
            add(statement.operands[0], sum(along))
        elif above[0] is not None:
            x = [_value(operand, values) for operand in statement.operands]
            taken = _SLOPES[statement.operation](x, values[statement.targets[0]])
            for operand, slope in zip(statement.operands, taken, strict=True):
                add(operand, above[0] * slope)
    for load in kernel.loads:
        if load.local in slopes:
            inputs = inputs + np.mean((slopes[load.local] * values[load.local]) ** 2, axis=0)
    return own, inputs


def _is_exact(statement: Statement) -> bool:
    """Whether nothing is rounded: signs, choices and multiples by powers of two."""
    powers = any(isinstance(x, Literal) and x.is_power_of_two for x in statement.operands)
    return statement.operation in EXACT or (statement.operation == "mul" and powers)


def _ratio(a: Lanes, b: Lanes) -> Lanes:
    return np.where(b == 0, 0.0, a / np.where(b == 0, 1.0, b))


def _chosen(first: Lanes) -> tuple[Lanes, Lanes]:
    return np.where(first, 1.0, 0.0), np.where(first, 0.0, 1.0)


def _sign(x: Lanes) -> Lanes:
    return np.copysign(1.0, x)


_VALUES: dict[OperationName, Callable[..., Lanes]] = {
    **VECTORISED,
    "ratio_or_zero": _ratio,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "exp": np.exp,
    "log": np.log,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "pow": np.power,
}

_SLOPES: dict[OperationName, Callable[[Sequence[Lanes], Lanes], tuple[Lanes, ...]]] = {
    "add": lambda _x, _y: (1.0, 1.0),
    "sub": lambda _x, _y: (1.0, -1.0),
    "mul": lambda x, _y: (x[1], x[0]),
    "div": lambda x, y: (np.divide(1.0, x[1]), np.divide(-y, x[1])),
    "ratio_or_zero": lambda x, y: (_ratio(1.0, x[1]), _ratio(-y, x[1])),
    "neg": lambda _x, _y: (-1.0,),
    "abs": lambda x, _y: (_sign(x[0]),),
    "sqrt": lambda _x, y: (_ratio(0.5, y),),
    "copysign": lambda x, _y: (_sign(x[0]) * _sign(x[1]), 0.0),
    "min": lambda x, _y: _chosen(x[0] < x[1]),
    "max": lambda x, _y: _chosen(x[0] > x[1]),
    "tan": lambda _x, y: (1 + y * y,),
    "asin": lambda x, _y: (1 / np.sqrt(1 - x[0] * x[0]),),
    "acos": lambda x, _y: (-1 / np.sqrt(1 - x[0] * x[0]),),
    "atan": lambda x, _y: (1 / (1 + x[0] * x[0]),),
    "atan2": lambda x, _y: (_ratio(x[1], x[0] * x[0] + x[1] * x[1]), _ratio(-x[0], x[0] * x[0] + x[1] * x[1])),
    "exp": lambda _x, y: (y,),
    "log": lambda x, _y: (np.divide(1.0, x[0]),),
    "sinh": lambda x, _y: (np.cosh(x[0]),),
    "cosh": lambda x, _y: (np.sinh(x[0]),),
    "tanh": lambda _x, y: (1 - y * y,),
    "pow": lambda x, y: (_ratio(x[1] * y, x[0]), 0.0),
}
