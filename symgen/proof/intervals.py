"""A kernel over a box, by interval arithmetic: how far each value can go, and which denominators may be 0.

What the loose bounds of intervals cannot exclude may still be impossible; a denominator they exclude is never 0.
Bounds are widened by a few units in the last place at each step, which covers the rounding of this evaluation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from symgen.ir.kernel import Function, Kernel, Literal, Local, Operand, Statement
from symgen.ir.pairs.wide_functions import WIDE, is_wide
from symgen.model.model import Range

Interval = tuple[float, float]
Pair = Callable[[Operand, Interval], tuple[Interval, ...]]
EVERYTHING: Interval = (-math.inf, math.inf)
# Of an end of an interval, by which it is moved outwards: far more than rounding to a double moves it.
_SLACK = 1e-14
# Of a value, more than what a pair holds beside it.
PAIR_REST = 2.0**-20


@dataclass(frozen=True, slots=True)
class Enclosure:
    """Bounds of every local of a kernel on the way of a regular state, and the divisors that may be 0."""

    bounds: dict[str, Interval]
    doubtful: tuple[str, ...]

    @property
    def largest(self) -> float:
        """The largest magnitude that a value may have, as far as bounds are numbers."""
        sizes = [max(-low, high) for low, high in self.bounds.values()]
        return max((size for size in sizes if not math.isnan(size)), default=0.0)


def exact_pair(_: Operand, angle: Interval) -> tuple[Interval, ...]:
    """Sine and cosine as they are, whatever computes them."""
    low, high = angle
    return _cosine((low - math.pi / 2, high - math.pi / 2)), _cosine(angle)


def computed_pair(function: Function, angle: Interval) -> tuple[Interval, ...]:
    """Sine and cosine as intervals go through the statements of the portable ones, every quadrant in one interval."""
    bounds = dict(zip(function.parameters, (angle,), strict=True))
    for statement in function.statements:
        _enter(bounds, statement, exact_pair)
    return tuple(bounds[name] for name in function.results)


def enclose(kernel: Kernel, ranges: Mapping[str, Sequence[Range]], pair: Pair = exact_pair) -> Enclosure:
    """Bounds for all arguments in their ranges; `pair` gives those of sine and cosine of an operand."""
    bounds: dict[str, Interval] = {}
    for load in kernel.loads:
        low, high = ranges[load.argument][load.index]
        bounds[load.local] = (float(low), float(high))
    doubtful = []
    for statement in kernel.statements:
        if statement.operation in ("div", "wide_div"):
            divisor = statement.operands[len(statement.operands) // 2]
            least, most = _bounds(divisor, bounds)
            if least <= 0 <= most:
                doubtful.append(divisor.name if isinstance(divisor, Local) else "0")
        _enter(bounds, statement, pair)
    return Enclosure(bounds, tuple(dict.fromkeys(doubtful)))


def _enter(bounds: dict[str, Interval], statement: Statement, pair: Pair) -> None:
    """Adds what a statement computes."""
    operands = [_bounds(operand, bounds) for operand in statement.operands]
    for target, value in zip(statement.targets, _values(statement, operands, pair), strict=True):
        bounds[target] = _widened(value)


def _bounds(operand: Operand, bounds: Mapping[str, Interval]) -> Interval:
    if isinstance(operand, Literal):
        return (float(operand.value), float(operand.value))
    return bounds[operand.name]


def _values(statement: Statement, operands: Sequence[Interval], pair: Pair) -> tuple[Interval, ...]:
    if statement.operation == "sincos":
        return pair(statement.operands[0], operands[0])
    if is_wide(statement):
        return _pair_values(statement, operands)
    if statement.operation == "mul" and statement.operands[0] == statement.operands[1]:
        low, high = _magnitude(operands[0])
        return ((low * low, high * high),)
    rule = _RULES.get(statement.operation)
    return (EVERYTHING if rule is None else rule(*operands),)


def _pair_values(statement: Statement, operands: Sequence[Interval]) -> tuple[Interval, ...]:
    """The value is that of the plain operation on values, but for rests, which are less than its last digit."""
    plain = next(plain for plain, wide in WIDE.items() if wide == statement.operation)
    rule = _RULES.get(plain)
    low, high = EVERYTHING if rule is None else rule(*operands[::2])
    rest = PAIR_REST * max(abs(low), abs(high))
    return (low - rest, high + rest), (-rest, rest)


def _product(a: Interval, b: Interval) -> Interval:
    corners = [0.0 if x == 0 or y == 0 else x * y for x in a for y in b]
    return min(corners), max(corners)


def _quotient(a: Interval, b: Interval) -> Interval:
    return EVERYTHING if b[0] <= 0 <= b[1] else _product(a, (1 / b[1], 1 / b[0]))


def _magnitude(a: Interval) -> Interval:
    sizes = sorted((abs(a[0]), abs(a[1])))
    return (0.0 if a[0] <= 0 <= a[1] else sizes[0]), sizes[1]


def _root(a: Interval) -> Interval:
    return math.sqrt(max(0.0, a[0])), math.sqrt(max(0.0, a[1]))


def _cosine(angle: Interval) -> Interval:
    low, high = angle
    if not high - low < 2 * math.pi:
        return (-1.0, 1.0)
    ends = (math.cos(low), math.cos(high))
    top = math.floor(high / (2 * math.pi)) * 2 * math.pi >= low
    bottom = math.floor((high - math.pi) / (2 * math.pi)) * 2 * math.pi + math.pi >= low
    return (-1.0 if bottom else min(ends)), (1.0 if top else max(ends))


def _widened(value: Interval) -> Interval:
    low, high = value
    if math.isnan(low) or math.isnan(high):
        return EVERYTHING
    return low - _SLACK * abs(low), high + _SLACK * abs(high)


_RULES: dict[str, Callable[..., Interval]] = {
    "add": lambda a, b: (a[0] + b[0], a[1] + b[1]),
    "sub": lambda a, b: (a[0] - b[1], a[1] - b[0]),
    "mul": _product,
    "div": _quotient,
    "neg": lambda a: (-a[1], -a[0]),
    "abs": _magnitude,
    "sqrt": _root,
    "min": lambda a, b: (min(a[0], b[0]), min(a[1], b[1])),
    "tanh": lambda a: (math.tanh(a[0]), math.tanh(a[1])),
    "max": lambda a, b: (max(a[0], b[0]), max(a[1], b[1])),
    "copysign": lambda a, b: (
        (_magnitude(a) if b[0] > 0 else (-_magnitude(a)[1], -_magnitude(a)[0])) if b[0] > 0 or b[1] < 0
        else (-_magnitude(a)[1], _magnitude(a)[1])
    ),
}
