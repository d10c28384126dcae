"""How much of a result is noise of rounding, measured without anything more precise.

Along a short line a function is all but straight, and its rounding errors are not: second differences are these errors
(Hamming, Introduction to Applied Numerical Analysis, 1971, section 6; Moré and Wild, Estimating computational noise,
SIAM J. Sci. Comput. 33, 2011).  Estimates on plain numbers say nothing of kernels with twice the digits where plain
numbers have lost all of theirs.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from math import sqrt

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Function, Kernel
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.many_states import run_together
from symgen.verify.single_precision import distances

# Of every number that is given, the share that a state is moved by: more than it is rounded by, and so little that
# functions are straight.
NOISE_STEP = 2.0**-45
# Lines through each state.
LINES = 3
# The second difference of three independent errors, in their mean size.
OF_THREE = sqrt(6)


def noise_in_units(
    kernel: Kernel, sincos: Function | None, given: Mapping[str, Lanes], lines: int = LINES
) -> Lanes:
    """The noise of a kernel in float64 at each state in units of d + eps |y|, d by its slopes; 0 where it refuses."""
    dice, eps = random.Random(kernel.name), float(UNIT_ROUNDOFF["float64"])
    asides = [one for _ in range(lines) for one in _aside(given, dice)]
    (status, here), *ends = run_together(kernel, sincos, "float64", [given, *asides])
    changes = noise = np.zeros(len(status))
    for (refused, up), (lost, down) in zip(ends[::2], ends[1::2], strict=True):
        known = status + refused + lost == 0
        with np.errstate(all="ignore"):
            slope = distances(up, down) / 2 * (eps / NOISE_STEP)
            second = distances(up - here, here - down) / OF_THREE
        changes = np.maximum(changes, np.where(known, slope, 0.0))
        noise = np.maximum(noise, np.where(known, second, 0.0))
    unit = changes + eps * distances(here, np.zeros_like(here))
    with np.errstate(all="ignore"):
        return np.where((status == 0) & (noise > 0), noise / unit, 0.0)


def _aside(given: Mapping[str, Lanes], dice: random.Random) -> tuple[dict[str, Lanes], dict[str, Lanes]]:
    """States on both sides, exactly as far away."""
    above, below = {}, {}
    for name, rows in given.items():
        up = rows + rows * np.array([dice.choice((-NOISE_STEP, NOISE_STEP)) for _ in range(rows.shape[1])])
        above[name], below[name] = up, rows - (up - rows)
    return above, below
