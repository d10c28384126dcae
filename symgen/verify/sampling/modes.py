"""Configurations in as many assembly modes as are found cheaply, before anything is looked at in many digits.

Newton's method from a state that is known stays in the mode of that state, and a random start leads to the modes whose
basins are wide.  So hundreds of starts are closed at once: all over the ranges, angles over the whole circle, and
configurations that were reached with some of their coordinates reflected, as legs bend the other way.  Of those that
close the ones that lie farthest from each other are kept, so that few of them meet many modes.

The numbers are float64: they say where to look, never what is right.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from math import pi

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.loops_in_lanes import DAMPED_STEPS, LoopsInLanes
from symgen.verify.lanes.ranks_in_lanes import is_regular, matrices, ranked_parts
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.reach import reachable

# Binary digits in which parameters and literals are worked out before they are floats.
MODE_BITS = 128
# Starts in the ranges, and rounds of as many that are reflected.
STARTS, ROUNDS = 64, 2
# Configurations that are kept, those farthest from each other.
MODES_KEPT = 64
# Operations of the constraints in all steps of all starts of a model; fewer steps are made of long ones.
MODE_OPERATIONS = 400_000
# Steps towards V from each start, at least.
FEWEST_STEPS = 6
# Shares of the widths of ranges: how near configurations are the same, and to which digits they are told apart.
SAME_MODE, MODE_DIGITS = 1e-3, 6
# Of a row of length 1: what is left of a loop that is closed.
CLOSED_MODE = 1e-9


def modes(reference: Reference) -> tuple[tuple[float, ...], ...]:
    """Configurations far from each other that satisfy the geometric rows for default parameters; none of a tree.

    Angles lie within a turn of 0, all else in the ranges that are told.
    """
    system = reference.system
    if not system.r_geometric:
        return ()
    with precision(MODE_BITS):
        parameters = [float(x) for x in default_parameters(reference.model)]
        literals = [float(x) for x in reference.literals()]
    places = () if reference.model.assembly is None else reference.model.assembly.places
    with np.errstate(all="ignore"):
        kept = _Modes(reference, parameters, literals).kept([place.q for place in places])
    return tuple(tuple(map(float, q)) for q in kept)


class _Modes:
    def __init__(self, reference: Reference, parameters: Sequence[float], literals: Sequence[float]) -> None:
        system, coordinates = reference.system, reference.model.coordinates
        self._system, self._loops = system, LoopsInLanes(system, literals)
        self._parts = ranked_parts(system, reference.ranks)
        self._dice = random.Random("modes")
        self._parameters = np.array(parameters)
        self._angles = np.array([c.is_angle for c in coordinates])
        self._low, self._high = reachable(coordinates)
        self._has_range = np.array([c.has_range for c in coordinates])
        self._widths = np.where(self._angles, 1.0, (self._high - self._low) / 2)
        operations = (1 + ROUNDS) * (system.geometry_replay.operations + 1)
        self._steps = max(FEWEST_STEPS, min(DAMPED_STEPS, MODE_OPERATIONS // operations))

    def kept(self, places: Sequence[Sequence[float]]) -> Lanes:
        """Those kept, the one first that lies first among the places."""
        known = np.array([list(q) for q in places]).reshape(len(places), self._system.n)
        drawn = self._closed(np.array([self._anywhere() for _ in range(STARTS)]))
        known = self._apart(np.concatenate((self._closed(known), drawn)))
        for _ in range(ROUNDS if len(known) else 0):
            starts = [self._reflected(known[index % len(known)]) for index in range(STARTS)]
            known = self._apart(np.concatenate((known, self._closed(np.array(starts)))))
        return known

    def _anywhere(self) -> list[float]:
        pairs = zip(self._low, self._high, self._angles & ~self._has_range, strict=True)
        return [self._dice.uniform(-pi, pi) if whole else self._dice.uniform(low, high) for low, high, whole in pairs]

    def _reflected(self, q: Lanes) -> list[float]:
        """With some angles turned to their negatives or supplements, or drawn anew, and some lengths on the other
        side of the middle."""
        anew = self._anywhere()
        reflected = []
        for j, x in enumerate(q):
            other = (-x, pi - x, anew[j]) if self._angles[j] else (self._low[j] + self._high[j] - x, anew[j])
            reflected.append(float(self._dice.choice((x, self._dice.choice(other)))))
        return reflected

    def _closed(self, starts: Lanes) -> Lanes:
        """Where starts lead that close in the ranges, regularly and on the branch that is meant; angles are turned back
        where whole turns change nothing."""
        if not len(starts):
            return starts
        p = np.broadcast_to(self._parameters, (len(starts), len(self._parameters)))
        q = self._loops.damped(starts, p, self._steps)
        back = np.where(self._angles, q - 2 * pi * np.round((q - self._middle) / (2 * pi)), q)
        q = np.where(self._loops.shut(back, p, CLOSED_MODE)[:, None], back, q)
        slack = 0.01 * (self._high - self._low)
        inside = ((q >= self._low - slack) & (q <= self._high + slack) | ~self._has_range & self._angles).all(axis=1)
        good = inside & self._loops.shut(q, p, CLOSED_MODE)
        for part, blocks in zip(self._parts, matrices(self._system, self._parts, self._loops, q, p), strict=True):
            good &= is_regular(part, *blocks, other_branches=False)
        return q[good]

    @property
    def _middle(self) -> Lanes:
        return np.where(self._has_range, (self._low + self._high) / 2, 0.0)

    def _apart(self, q: Lanes) -> Lanes:
        """At most so many as are kept, each as far as possible from those before it."""
        if not len(q):
            return q
        scaled = np.where(self._angles, 0.0, q / self._widths)
        seen = np.concatenate((scaled, self._angles * np.cos(q), self._angles * np.sin(q)), axis=1).round(MODE_DIGITS)
        chosen, distance = [0], np.linalg.norm(seen - seen[0], axis=1)
        while len(chosen) < min(MODES_KEPT, len(q)):
            farthest = int(np.argmax(distance))
            if distance[farthest] < SAME_MODE:
                break
            chosen.append(farthest)
            distance = np.minimum(distance, np.linalg.norm(seen - seen[farthest], axis=1))
        return q[chosen]
