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
    """By a trial of the first points of the first chunk and of the last one."""
    plan, chunks = work.plan, work.chunks
    wanted = max(1, TRIAL_STATES // plan.states // 2)
    trials = [chunk_values(plan, chunks, number)[:wanted] for number in sorted({0, len(chunks) - 1})]
    began = time.perf_counter()
    total: float | None = None
    # a chunk that fails says so itself
    with suppress(Exception):
        for values in trials:
            chunk_results(plan, work.kernels, work.states, values)
        total = (time.perf_counter() - began) / sum(map(len, trials)) * plan.points
    return StudyEstimate(plan.points, plan.points * plan.states, study_size(plan), total)


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
