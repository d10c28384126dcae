"""How far each parameter may be from the values it is verified at before a kernel loses digits.

One mass or length a thousand times as large as the others hides what they do, and no method that is taken for its
speed holds that for every parameter.  States of the verification are looked at with one parameter smaller or larger by
up to nine powers of ten; where rounding errors are beyond what is allowed, the kernel is bounded.  Estimates count more
than there is: within a power of ten, the reference has to find the loss too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, islice
from math import floor, log10

import numpy as np

from symgen.ir.bounded import Bound
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.model.quantities import MAIN
from symgen.runtime.activity import working
from symgen.verify.certificate import SearchRecord
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.margins.far_errors import JUDGED_UP_TO, UNITS_LOST, Far, FarErrors
from symgen.verify.margins.far_states import (
    FAR_STARTS,
    FURTHEST,
    MODE_STARTS,
    NEAR_STARTS,
    NUMBERS_HELD,
    QUARTER,
    SIDES,
    FarStates,
)
from symgen.verify.powers_of_ten import power_of_ten
from symgen.verify.reference.reference import ReferenceValueError, State
from symgen.verify.rounding_noise import noise_in_units
from symgen.verify.running.compile import Outcome
from symgen.verify.single_precision import units_in_float32
from symgen.verify.tolerance import FACTOR, is_beyond

# Powers of ten from a loss to the bound.
BEFORE_A_LOSS = 1.0
# Digits in which a bound is given.
BOUND_DIGITS = 2
# Powers of ten that are looked at together.
TOGETHER_AWAY = 3
# States up to which all powers are looked at together: so few take hardly longer than one.
FEW_STATES = 512
# States at which that is looked at, fewer for long kernels.
FAR_STATES = 8
# Half of them are the worst of so many at these powers of ten, of which two thirds are where either type loses most far
# away.  Where a parameter moves configurations that is not known before loops are closed again, and all starts that are
# led there are looked at: a platform lost 760 units at one of 32.
CHOSEN_AMONG, CHOSEN_AT = 24, (4, 9)
# States at which quarters of a power are looked at: the worst far away are not the worst close by.
CLOSER_STATES = 256
# Numbers that are worked out for one look at a kernel, and for one at each kernel of a model but those of u, q_ddot and
# lambda together: as many as three long ones take.
MOST, MOST_OF_OTHERS = 20_000_000, 60_000_000
# As many numbers as a statement of a kernel that works with pairs counts for.
IN_PAIRS = 16
# Up to a power the reference judges so many of the worst.
JUDGED_FAR = 2


@dataclass(frozen=True)
class _Tried:
    """A state, and what a kernel gives there."""

    state: State
    outcome: Outcome


class FarParameters:
    """The search for one verification."""

    def __init__(self, expected: Expected) -> None:
        self._reference, self._drawn = expected.reference, expected.drawn
        self._record = expected.record_search
        self.states = FarStates(expected)

    def bounds(
        self,
        kernels: Mapping[Scalar, Kernel],
        programs: Mapping[Scalar, Program],
        plain: Kernel | None = None,
        share: float = 1.0,
    ) -> dict[Scalar, tuple[Bound, ...]]:
        """The bounds for the kernels of one quantity: of parameters that they read, or that say where loops close.

        `plain` is the one in float64 without pairs of numbers where that works with them; `share` is what is afforded
        of the numbers of a look.  u, q_ddot and lambda are looked at in full.
        """
        read = self._read(kernels["float64"])
        if not read:
            return {}
        name = kernels["float64"].name
        with working(f"how far parameters of {name} may be"):
            return _Bounds(self, kernels, programs, plain, MOST if name in MAIN else int(share * MOST)).of(read)

    def record_search(self, quantity: str, states: int) -> None:
        """At so many states on each side of every parameter the kernels of a quantity were looked at."""
        self._record(SearchRecord(quantity, "bounds of parameters", states, FAR_STATES))

    def share(self, kernels: Iterable[Kernel]) -> float:
        """What each of the other kernels of a model in float64 is afforded of what its looks may take.

        A model of forty quantities would take forty times as long as one of one.
        """
        starts = FAR_STARTS + NEAR_STARTS + MODE_STARTS
        others = (one for one in kernels if one.name not in MAIN)
        wanted = (len(one.statements) * len(self._read(one)) * len(SIDES) * starts for one in others)
        total = sum(min(MOST, numbers) for numbers in wanted)
        return min(1.0, MOST_OF_OTHERS / total) if total else 1.0

    def _read(self, kernel: Kernel) -> list[int]:
        """The places of the parameters that it reads, or that say where loops close."""
        return sorted({load.index for load in kernel.loads if load.argument == "p"} | self.states.leading)

    def bound(self, parameter: int, low: float | None, high: float | None) -> Bound | None:
        """A parameter may be by these powers of ten below and above the values that it has in the verification.

        Where these reach 0 nothing is below them, and nothing is above 0 alone; None where no bound is left.
        """
        declared = self._reference.model.parameters[parameter]
        values = [float(sample.state.parameters[parameter]) for sample in self._drawn]
        values += map(float, declared.range or ())
        least = 0.0 if min(values) <= 0 <= max(values) else min(map(abs, values))
        most = max(map(abs, values))
        near = _in_digits(least * 10.0**low, up=True) if low is not None and least else None
        far = _in_digits(most * 10.0**high, up=False) if high is not None and most else None
        return None if near is None and far is None else Bound(declared.name, near, far)

    def tried(self, kernel: Kernel, program: Program, far: Far) -> list[_Tried]:
        """What a kernel gives at states in seven digits."""
        order = ("q", "qd", "qdd", "u", "p", "task")
        columns = [far.rounded[name].tolist() for name in order]
        states = [State(*map(tuple, parts)) for parts in zip(*columns, strict=True)]
        return list(map(_Tried, states, outcomes(kernel, program.sincos, program.scalar, states)))

    def is_lost(self, quantity: str, scalar: Scalar, tried: _Tried) -> bool:
        """Whether the reference finds that more is lost than is allowed."""
        if not tried.outcome.valid:
            return False
        try:
            return is_beyond(self._reference, tried.state, quantity, scalar, "far", tried.outcome.entries, FACTOR)
        except ReferenceValueError:
            return False

class _Bounds:
    """The search for one quantity."""

    def __init__(
        self,
        far: FarParameters,
        kernels: Mapping[Scalar, Kernel],
        programs: Mapping[Scalar, Program],
        plain: Kernel | None,
        most: int,
    ) -> None:
        self._most = most
        self._far, self._kernels, self._programs = far, kernels, programs
        self._errors = FarErrors(kernels, programs, plain)
        self._plain = plain or kernels["float64"]
        self._size = len(kernels["float64"].statements) + 1
        self._work = self._size if plain is None else IN_PAIRS * self._size

    def of(self, read: Sequence[int]) -> dict[Scalar, tuple[Bound, ...]]:
        """By scalar type, those of the parameters that are `read`, given by their places."""
        states = self._as_many(FAR_STATES, len(read) * FURTHEST)
        leading = len(self._far.states.leading.intersection(read))
        led = self._as_many(FAR_STARTS, max(1, leading) * FURTHEST)
        chosen = self._chosen(read, states)
        self._far.record_search(self._kernels["float64"].name, states)
        first: dict[Scalar, dict[tuple[int, int], float]] = {scalar: {} for scalar in self._kernels}
        few = len(read) * len(SIDES) * FURTHEST * max(states, led) <= FEW_STATES
        together = FURTHEST if few else TOGETHER_AWAY
        for nearest in range(1, FURTHEST + 1, together):
            # nothing is looked for beyond the first loss
            left = [(k, sign) for k in read for sign in SIDES if any((k, sign) not in one for one in first.values())]
            if not left:
                break
            powers = range(nearest, min(nearest + together, FURTHEST + 1))
            steps = [(k, sign * power) for k, sign in left for power in powers]
            lost = self._lost(self._far.states.led(steps, states, chosen, led))
            for scalar, far in lost.items():
                first[scalar] = _nearest(far) | first[scalar]
        closer = {
            (index, sign * (power - 1 + quarter))
            for by_side in first.values()
            for (index, sign), power in by_side.items()
            for quarter in np.arange(QUARTER, 1 + QUARTER, QUARTER).tolist()
        }
        if not closer:
            return dict.fromkeys(first, ())
        more = self._as_many(CLOSER_STATES, len(closer))
        lost = self._lost(self._far.states.led(sorted(closer), max(states, more), chosen))
        return {scalar: tuple(self._of(scalar, read, first[scalar], far)) for scalar, far in lost.items()}

    def _as_many(self, states: int, steps: int) -> int:
        """States on both sides of so many steps, fewer for long kernels."""
        return max(1, min(states, self._most // (self._work * steps * len(SIDES))))

    def _chosen(self, read: Sequence[int], states: int) -> dict[tuple[int, int], Lanes]:
        """On each side of a parameter the starts at which most is lost far away, half of the states that are looked at.

        What is lost differs from one state to another by more than a power of ten, and the worst of many is far worse
        than the worst of a few.
        """
        starts = self._as_many(CHOSEN_AMONG, len(read) * len(CHOSEN_AT))
        # of long kernels the first states have to do: to choose takes as long as to look
        if starts < CHOSEN_AMONG:
            return {}
        steps = [(k, sign * power) for k in read for sign in SIDES for power in CHOSEN_AT]
        far = self._far.states.led(steps, starts, self._lossy_furthest(read, 2 * starts // 3))
        by_scalar = self._units(far, ranked=True)
        # of each type in turn: in float32 next to all of them may be refused
        order = np.array([np.argsort(-units, kind="stable") for units in by_scalar.values()]).T.ravel()
        worst: dict[tuple[int, int], dict[int, None]] = {}
        for k, power, start in zip(*(x[order].tolist() for x in (far.parameters, far.powers, far.starts)), strict=True):
            worst.setdefault((k, 1 if power > 0 else -1), {})[start] = None
        return {side: np.array([*of_side][: (states + 1) // 2]) for side, of_side in worst.items()}

    def _lossy_furthest(self, read: Sequence[int], states: int) -> dict[tuple[int, int], Lanes]:
        """On each side of a parameter so many starts: most is lost there with that one furthest away, by either type.

        A pivot that float32 leaves no digit of is met at one state in a hundred, and no estimate of the first order
        sees it; where float32 has no digit anywhere, it says nothing of float64.  States at which as much is lost where
        parameters are say nothing of these.
        """
        starts = self._as_many(FAR_STARTS + NEAR_STARTS + MODE_STARTS, len(read))
        sides = [(k, sign) for k in read for sign in SIDES]
        held = max(1, NUMBERS_HELD // (self._size * starts))
        worst: dict[tuple[int, int], Lanes] = {}
        lossy = np.maximum(*self._losses(self._far.states.shifted([(read[0], 1.0)], starts))) > UNITS_LOST / 2
        for at in range(0, len(sides), held):
            part = sides[at : at + held]
            given = self._far.states.shifted([(k, power_of_ten(sign * FURTHEST)) for k, sign in part], starts)
            by_type = [units.reshape(len(part), -1) for units in self._losses(given)]
            for units in by_type:
                units[:, lossy] = 0.0
            orders = np.stack([np.argsort(-units, axis=1, kind="stable") for units in by_type], axis=2)
            in_turn = orders.reshape(len(part), -1).tolist()
            worst |= {side: np.array([*dict.fromkeys(one)][:states]) for side, one in zip(part, in_turn, strict=True)}
        return worst

    def _losses(self, given: Mapping[str, Lanes]) -> tuple[Lanes, Lanes]:
        """What plain float32 is off, and the noise of float64: for a choice, along one line."""
        noise = noise_in_units(self._kernels["float64"], self._programs["float64"].sincos, given, lines=1)
        return units_in_float32(self._plain, self._programs, given), noise

    def _of(
        self, scalar: Scalar, read: Sequence[int], first: Mapping[tuple[int, int], float], lost: Far
    ) -> Iterator[Bound]:
        steps = self._steps(scalar, lost)
        for index in read:
            low, high = (
                self._power(scalar, index, sign, steps, first[index, sign]) if (index, sign) in first else None
                for sign in SIDES
            )
            if (bound := self._far.bound(index, low, high)) is not None:
                yield bound

    def _steps(self, scalar: Scalar, lost: Far) -> dict[tuple[int, float], list[_Tried]]:
        """Of each parameter and power of ten there is the worst states, tried together where the reference judges."""
        worst: dict[tuple[int, float], list[int]] = {}
        for place, step in enumerate(zip(lost.parameters.tolist(), lost.powers.tolist(), strict=True)):
            at = worst.setdefault(step, [])
            if abs(step[1]) <= JUDGED_UP_TO and len(at) < JUDGED_FAR:
                at.append(place)
        judged = lost.only(np.array([place for at in worst.values() for place in at], dtype=int))
        kernel, program = self._kernels[scalar], self._programs[scalar]
        tried = chain.from_iterable(self._far.tried(kernel, program, part) for part in self._parts(judged))
        return {step: list(islice(tried, len(at))) for step, at in worst.items()}

    def _power(
        self, scalar: Scalar, index: int, sign: int, steps: Mapping[tuple[int, float], Sequence[_Tried]], last: float
    ) -> float:
        """The power of ten up to which nothing is lost on one side, where something is at the `last`."""
        quantity = self._kernels[scalar].name
        # where the reference finds nothing lost, estimates do not count
        limit = last if last > JUDGED_UP_TO else last + QUARTER
        # of both types there are steps, up to where either loses something
        within = (sign * power for which, power in steps if which == index and 0 < sign * power <= last)
        powers = sorted(within, reverse=True)
        # from outside: where nothing is lost nothing is further in
        for power in powers:
            worst = steps[index, sign * power]
            if power <= JUDGED_UP_TO and not any(self._far.is_lost(quantity, scalar, tried) for tried in worst):
                break
            limit = power
        return sign * _inside(limit)

    def _lost(self, far: Far) -> dict[Scalar, Far]:
        """By scalar type, what of it seems to lose more than is allowed, the worst first."""
        by_scalar = {}
        for scalar, units in self._units(far, ranked=False).items():
            order = np.argsort(-units, kind="stable")
            by_scalar[scalar] = far.only(order[units[order] > UNITS_LOST])
        return by_scalar

    def _units(self, far: Far, ranked: bool) -> dict[Scalar, Lanes]:
        parts = [self._errors.units(part, ranked) for part in self._parts(far)]
        return {scalar: np.concatenate([np.zeros(0), *(part[scalar] for part in parts)]) for scalar in self._kernels}

    def _parts(self, far: Far) -> Iterator[Far]:
        """As many states at a time as may be held."""
        held = max(1, NUMBERS_HELD // self._size)
        return (far.only(slice(start, start + held)) for start in range(0, len(far), held))


def _nearest(far: Far) -> dict[tuple[int, int], float]:
    """By parameter and side, the nearest power of ten there is."""
    by_side: dict[tuple[int, int], float] = {}
    for index, power in zip(far.parameters.tolist(), far.powers.tolist(), strict=True):
        side = index, 1 if power > 0 else -1
        by_side[side] = min(abs(power), by_side.get(side, FURTHEST))
    return by_side


def _inside(lost: float) -> float:
    """The power of ten up to which a parameter may be where something is lost at that one.

    Other states lose ten times as much and more; where the reference judges, the next step inside is enough.
    """
    if lost <= JUDGED_UP_TO:
        return max(lost - QUARTER, QUARTER)
    return max(lost - BEFORE_A_LOSS, JUDGED_UP_TO)


def _in_digits(value: float, up: bool) -> Fraction:
    """A positive number in BOUND_DIGITS digits, rounded up or down."""
    size = Fraction(10) ** (floor(log10(value)) - BOUND_DIGITS + 1)
    parts = Fraction(value) / size
    return size * (-floor(-parts) if up else floor(parts))
