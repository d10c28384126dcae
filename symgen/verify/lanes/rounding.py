"""What rounding does to the result of a kernel, estimated at many states at once: where to look for its worst.

The reverse mode of automatic differentiation with a lane for each state, in float64.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import numpy as np

from symgen.ir.kernel import Kernel, Literal, Operand, OperationName, Statement, Status
from symgen.verify.given import loaded
from symgen.verify.lanes.lane_arithmetic import VECTORISED, Lanes
from symgen.verify.lanes.portable_lanes import applied, sines

# Combinations of outputs with random signs, which stand for all of them.
COMBINATIONS = 3
# An operation, places of what it works on and of what it makes, and whether nothing is rounded.
_Step: TypeAlias = tuple[OperationName, tuple[int, ...], tuple[int, ...], bool]
# The largest of 8 random changes of what is given, in root mean squares.
LARGEST_OF_EIGHT = 1.5
# Their results need no rounding.
EXACT = frozenset({"neg", "abs", "copysign", "min", "max"})


class RoundingErrors:
    """The rounding errors of a kernel in units of d + eps |y|, as if all were independent.

    Operands are found by place: long kernels are looked at at a few hundred states at a time, several times, where
    finding what a statement works on would take as long as working it out.
    """

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        generator = random.Random(kernel.name)
        signs = [[generator.choice((-1.0, 1.0)) for _ in kernel.outputs] for _ in range(COMBINATIONS)]
        self._signs = np.array(signs)
        self._numbers: list[float] = []
        self._locals: dict[str, int] = {}
        for load in kernel.loads:
            self._put(load.local)
        blocks = []
        for block in kernel.blocks:
            steps = [self._step(statement) for statement in block.statements]
            blocks.append((steps, [(c.inclusive, self._place(c.value), self._place(c.limit)) for c in block.checks]))
        self._blocks = blocks
        self._outputs = [self._place(output) for output in kernel.outputs]

    def with_units(self, given: Mapping[str, Lanes], tangents: Lanes | None = None) -> tuple[Lanes, Lanes]:
        """The errors and their units, both for a roundoff of 1; 0 and infinite where the kernel refuses.

        `given` holds the arguments and the parameters `p`, a row for each state.  d is that of the kernel itself for
        arguments and parameters; what literals of the model add is left out, so that this is more than there is rather
        than less.  With `tangents` it is the last of the three units `with_both` gives.
        """
        own, whole, along = self.with_both(given, tangents)
        return own, whole if tangents is None else along

    def with_both(self, given: Mapping[str, Lanes], tangents: Lanes | None) -> tuple[Lanes, Lanes, Lanes]:
        """The errors, their units, and the units of `tangents` (n x n, onto those of V) where those are less.

        d is then what arguments do that move along V alone, parameters staying as they are: beside V, where rows depend
        on each other, a kernel may be another function than what it stands for.  Along V coordinates move together, and
        one that all but vanishes by more than a share of itself.
        """
        count = len(next(iter(given.values())))
        with np.errstate(all="ignore"):
            return self._with_both(*self._values(given, count), count, tangents)

    def with_masses(self, given: Mapping[str, Lanes]) -> tuple[Lanes, Lanes, Lanes]:
        """The errors, their units, and where a pivot of masses is below 0, by more than rounding leaves of one."""
        count = len(next(iter(given.values())))
        with np.errstate(all="ignore"):
            values, regular = self._values(given, count)
            negative = self._indefinite(values, count)
            own, whole, _ = self._with_both(values, regular, count, None)
        return own, whole, negative

    def _with_both(
        self, values: Sequence[Lanes], regular: Lanes, count: int, tangents: Lanes | None
    ) -> tuple[Lanes, Lanes, Lanes]:
        outputs = [values[place] for place in self._outputs]
        own, slopes = self._shares(values, count)
        inputs = self._of_inputs(values, slopes, count)
        size = np.sqrt(sum(x * x for x in outputs))
        whole = size + LARGEST_OF_EIGHT * np.sqrt(inputs)
        along = whole
        if tangents is not None:
            inputs = np.fmin(inputs, self._along(values, slopes, tangents))
            along = size + LARGEST_OF_EIGHT * np.sqrt(inputs)
        regular = regular & np.isfinite(along) & (along > 0) & np.isfinite(own)
        own = np.sqrt(np.where(regular, own, 0.0))
        return own, np.where(regular, whole, np.inf), np.where(regular, along, np.inf)

    def _indefinite(self, values: Sequence[Lanes], count: int) -> Lanes:
        negative = np.zeros(count, dtype=bool)
        for block, (_, checks) in zip(self._kernel.blocks, self._blocks, strict=True):
            for check, (_, value, limit) in zip(block.checks, checks, strict=True):
                if check.status is Status.MASS_RANK:
                    negative |= values[value] < -np.abs(values[limit])
        return negative

    def _put(self, name: str) -> int:
        """The place of what is worked out next; numbers stand before all of it, at negative places."""
        place = self._locals[name] = len(self._locals)
        return place

    def _place(self, operand: Operand) -> int:
        if not isinstance(operand, Literal):
            return self._locals[operand.name]
        self._numbers.append(float(operand.value))
        return -len(self._numbers)

    def _step(self, statement: Statement) -> _Step:
        operands = tuple(self._place(operand) for operand in statement.operands)
        return statement.operation, operands, tuple(map(self._put, statement.targets)), _is_exact(statement)

    def _values(self, given: Mapping[str, Lanes], count: int) -> tuple[list[Lanes], Lanes]:
        """What every local is on the way of a regular state, numbers last, and where no check fails."""
        values: list[Lanes] = [None] * len(self._locals) + self._numbers[::-1]
        for place, load in enumerate(self._kernel.loads):
            values[place] = loaded(given, load)
        regular = np.ones(count, dtype=bool)
        for steps, checks in self._blocks:
            for operation, operands, targets, _ in steps:
                if operation == "sincos":
                    values[targets[0]], values[targets[1]] = sines(values[operands[0]])
                elif (function := _VALUES.get(operation)) is not None:
                    values[targets[0]] = function(*[values[place] for place in operands])
                else:
                    values[targets[0]] = applied(operation, [values[place] for place in operands])
            for inclusive, value, limit in checks:
                met = values[value] >= values[limit] if inclusive else values[value] > values[limit]
                regular &= met
        return values, regular

    def _shares(self, values: Sequence[Lanes], count: int) -> tuple[Lanes, Sequence[Lanes]]:
        """The mean square over combinations of outputs of what one roundoff of each target, all of them together, does
        to them; and the slopes of these combinations by all that is given."""
        slopes: list[Lanes] = [None] * len(self._locals)
        own = _Squares(count)

        def add(place: int, slope: Lanes) -> None:
            if place >= 0:
                known = slopes[place]
                slopes[place] = slope if known is None else known + slope

        for column, place in enumerate(self._outputs):
            add(place, np.broadcast_to(self._signs[:, column : column + 1], (COMBINATIONS, count)))
        for steps, _ in reversed(self._blocks):
            for operation, operands, targets, exact in reversed(steps):
                above = [slopes[target] for target in targets]
                for target, slope in zip(targets, above, strict=True):
                    if slope is not None:
                        slopes[target] = None
                        if not exact:
                            own.add(slope, values[target])
                if operation == "sincos":
                    sine, cosine = (values[target] for target in targets)
                    for slope, factor in zip(above, (cosine, -sine), strict=True):
                        if slope is not None:
                            add(operands[0], slope * factor)
                    continue
                slope = above[0]
                if slope is None:
                    continue
                if operation == "mul":
                    left, right = operands
                    if left >= 0:
                        add(left, slope * values[right])
                    if right >= 0:
                        add(right, slope * values[left])
                elif operation == "add":
                    add(operands[0], slope)
                    add(operands[1], slope)
                elif operation == "sub":
                    add(operands[0], slope)
                    if operands[1] >= 0:
                        add(operands[1], -slope)
                else:
                    taken = _SLOPES[operation]([values[place] for place in operands], values[targets[0]])
                    for place, factor in zip(operands, taken, strict=True):
                        if place >= 0:
                            add(place, slope * factor)
        return own.mean(), slopes[: len(self._kernel.loads)]

    def _of_inputs(self, values: Sequence[Lanes], slopes: Sequence[Lanes], count: int) -> Lanes:
        """The mean square of what one roundoff of each of all that is given does."""
        inputs = _Squares(count)
        for place, slope in enumerate(slopes):
            if slope is not None:
                inputs.add(slope, values[place])
        return inputs.mean()

    def _along(self, values: Sequence[Lanes], slopes: Sequence[Lanes], tangents: Lanes) -> Lanes:
        """The same along V."""
        count, n, _ = tangents.shape
        inputs, by_place, moved = _Squares(count), np.zeros((COMBINATIONS, count, n)), np.zeros((count, n))
        for place, (load, slope) in enumerate(zip(self._kernel.loads, slopes, strict=True)):
            if slope is not None and load.argument == "q":
                by_place[:, :, load.index], moved[:, load.index] = slope, values[place]
            elif slope is not None and load.argument != "p":
                inputs.add(slope, values[place])
        for slope, value in zip(np.moveaxis(np.einsum("ckj,kji->cki", by_place, tangents), 2, 0), moved.T, strict=True):
            inputs.add(slope, value)
        return inputs.mean()


class _Squares:
    """Sums of squares of products, many at a time."""

    AT_ONCE = 64

    def __init__(self, count: int) -> None:
        self._products = np.empty((self.AT_ONCE, COMBINATIONS, count))
        self._held = 0
        self._sum = np.zeros(count)

    def add(self, slope: Lanes, value: Lanes) -> None:
        """Adds (slope value)^2."""
        np.multiply(slope, value, out=self._products[self._held])
        self._held += 1
        if self._held == self.AT_ONCE:
            self._settle()

    def mean(self) -> Lanes:
        """The sum of all, in the mean over combinations."""
        self._settle()
        return self._sum / COMBINATIONS

    def _settle(self) -> None:
        held = self._products[: self._held]
        self._sum += np.einsum("ijk,ijk->k", held, held)
        self._held = 0


def _is_exact(statement: Statement) -> bool:
    """Whether nothing is rounded: signs, choices and multiples by powers of two."""
    if statement.operation != "mul":
        return statement.operation in EXACT
    return any(isinstance(x, Literal) and x.is_power_of_two for x in statement.operands)


def _ratio(a: Lanes, b: Lanes) -> Lanes:
    return np.where(b == 0, 0.0, a / np.where(b == 0, 1.0, b))


def _chosen(first: Lanes) -> tuple[Lanes, Lanes]:
    return np.where(first, 1.0, 0.0), np.where(first, 0.0, 1.0)


def _sign(x: Lanes) -> Lanes:
    return np.copysign(1.0, x)


_VALUES: dict[OperationName, Callable[..., Lanes]] = {**VECTORISED, "ratio_or_zero": _ratio}

_SLOPES: dict[OperationName, Callable[[Sequence[Lanes], Lanes], tuple[Lanes, ...]]] = {
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
    "sinh": lambda x, _y: (applied("cosh", x),),
    "cosh": lambda x, _y: (applied("sinh", x),),
    "tanh": lambda _x, y: (1 - y * y,),
    "pow": lambda x, y: (_ratio(x[1] * y, x[0]), 0.0),
}
