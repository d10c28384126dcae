"""The least inertia of a direction that the constraints allow, at many states at once: in float64, where to look."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.lane_replay import LaneReplay
from symgen.verify.lanes.loops_in_lanes import LoopsInLanes, lengths_of
from symgen.verify.reference.mechanism.bodies import BODY_ROWS, WEIGHTS
from symgen.verify.reference.system import ReferenceSystem


class MassesInLanes:
    """G along what the rows leave free; `constraints` is the rank of B."""

    def __init__(
        self, system: ReferenceSystem, constraints: int, loops: LoopsInLanes, literals: Sequence[float]
    ) -> None:
        self._system, self._constraints, self._loops = system, constraints, loops
        self._literals = list(literals)
        self._replay = LaneReplay(system.masses_replay)

    def shares(self, q: Lanes, p: Lanes) -> Lanes:
        """The least over the largest inertia, for each state; 0 where masses are no numbers."""
        system, count = self._system, len(q)
        if system.n == self._constraints:
            return np.ones(count)
        mass = np.where(np.isfinite(made := self._mass(q, p)), made, 0.0)
        free = np.broadcast_to(np.eye(system.n), mass.shape)
        if system.r:
            rows = self._loops.matrices(q, p)[: system.r * system.n].T.reshape(count, system.r, system.n)
            rows = np.where(np.isfinite(rows), rows, 0.0)
            free = np.linalg.svd(rows / lengths_of(rows))[2][:, self._constraints :]
        sizes = np.linalg.eigvalsh(free @ mass @ np.swapaxes(free, 1, 2))
        largest = sizes[:, -1]
        return np.divide(np.maximum(sizes[:, 0], 0), largest, out=np.zeros(count), where=largest > 0)

    def _mass(self, q: Lanes, p: Lanes) -> Lanes:
        """G (n x n), what is written out and the bodies of each part."""
        system, n, count = self._system, self._system.n, len(q)
        values = self._replay.run([*q.T, *([None] * n), *p.T, *self._literals], count)
        mass = values[: n * n].T.reshape(count, n, n).copy()
        bodies = len(system.model.mechanism.bodies)
        weights = values[n * n : n * n + WEIGHTS * bodies].T.reshape(count, bodies, WEIGHTS)
        start = n * n + WEIGHTS * bodies
        for part in system.heavy:
            these = np.array(part.coordinates)
            for body in part.bodies:
                size = BODY_ROWS * len(these)
                rows = values[start : start + size].T.reshape(count, BODY_ROWS, len(these))
                start += size
                own = weights[:, body]
                loads = np.concatenate((own[:, :1, None] * rows[:, :3], own[:, 1:].reshape(-1, 3, 3) @ rows[:, 3:]), 1)
                mass[:, these[:, None], these] += np.swapaxes(rows, 1, 2) @ loads
        return mass
