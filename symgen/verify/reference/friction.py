"""Friction that grows with reactions, by definition: a fixed point found by Newton's method, with a bound of its error.

Joints whose reactions are no multipliers are let go: the reference of a second system, in which their frames may leave
their parents, says what keeps them shut.  Friction of a place comes from that system with one force element alone.  A
unit of friction at each place, and the motion without any, are met by inputs and reactions in turn; what they make of
the loads n_i = |R_i| contracts with the share kappa in the largest of them, so that what a load misses after Newton's
steps bounds its error by 1 / (1 - kappa).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any
from weakref import WeakKeyDictionary

from flint import arb, arb_mat, ctx

from symgen.model.expressions.expression import Binary, Call, Number
from symgen.model.model import Force, Model, RoughPlace
from symgen.verify.reference.arithmetic.linear import column, solve
from symgen.verify.reference.arithmetic.tape import Tape, ball, replay_of
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Taylor
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.release import with_joints_released
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import Translation

# Newton steps for all digits: each doubles them.
MOST_LOAD_STEPS = 40
# The share of friction in the reactions it grows with, from which on a mechanism locks.
LOCKED_SHARE = Fraction(1, 2)


class FrictionLocksError(Exception):
    """Friction returns half or more of the reactions it grows with."""


class RoughSystem:
    """The systems behind the friction of a model: with joints let go, and with one force element each."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.released = with_joints_released(model)
        bare = replace(self.released, applied_forces=())
        self.system = ReferenceSystem(self.released)
        self.sliding = [ReferenceSystem(replace(bare, forces=(_element(place),))) for place in model.rough]

    @cached_property
    def places(self) -> dict[str, int]:
        """Of the coordinates that are let go, after those of the model."""
        return {c.name: k for k, c in enumerate(self.released.coordinates)}


def _element(place: RoughPlace) -> Force:
    """Friction of a place for a load of 1."""
    way = Call("tanh", (Binary("/", place.velocity, place.width),))
    return Force(place.name, Binary("*", Binary("*", place.coefficient, place.radius), way), place.velocity)


_KNOWN: WeakKeyDictionary[ReferenceSystem, RoughSystem] = WeakKeyDictionary()


def friction_of(e: Evaluation, of_motion: bool = False) -> ReferenceFriction:
    """The friction of a state, of its accelerations or of its inputs, with the systems behind it made once."""
    if e.system not in _KNOWN:
        _KNOWN[e.system] = RoughSystem(e.system.model)
    return ReferenceFriction(e, _KNOWN[e.system], of_motion)


@dataclass
class ReferenceFriction:
    """The friction of one state."""

    e: Evaluation
    rough: RoughSystem
    of_motion: bool = False  # for inputs that are given: accelerations supply friction

    def _of(self, system: ReferenceSystem, take: Callable[[ReferenceSystem, Sequence[Any]], Any]) -> Any:
        """What a system with joints let go says where they are shut, with the literals of this state."""
        own = {id(literal): value for literal, value in zip(self.e.system.literals, self.e.literals, strict=True)}
        return take(system, [own.get(id(x)) or _value(x) for x in system.literals])

    @cached_property
    def _shut(self) -> Evaluation:
        """The state of the system with joints let go."""
        still = [arb(0)] * (self.rough.released.n - self.e.system.n)
        motion = ([*part, *still] for part in (self.e.q, self.e.qd, self.e.qdd))
        q, qd, qdd = motion

        def made(system: ReferenceSystem, literals: Sequence[Any]) -> Evaluation:
            return Evaluation(system, self.e.ranks, q, qd, qdd, self.e.u, self.e.parameters, literals)

        evaluation: Evaluation = self._of(self.rough.system, made)
        return evaluation

    @cached_property
    def columns(self) -> list[Any]:
        """Friction of each place for a load of 1, along the model's coordinates and those let go."""
        at = self._shut

        def applied(system: ReferenceSystem, literals: Sequence[Any]) -> Any:
            return system.applied(at.q, at.qd, at.parameters, literals)

        return [self._of(system, applied) for system in self.rough.sliding]

    def _reactions(self, force: Any) -> list[list[Any]]:
        """What each place carries where a force, in all coordinates, is met by constraints and inputs.

        With accelerations in the place of inputs, for a force that these have to supply.
        """
        e, n, shut = self.e, self.e.system.n, self._shut
        own = column(force.entries()[:n])
        if self.of_motion:
            accelerations = -(e.weighted * own)
            multipliers = -(e.inverse.transpose() * (own + e.at.mass * accelerations))
            still = column([*accelerations.entries(), *[arb(0)] * (self.rough.released.n - n)])
            held = force + shut.at.mass_times(still) + shut.at.constraints.transpose() * multipliers
        else:
            inputs = e.control_inverse * (e.projector * own)
            multipliers = e.inverse.transpose() * (e.at.control * inputs - own)
            held = force - shut.at.control * inputs + shut.at.constraints.transpose() * multipliers
        return self._carried(multipliers, held)

    def _carried(self, multipliers: Any, held: Any) -> list[list[Any]]:
        rows = {row.name: k for k, row in enumerate(self.rough.model.constraints)}
        return [
            [
                *(multipliers[rows[name], 0] for name in place.rows),
                *(held[self.rough.places[name], 0] for name in place.released),
            ]
            for place in self.rough.model.rough
        ]

    @cached_property
    def _known_loads(self) -> list[list[Any]]:
        """The loads (N) that are given, of each place one or none."""
        model, loads = self.rough.model, []
        for place in model.rough:
            tape = Tape()
            known = {p.name: {CONSTANT: tape.input(k)} for k, p in enumerate(model.parameters)}
            given = Translation(Taylor(tape, 0, 0), known, {}, {})
            wanted = [] if place.load is None else [given.polynomial(place.load).get(CONSTANT, tape.zero)]
            loads.append(list(replay_of(tape, wanted).run(self.e.parameters)))
        return loads

    def _smooth(self) -> list[list[Any]]:
        """What each place carries without friction."""
        if not self.of_motion:
            return self._reactions(self._shut.load)
        e, shut = self.e, self._shut
        multipliers = e.inverse.transpose() * (e.force - e.at.mass * e.accelerations)
        moving = column([*e.accelerations.entries(), *[arb(0)] * (self.rough.released.n - e.system.n)])
        load = shut.at.mass_times(moving) + shut.bias
        return self._carried(
            multipliers,
            load - shut.at.control * column(e.u) + shut.at.constraints.transpose() * multipliers,
        )

    @cached_property
    def answers(self) -> list[list[list[Any]]]:
        """By j, then i: what friction of place j for a load of 1 adds to the reaction of place i."""
        return [self._reactions(force) for force in self.columns]

    @cached_property
    def kappa(self) -> Any:
        """The largest sum of shares that come back to a reaction."""
        answers = self.answers
        sums = [sum((_length(answer[i]) for answer in answers), arb(0)) for i in range(len(answers))]
        largest = sums[0]
        for one in sums[1:]:
            largest = largest.max(one)
        return largest

    @cached_property
    def loads(self) -> list[Any]:
        """n_i, each a ball that holds the fixed point.  Raises FrictionLocksError."""
        if not self.kappa < ball(LOCKED_SHARE):
            raise FrictionLocksError
        count = len(self.answers)
        free = [[*x, *known] for x, known in zip(self._smooth(), self._known_loads, strict=True)]
        none = [[arb(0)] * len(known) for known in self._known_loads]
        answers = [[[*x, *zero] for x, zero in zip(answer, none, strict=True)] for answer in self.answers]

        def carried(loads: Sequence[Any]) -> list[list[Any]]:
            return [
                [
                    x + sum((loads[j] * answers[j][i][k] for j in range(count)), arb(0))
                    for k, x in enumerate(free[i])
                ]
                for i in range(count)
            ]

        loads = [_length(reaction).mid() for reaction in free]
        settled = 2.0 ** (-ctx.prec // 2 - 4)  # squared by the step itself
        for _ in range(MOST_LOAD_STEPS):
            reactions = carried(loads)
            sizes = [_length(reaction) for reaction in reactions]
            slopes = [
                [int(i == j) - _along(reactions[i], answers[j][i], sizes[i]) for j in range(count)]
                for i in range(count)
            ]
            missing = column([size - load for size, load in zip(sizes, loads, strict=True)])
            step = solve(arb_mat(count, count, [x for row in slopes for x in row]), missing)
            loads = [(load + change).mid() for load, change in zip(loads, step.entries(), strict=True)]
            if all(float(abs(x)) <= settled * float(load) for x, load in zip(step.entries(), loads, strict=True)):
                break
        reached = [_length(reaction) for reaction in carried(loads)]
        # what the last step misses bounds what is left of its error
        error = arb(0)
        for size, load in zip(reached, loads, strict=True):
            error = error.max((size - load).abs_upper())
        bound = error / (1 - self.kappa)
        return [load + arb(0, bound.abs_upper()) for load in loads]

    @property
    def force(self) -> Any:
        """D (n x 1)."""
        total = arb_mat(self.e.system.n, 1)
        for force, load in zip(self.columns, self.loads, strict=True):
            total += column([load * x for x in force.entries()[: self.e.system.n]])
        return total


def _value(literal: Any) -> Any:
    return ball(literal.value) if isinstance(literal, Number) else arb.pi()


def _length(vector: Sequence[Any]) -> Any:
    """The length; where it may be 0 a ball about 0 that holds it."""
    square = sum((x * x for x in vector), arb(0))
    return arb(0, square.abs_upper().sqrt().abs_upper()) if square.contains(0) else square.sqrt()


def _along(reaction: Sequence[Any], change: Sequence[Any], size: Any) -> Any:
    """How the length of a reaction changes; 0 where there is none."""
    if size.contains(0):
        return arb(0)
    return sum((x * y for x, y in zip(reaction, change, strict=True)), arb(0)) / size
