"""A recorded straight-line computation, replayed in ball arithmetic for every state.

The reference propagates truncated Taylor polynomials through the user's expressions once, recording each scalar
operation; a replay then costs one arithmetic operation per record.  Only structural zeros and ones (those of the
Taylor arithmetic itself) are folded: literals of the model stay inputs, so that they can be perturbed.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from operator import itemgetter
from typing import Any, TypeAlias

from flint import arb, ctx, fmpq

Register: TypeAlias = int
Key: TypeAlias = tuple[str, Any, Any]


def _power(base: Any, exponent: Any) -> Any:
    return base**exponent


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "pow": _power,
    "sin": arb.sin,
    "cos": arb.cos,
    "tan": arb.tan,
    "asin": arb.asin,
    "acos": arb.acos,
    "atan": arb.atan,
    "atan2": arb.atan2,
    "sqrt": arb.sqrt,
    "exp": arb.exp,
    "log": arb.log,
    "sinh": arb.sinh,
    "cosh": arb.cosh,
    "tanh": arb.tanh,
}


def ball(value: Any) -> Any:
    """An exact number (int, float, Fraction) as a ball at the working precision; balls pass through."""
    if type(value) is arb:
        return value
    if isinstance(value, Fraction):
        return arb(fmpq(value.numerator, value.denominator))
    return arb(value)


@contextmanager
def precision(bits: int) -> Iterator[None]:
    """Set the working precision for a while."""
    previous = ctx.prec
    ctx.prec = bits
    try:
        yield
    finally:
        ctx.prec = previous


class Constants:
    """Exact numbers as balls, converted once for each working precision."""

    def __init__(self, values: Iterable[Fraction]) -> None:
        self._values = tuple(values)
        self._balls: dict[int, list[Any]] = {}

    def balls(self) -> list[Any]:
        """The numbers at the working precision."""
        if ctx.prec not in self._balls:
            self._balls[ctx.prec] = [ball(value) for value in self._values]
        return self._balls[ctx.prec]

    def floats(self) -> list[float]:
        """The numbers rounded."""
        return list(map(float, self._values))


class Tape:
    """Records operations on registers; equal operations share one register."""

    def __init__(self) -> None:
        self.records: list[Key] = []
        self._known: dict[Key, Register] = {}
        self.zero = self.constant(Fraction(0))
        self.one = self.constant(Fraction(1))

    def _record(self, operation: str, left: Any, right: Any) -> Register:
        key = (operation, left, right)
        register = self._known.get(key)
        if register is None:
            register = self._known[key] = len(self.records)
            self.records.append(key)
        return register

    def constant(self, value: Fraction) -> Register:
        """A structural constant, never perturbed."""
        return self._record("constant", value, None)

    def input(self, position: int) -> Register:
        """The number at `position` of the inputs of a replay."""
        return self._record("input", position, None)

    def unary(self, operation: str, operand: Register) -> Register:
        """A function of one register."""
        return self._record(operation, operand, None)

    def binary(self, operation: str, left: Register, right: Register) -> Register:
        """An operation on two registers; structural zeros and ones are folded."""
        if operation == "mul":
            if self.zero in (left, right):
                return self.zero
            if left == self.one:
                return right
            if right == self.one:
                return left
            left, right = min(left, right), max(left, right)
        elif operation == "add":
            if left == self.zero:
                return right
            if right == self.zero:
                return left
        elif operation == "sub" and right == self.zero:
            return left
        return self._record(operation, left, right)

    def scaled(self, factor: Fraction, operand: Register) -> Register:
        """A structural rational multiple of a register."""
        if factor == -1:
            return self.unary("neg", operand)
        return self.binary("mul", self.constant(factor), operand)


@dataclass(frozen=True)
class RegisterPlaces:
    """A replay by places, for other numbers than balls: constants come first, then inputs, then groups."""

    inputs: tuple[int, ...]
    groups: tuple[tuple[str, tuple[int, ...], tuple[int, ...] | None], ...]
    outputs: tuple[int, ...]


@dataclass(frozen=True)
class Replay:
    """The part of a tape that some outputs need.

    Operations are grouped by depth and kind, so that a replay runs inside `map`.
    """

    constants: Constants
    inputs: Callable[[Sequence[Any]], tuple[Any, ...]]
    groups: tuple[tuple[str, Callable[[Sequence[Any]], Any], Callable[[Sequence[Any]], Any] | None], ...]
    outputs: Callable[[Sequence[Any]], tuple[Any, ...]]
    operations: int
    places: RegisterPlaces

    def run(self, inputs: Sequence[Any]) -> tuple[Any, ...]:
        """The outputs, in balls of the working precision; `inputs` are balls."""
        registers: list[Any] = list(self.constants.balls())
        registers.extend(self.inputs(inputs))
        for operation, left, right in self.groups:
            function = FUNCTIONS[operation]
            if right is None:
                registers.extend(map(function, left(registers)))
            else:
                registers.extend(map(function, left(registers), right(registers)))
        return self.outputs(registers)


def picker(positions: Sequence[int]) -> Callable[[Sequence[Any]], tuple[Any, ...]]:
    """Like `itemgetter`, but a tuple for one and for no position too."""
    if not positions:
        return lambda _: ()
    if len(positions) == 1:
        only = positions[0]
        return lambda sequence: (sequence[only],)
    return itemgetter(*positions)


def replay_of(tape: Tape, outputs: Iterable[Register]) -> Replay:
    """Compile what `outputs` need."""
    wanted = list(outputs)
    depth = _depths(tape, wanted)
    constants = [r for r in depth if tape.records[r][0] == "constant"]
    inputs = [r for r in depth if tape.records[r][0] == "input"]
    place = {register: position for position, register in enumerate([*constants, *inputs])}
    kinds: dict[tuple[int, str], list[Register]] = {}
    for register in depth:
        operation = tape.records[register][0]
        if operation not in ("constant", "input"):
            kinds.setdefault((depth[register], operation), []).append(register)
    groups: list[tuple[str, tuple[int, ...], tuple[int, ...] | None]] = []
    for (_, operation), members in sorted(kinds.items()):
        lefts = tuple(place[tape.records[r][1]] for r in members)
        two = tape.records[members[0]][2] is not None
        groups.append((operation, lefts, tuple(place[tape.records[r][2]] for r in members) if two else None))
        for register in members:
            place[register] = len(place)
    places = RegisterPlaces(tuple(tape.records[r][1] for r in inputs), tuple(groups), tuple(place[r] for r in wanted))
    return Replay(
        Constants(tape.records[r][1] for r in constants),
        picker(places.inputs),
        tuple((kind, picker(lefts), None if rights is None else picker(rights)) for kind, lefts, rights in groups),
        picker(places.outputs),
        sum(map(len, kinds.values())),
        places,
    )


def needed_for(tape: Tape, wanted: Iterable[Register]) -> set[Register]:
    """All registers that `wanted` need, and these."""
    needed: set[Register] = set()
    pending = list(wanted)
    while pending:
        register = pending.pop()
        if register not in needed:
            needed.add(register)
            pending.extend(operands(tape.records[register]))
    return needed


def _depths(tape: Tape, wanted: Sequence[Register]) -> dict[Register, int]:
    """Depth of every register that `wanted` need, in recording order (operands come before their use)."""
    depth: dict[Register, int] = {}
    for register in sorted(needed_for(tape, wanted)):
        depth[register] = max((depth[o] + 1 for o in operands(tape.records[register])), default=0)
    return depth


def operands(record: Key) -> tuple[Register, ...]:
    """The registers that an operation works on."""
    operation, left, right = record
    if operation in ("constant", "input"):
        return ()
    return (left,) if right is None else (left, right)
