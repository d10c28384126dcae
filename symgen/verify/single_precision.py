"""What float32 does to a kernel, measured beside the same operations in float64.

Estimates to the first order do not see it all: a pivot of which no digit is left shifts a result that does not depend
on it as soon as anything else is rounded.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import dist

import numpy as np

from symgen.ir.kernel import Kernel
from symgen.verify.lane_arithmetic import Lanes
from symgen.verify.many_states import run_many


def lost_in_float32(kernel: Kernel, given: Mapping[str, Lanes]) -> Lanes:
    """How far results are off at states, a row each of arguments and of parameters `p`; 0 where either is none."""
    states = in_single_precision(given)
    made = run_many(kernel, None, "float32", states)
    exact = run_many(kernel, None, "float64", states, numbers="float32")
    off = [dist(y, z) if y and z else 0.0 for (_, y), (_, z) in zip(made, exact, strict=True)]
    return np.nan_to_num(np.array(off), posinf=0.0)


def in_single_precision(given: Mapping[str, Lanes]) -> list[dict[str, list[float]]]:
    """Of each state what is given, in single precision."""
    single = {name: rows.astype(np.float32).tolist() for name, rows in given.items()}
    count = len(next(iter(given.values())))
    return [{name: rows[place] for name, rows in single.items()} for place in range(count)]
