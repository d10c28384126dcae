"""Where the task of a model is to be a moment after a state: what a configuration is looked for from there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.lane_replay import LaneReplay
from symgen.verify.reference.configurations.given import MOMENT
from symgen.verify.reference.reference import Reference, State
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.sampling.plain_values import SAMPLING_BITS, floats


def with_task(reference: Reference, state: State) -> State:
    """The state with the coordinates of its task, rounded to float64; itself where the model has none."""
    if not reference.model.task:
        return state

    def ahead() -> tuple[float, ...]:
        e = reference.evaluation(state)
        place = [q + MOMENT * qd for q, qd in zip(e.q, e.qd, strict=True)]
        return floats(reference.system.task(place, e.parameters, e.literals)[0])

    return replace(state, task=reference.regular(ahead, SAMPLING_BITS))


class TaskInLanes:
    """The same at many states at once, in float64; `literals` are the values of the system's literals."""

    def __init__(self, system: ReferenceSystem, literals: Sequence[float]) -> None:
        self._system, self._literals = system, list(literals)

    @cached_property
    def _replay(self) -> LaneReplay:
        return LaneReplay(self._system.task_replay)

    def ahead(self, parts: Mapping[str, Lanes]) -> Lanes:
        """A row for each state, empty where the model has no task."""
        q, qd, p = parts["q"], parts["qd"], parts["p"]
        k = len(self._system.model.task)
        if not k:
            return np.zeros((len(q), 0))
        place = q + MOMENT * qd
        return self._replay.run([*place.T, *([None] * self._system.n), *p.T, *self._literals], len(q))[:k].T
