"""Rates and accelerations that satisfy the constraints, at many states at once: in float64, to look from there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.loops_in_lanes import DEPENDENT, LoopsInLanes, lengths_of
from symgen.verify.lanes.ranks_in_lanes import RankedPart, matrices
from symgen.verify.lanes.small_matrices import pseudoinverses, times
from symgen.verify.reference.system import ReferenceSystem

# A step of differences along the rates, in radians and metres a unit of time.
DIFFERENCE = 1e-5


class RatesInLanes:
    """What is closest to given rates and accelerations and satisfies the constraints of each part of a system."""

    def __init__(self, system: ReferenceSystem, parts: Sequence[RankedPart], loops: LoopsInLanes) -> None:
        self._system, self._parts, self._loops = system, parts, loops

    def admissible(self, given: Mapping[str, Lanes]) -> tuple[Lanes, Lanes, Lanes]:
        """Rates and accelerations of states by name, B qd = 0 and B qdd + B_dot qd = 0, and where rows are finite."""
        q, qd, qdd, p = given["q"], given["qd"].copy(), given["qdd"].copy(), given["p"]
        good = np.ones(len(q), dtype=bool)
        if self._system.r:
            with np.errstate(all="ignore"):
                good = self._settle(q, qd, qdd, p)
        return qd, qdd, good

    def _settle(self, q: Lanes, qd: Lanes, qdd: Lanes, p: Lanes) -> Lanes:
        """In place; where all rows are finite."""
        good = np.ones(len(q), dtype=bool)
        rows = [made for made, _ in self._matrices(q, p)]
        for made in rows:
            good &= np.isfinite(made).all(axis=(1, 2))
        lengths = [lengths_of(made) for made in rows]
        units = [_finite(made / length) for made, length in zip(rows, lengths, strict=True)]
        inverses = [pseudoinverses(unit, DEPENDENT) for unit in units]
        for part, unit, inverse in zip(self._parts, units, inverses, strict=True):
            these = list(part.coordinates)
            qd[:, these] -= times(inverse, times(unit, qd[:, these]))
        sides = (self._matrices(q + side * DIFFERENCE * qd, p) for side in (1, -1))
        for part, length, unit, inverse, (ahead, _), (behind, _) in zip(
            self._parts, lengths, units, inverses, *sides, strict=True
        ):
            these = list(part.coordinates)
            drift = np.nan_to_num(times((ahead - behind) / (2 * DIFFERENCE) / length, qd[:, these]))
            qdd[:, these] -= times(inverse, times(unit, qdd[:, these]) + drift)
        return good

    def _matrices(self, q: Lanes, p: Lanes) -> list[tuple[Lanes, Lanes]]:
        """B and M of each part."""
        return matrices(self._system, self._parts, self._loops, q, p)


def _finite(values: Lanes) -> Lanes:
    return np.where(np.isfinite(values), values, 0.0)
