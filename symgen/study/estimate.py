"""What a study will take: states, size of the results and time, by a trial of a few of its points."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from dataclasses import dataclass

from symgen.study.chunks import chunk_values
from symgen.study.plan import StudyPlan
from symgen.study.reductions import chunk_results, result_variables
from symgen.study.work import StudyWork

# States beyond which a study is only begun where it was asked for by --yes.
MOST_UNASKED_STATES = 1_000_000_000
# States of a trial at least; one point has more where its path has.
TRIAL_STATES = 32_768
# Seconds below which a trial says little.
SHORT_TRIAL_SECONDS = 0.1
# How many times as many points a second trial has then.
TRIAL_GROWTH = 32
# Bytes of an entry of the results.
ENTRY_BYTES = 8


@dataclass(frozen=True, slots=True)
class StudyEstimate:
    """States, bytes of the results before compression, seconds of one core; no seconds where the trial failed."""

    points: int
    states: int
    size: int
    seconds: float | None

    @property
    def text(self) -> str:
        """One line."""
        each = f" of {self.states // self.points} states each" if self.states > self.points else ""
        points = f"{self.points:,} points{each}" if self.points > 1 else f"1 point{each}"
        took = "" if self.seconds is None else f", about {duration(self.seconds)} of one core"
        return f"{points}, {self.states:,} states, {_bytes(self.size)} of results{took}"


def study_size(plan: StudyPlan) -> int:
    """Bytes of the arrays of the results."""
    entries = sum(math.prod(one.inner_shape) for one in result_variables(plan))
    return plan.points * entries * ENTRY_BYTES


def estimated(work: StudyWork) -> StudyEstimate:
    """By a trial of the first points of the first chunk and of the last one; by one of more points where it is over at
    once, as memory is mapped and what is kept of the machine is made then."""
    plan = work.plan
    total: float | None = None
    # a chunk that fails says so itself
    with suppress(Exception):
        wanted = max(1, TRIAL_STATES // plan.states // 2)
        took, total = _trial(work, wanted)
        if took < SHORT_TRIAL_SECONDS:
            _, total = _trial(work, wanted * TRIAL_GROWTH)
    return StudyEstimate(plan.points, plan.points * plan.states, study_size(plan), total)


def _trial(work: StudyWork, wanted: int) -> tuple[float, float]:
    """Seconds of a trial of so many points of both chunks, and seconds of all points by it."""
    numbers = sorted({0, len(work.chunks) - 1})
    trials = [chunk_values(work.plan, work.chunks, number)[:wanted] for number in numbers]
    began, once_before = time.perf_counter(), work.states.seconds_once
    for values in trials:
        chunk_results(work.plan, work.kernels, work.states, values)
    once = work.states.seconds_once
    took = time.perf_counter() - began - (once - once_before)
    return took, once + took / sum(map(len, trials)) * work.plan.points


def duration(seconds: float) -> str:
    """Seconds, minutes, hours or days."""
    for unit, length in (("days", 86_400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{max(1, round(seconds))} s"


def _bytes(size: int) -> str:
    for unit, length in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if size >= length:
            return f"{size / length:.1f} {unit}"
    return f"{max(1, round(size / 1e3))} kB"
