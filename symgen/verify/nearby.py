"""Hundreds of states beside those of a verification, in float64: where to look for the worst, not what is right there.

A state is what a sample of the verification becomes by a step along V; its parameters are that sample's.  Rates and
accelerations satisfy the constraints in every other one, as there.  The dice do not depend on what was looked at
before.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np

from symgen.verify.lanes import Lanes
from symgen.verify.reference import Reference, State
from symgen.verify.reference_manifold import Ranks
from symgen.verify.reference_system import System
from symgen.verify.reference_tape import Replay
from symgen.verify.regular import REGULAR
from symgen.verify.states import Sample

# Shares of the ranges of coordinates: how far states are drawn from samples, and moved from where they are.
REACH = 0.2
FURTHER = 0.05
NEWTON_STEPS = 12
CLOSED = 1e-11
# Of the largest singular value: rows depend on each other.
DEPENDENT = 1e-8
QUARTER = np.pi / 2
# Powers of ten: how far an angle is from a multiple of a quarter turn.
OFF = (1.0, 5.0)
# A step of differences along the rates, in radians and metres a unit of time.
DIFFERENCE = 1e-5

_FUNCTIONS: dict[str, Callable[..., Lanes]] = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "neg": np.negative, "pow": np.power,
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "sinh": np.sinh, "cosh": np.cosh,
    "tanh": np.tanh,
}  # fmt: skip


@dataclass(frozen=True)
class Nearby:
    """States with a row each: arguments and parameters by name, whether rates satisfy the constraints, and the places
    of the samples that they come from."""

    parts: Mapping[str, Lanes]
    admissible: Lanes
    origins: Lanes

    def __len__(self) -> int:
        return len(self.origins)

    def only(self, which: Lanes) -> Nearby:
        """Those that a mask or places name."""
        parts = {name: values[which] for name, values in self.parts.items()}
        return Nearby(parts, self.admissible[which], self.origins[which])

    def state(self, place: int) -> State:
        """One of them, in seven digits: what is found does not depend on the last bits of NumPy's functions."""
        single = {name: values[place].astype(np.float32) for name, values in self.parts.items()}
        q, qd, qdd, u = (tuple(map(float, single[name])) for name in ("q", "qd", "qdd", "u"))
        return State(q, qd, qdd, u, tuple(map(float, self.parts["p"][place])))


def joined(first: Nearby, second: Nearby) -> Nearby:
    """All states of both."""
    parts = {name: np.concatenate((values, second.parts[name])) for name, values in first.parts.items()}
    admissible = np.concatenate((first.admissible, second.admissible))
    return Nearby(parts, admissible, np.concatenate((first.origins, second.origins)))


class Surroundings:
    """What lies near the samples of a verification."""

    def __init__(self, reference: Reference, samples: Sequence[Sample]) -> None:
        self._system, self._parts = reference.system, _ranked(reference.system, reference.ranks)
        self._literals = [float(x) for x in reference.literals()]
        states = [sample.state for sample in samples]
        parts = {name: _rows([getattr(state, name) for state in states]) for name in ("q", "qd", "qdd", "u")}
        parts["p"] = _rows([state.parameters for state in states])
        admissible = np.array([sample.admissible for sample in samples])
        self.samples = Nearby(parts, admissible, np.arange(len(samples)))
        coordinates = self._coordinates = reference.model.coordinates
        low, high = (np.array([float(c.range[side]) for c in coordinates]) for side in (0, 1))
        self._widths = high - low
        # ranges that nobody told may be left by every configuration there is
        self._low = np.minimum(low, parts["q"].min(axis=0, initial=np.inf))
        self._high = np.maximum(high, parts["q"].max(axis=0, initial=-np.inf))
        self._rates = np.array([float(c.rate_range[1]) for c in coordinates])
        self._accelerations = np.array([float(c.acceleration_range[1]) for c in coordinates])
        self._inputs = np.abs(parts["u"]).max(axis=1, initial=1.0)[:, None]

    def drawn(self, count: int) -> Nearby:
        """About so many: a step off each sample in turn, with other rates, accelerations and inputs."""
        start = self.samples.only(np.arange(count) % len(self.samples))
        return self._stepped(start, REACH, 1.0, random.Random("nearby"), afresh=True)

    def aligned(self, count: int) -> Nearby:
        """About so many with an angle near a multiple of a quarter turn, where a sine or cosine vanishes.

        What divides by one of them loses digits there, and states at random do not come near.
        """
        start = self.samples.only(np.arange(count) % len(self.samples))
        angles = [place for place, c in enumerate(self._coordinates) if c.unit == "rad"]
        if not angles:
            return start.only(slice(0))
        dice = random.Random("aligned")
        places = np.array([dice.choice(angles) for _ in range(count)])
        before = start.parts["q"][np.arange(count), places]
        off = np.array([dice.choice((-1, 1)) * 10.0 ** -dice.uniform(*OFF) for _ in range(count)])
        held = (places, np.round(before / QUARTER) * QUARTER + off)
        with np.errstate(all="ignore"):
            q, _ = self._onto_manifold(start.parts["q"], start.parts["p"], held)
            parts = {**start.parts, "q": q}
            return self._settled(Nearby(parts, start.admissible, start.origins), start.parts["q"])

    def moved(self, states: Nearby, seed: str) -> Nearby:
        """States a step further, of which some are left out: those that are not regular or out of range."""
        return self._stepped(states, FURTHER, 2 * FURTHER, random.Random(f"nearby {seed}"), afresh=False)

    def _stepped(self, start: Nearby, reach: float, share: float, dice: random.Random, afresh: bool) -> Nearby:
        count, kept = len(start), 0.0 if afresh else 1.0
        parts = dict(start.parts)
        q = parts["q"] + reach * _shifts(dice, parts["q"]) * self._widths
        parts["q"] = np.clip(q, self._low, self._high)
        widths = {"qd": self._rates, "qdd": self._accelerations, "u": self._inputs[start.origins]}
        for name, width in widths.items():
            parts[name] = kept * parts[name] + share * _shifts(dice, parts[name]) * width
        admissible = np.arange(count) // len(self.samples) % 2 == 0 if afresh else start.admissible
        with np.errstate(all="ignore"):
            return self._settled(Nearby(parts, admissible, start.origins), start.parts["q"])

    def _settled(self, states: Nearby, start: Lanes) -> Nearby:
        """Brought onto V, rates and accelerations too where they are to be.

        Of machines side by side those that a step leads nowhere stay where they were.
        """
        parts, p = dict(states.parts), states.parts["p"]
        q, shut = self._onto_manifold(parts["q"], p)
        slack = 0.01 * self._widths
        inside = (q >= self._low - slack) & (q <= self._high + slack)
        good = np.ones(len(q), dtype=bool)
        for part, blocks in zip(self._parts, self._matrices(q, p), strict=True):
            these = list(part.coordinates)
            led = inside[:, these].all(axis=1) & shut[:, these].all(axis=1) & self._is_regular(part, *blocks)
            if len(self._parts) == 1:
                good = led
            else:
                q[:, these] = np.where(led[:, None], q[:, these], start[:, these])
        parts["q"] = q
        if self._system.r:
            on = states.admissible[:, None]
            rows = [made for made, _ in self._matrices(q, p)]
            for made in rows:
                good &= np.isfinite(made).all(axis=(1, 2))
            lengths = [_lengths(made) for made in rows]
            units = [_finite(made / length) for made, length in zip(rows, lengths, strict=True)]
            inverses = [np.linalg.pinv(unit, rcond=DEPENDENT) for unit in units]
            qd, qdd = parts["qd"].copy(), parts["qdd"].copy()
            for part, unit, inverse in zip(self._parts, units, inverses, strict=True):
                these = list(part.coordinates)
                qd[:, these] -= _times(inverse, _times(unit, qd[:, these]))
            sides = (self._matrices(q + side * DIFFERENCE * qd, p) for side in (1, -1))
            for part, length, unit, inverse, (ahead, _), (behind, _) in zip(
                self._parts, lengths, units, inverses, *sides, strict=True
            ):
                these = list(part.coordinates)
                drift = np.nan_to_num(_times((ahead - behind) / (2 * DIFFERENCE) / length, qd[:, these]))
                qdd[:, these] -= _times(inverse, _times(unit, qdd[:, these]) + drift)
            parts["qd"], parts["qdd"] = np.where(on, qd, parts["qd"]), np.where(on, qdd, parts["qdd"])
        return Nearby(parts, states.admissible, states.origins).only(good)

    def _onto_manifold(self, q: Lanes, p: Lanes, held: tuple[Lanes, Lanes] | None = None) -> tuple[Lanes, Lanes]:
        """The places where Newton's method ends, and whether the loops of each coordinate are closed there.

        `held` are the place of a coordinate and its value, for each state: another row.
        """
        r, n = self._system.r_geometric, self._system.n
        q = q.copy()
        shut = np.ones(q.shape, dtype=bool)
        if held is not None:
            q[np.arange(len(q)), held[0]] = held[1]
        for _ in range(NEWTON_STEPS if r else 0):
            made = self._run(self._system.geometry_replay, q, p)
            steps = []
            for loop in self._system.loops:
                these = list(loop.coordinates)
                rows = _block(made, [[r + i * n + j for j in these] for i in loop.rows])
                gaps = _block(made, [[i] for i in loop.rows])[:, :, 0]
                finite = np.isfinite(rows).all(axis=(1, 2)) & np.isfinite(gaps).all(axis=1)
                rows[~finite], gaps[~finite] = 0.0, 0.0
                if held is not None:
                    rows = np.concatenate((rows, (held[0][:, None] == np.array(these))[:, None] * 1.0), axis=1)
                    gaps = np.concatenate((gaps, np.zeros((len(q), 1))), axis=1)
                lengths = _lengths(rows)
                gaps = gaps / lengths[:, :, 0]
                near = np.abs(gaps).max(axis=1) <= CLOSED
                shut[:, these] = (finite & near)[:, None]
                if not near.all():
                    steps.append((these, _times(np.linalg.pinv(rows / lengths, rcond=DEPENDENT), gaps)))
            if not steps:
                break
            for these, step in steps:
                q[:, these] -= step
        return q, shut

    def _is_regular(self, part: _Ranked, rows: Lanes, control: Lanes) -> Lanes:
        """Whether rows, and inputs along what the rows leave free, are as far from dependent as regular states are."""
        good: Lanes = np.isfinite(rows).all(axis=(1, 2)) & np.isfinite(control).all(axis=(1, 2))
        rows, control = rows.copy(), control.copy()
        rows[~good], control[~good] = 0.0, 0.0
        count, r, n = rows.shape
        free = np.broadcast_to(np.eye(n), (count, n, n))
        if r:
            sizes, directions = np.linalg.svd(rows / _lengths(rows))[1:]
            rank = part.constraints
            good &= sizes[:, rank - 1] >= REGULAR * sizes[:, 0] if rank else True
            free = directions[:, rank:]
        if part.actuation:
            columns = np.swapaxes(control, 1, 2)
            moved = free @ np.swapaxes(columns / _lengths(columns), 1, 2)
            good &= np.linalg.svd(moved, compute_uv=False)[:, part.actuation - 1] >= REGULAR
        return good

    def _matrices(self, q: Lanes, p: Lanes) -> list[tuple[Lanes, Lanes]]:
        """B and M of each part."""
        n, m, r = self._system.n, self._system.m, self._system.r
        made = self._run(self._system.matrices_replay, q, p)
        return [
            (
                _block(made, [[i * n + j for j in part.coordinates] for i in part.rows], len(part.coordinates)),
                _block(made, [[r * n + j * m + k for k in part.inputs] for j in part.coordinates], len(part.inputs)),
            )
            for part in self._parts
        ]

    def _run(self, replay: Replay, q: Lanes, p: Lanes) -> list[Lanes]:
        """The outputs of a replay; none of those that are run here reads rates."""
        made = replay.run([*q.T, *([None] * self._system.n), *p.T, *self._literals], _FUNCTIONS)
        return [np.broadcast_to(x, len(q)) for x in made] or [np.zeros(len(q))]


@dataclass(frozen=True)
class _Ranked:
    """A part of the system with the ranks of its rows and of its inputs along what these leave free."""

    coordinates: Sequence[int]
    rows: Sequence[int]
    inputs: Sequence[int]
    constraints: int
    actuation: int


def _ranked(system: System, ranks: Ranks) -> list[_Ranked]:
    """The parts of a system; all of it where it is not known which parts lack ranks."""
    if len(ranks.of_parts) != len(system.parts):
        return [_Ranked(range(system.n), range(system.r), range(system.m), ranks.constraints, ranks.actuation)]
    pairs = zip(system.parts, ranks.of_parts, strict=True)
    return [_Ranked(part.coordinates, part.rows, part.inputs, *own) for part, own in pairs]


def _block(made: Sequence[Lanes], places: Sequence[Sequence[int]], columns: int = 1) -> Lanes:
    """A matrix at each state, of numbers by their places; without rows it still has columns."""
    count = len(made[0])
    if not places or not places[0]:
        return np.zeros((count, len(places), columns if not places else 0))
    return np.stack([np.stack([made[k] for k in row], axis=1) for row in places], axis=1)


def _finite(values: Lanes) -> Lanes:
    return np.where(np.isfinite(values), values, 0.0)


def _rows(values: Sequence[Sequence[Any]]) -> Lanes:
    return np.array([[float(x) for x in row] for row in values]).reshape(len(values), -1)


def _shifts(dice: random.Random, like: Lanes) -> Lanes:
    """Numbers between -1 and 1."""
    return np.array([2 * dice.random() - 1 for _ in range(prod(like.shape))]).reshape(like.shape)


def _lengths(rows: Lanes) -> Lanes:
    """Of every row, 1 for one that vanishes."""
    lengths = np.linalg.norm(rows, axis=2, keepdims=True)
    return np.where(lengths > 0, lengths, 1.0)


def _times(matrices: Lanes, vectors: Lanes) -> Lanes:
    return np.einsum("kij,kj->ki", matrices, vectors)
