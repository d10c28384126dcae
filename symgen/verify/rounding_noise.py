"""How much of a result is noise of rounding, measured without anything more precise.

Along a short line a function is all but straight, and its rounding errors are not: second differences are these errors
(Hamming, Introduction to Applied Numerical Analysis, 1971, section 6; Moré and Wild, Estimating computational noise,
SIAM J. Sci. Comput. 33, 2011).  Estimates on plain numbers say nothing of kernels with twice the digits where plain
numbers have lost all of theirs.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Function, Kernel
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.many_states import run_together
from symgen.verify.single_precision import distances

EPS = float(UNIT_ROUNDOFF["float64"])
# Of every number that is given, the share that a state is moved by: more than it is rounded by, and so little that
# functions are straight.
NOISE_STEP = 2.0**-45
# Lines through each state that seems noisy along the first of them.
LINES = 3
# Units of d + eps |y| that seem so. With 2 a state that loses eight was passed over: one second difference in five is a
# quarter of its mean size and less.
NOISY = 0.5
# The second difference of three independent errors, in their mean size.
OF_THREE = sqrt(6)


@dataclass
class _Measured:
    """At each state, whether it is answered, results, and the largest slopes and second differences so far."""

    known: Lanes
    here: Lanes
    changes: Lanes
    noise: Lanes

    @property
    def units(self) -> Lanes:
        unit = self.changes + EPS * distances(self.here, np.zeros_like(self.here))
        with np.errstate(all="ignore"):
            return np.where(self.known & (self.noise > 0), self.noise / unit, 0.0)

    def only(self, places: Lanes) -> _Measured:
        return _Measured(self.known[places], self.here[places], self.changes[places], self.noise[places])

    def add(self, ends: Sequence[tuple[Lanes, Lanes]]) -> None:
        """What both ends of some lines tell, where neither refuses."""
        for (refused, up), (lost, down) in zip(ends[::2], ends[1::2], strict=True):
            known = self.known & (refused + lost == 0)
            with np.errstate(all="ignore"):
                slope = distances(up, down) / 2 * (EPS / NOISE_STEP)
                second = distances(up - self.here, self.here - down) / OF_THREE
            self.changes = np.maximum(self.changes, np.where(known, slope, 0.0))
            self.noise = np.maximum(self.noise, np.where(known, second, 0.0))


def noise_in_units(
    kernel: Kernel, sincos: Function | None, given: Mapping[str, Lanes], lines: int = LINES
) -> Lanes:
    """The noise of a kernel in float64 at each state in units of d + eps |y|, d by its slopes; 0 where it refuses."""
    dice = random.Random(kernel.name)
    (status, here), *ends = run_together(kernel, sincos, "float64", [given, *_aside(given, dice)])
    measured = _Measured(status == 0, here, np.zeros(len(status)), np.zeros(len(status)))
    measured.add(ends)
    units = measured.units
    noisy = np.flatnonzero(units > NOISY)
    if lines > 1 and len(noisy):
        there = {name: rows[noisy] for name, rows in given.items()}
        asides = [one for _ in range(1, lines) for one in _aside(there, dice)]
        again = measured.only(noisy)
        again.add(run_together(kernel, sincos, "float64", asides))
        units[noisy] = again.units
    return units


def _aside(given: Mapping[str, Lanes], dice: random.Random) -> tuple[dict[str, Lanes], dict[str, Lanes]]:
    """States on both sides, exactly as far away."""
    above, below = {}, {}
    for name, rows in given.items():
        up = rows + rows * np.array([dice.choice((-NOISE_STEP, NOISE_STEP)) for _ in range(rows.shape[1])])
        above[name], below[name] = up, rows - (up - rows)
    return above, below
