"""What float32 does to a kernel, measured beside the same operations in float64.

Estimates to the first order do not see it all: a pivot of which no digit is left shifts a result that does not depend
on it as soon as anything else is rounded.
"""

from __future__ import annotations

import random
from collections.abc import Mapping

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Kernel, Program, Scalar
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.many_states import run_lanes, run_together

TYPES: tuple[Scalar, Scalar] = ("float64", "float32")
# Changes of what is given, of which d is the largest effect.
CHANGES = 3


def lost_in_float32(kernel: Kernel, given: Mapping[str, Lanes]) -> Lanes:
    """How far results are off at states, a row each of arguments and of parameters `p`; 0 where either is none."""
    single = in_single_precision(given)
    refused, y = run_lanes(kernel, None, "float32", single)
    unknown, z = run_lanes(kernel, None, "float64", single, numbers="float32")
    return np.nan_to_num(np.where(refused + unknown == 0, distances(y, z), 0.0), posinf=0.0)


def units_in_float32(kernel: Kernel, programs: Mapping[Scalar, Program], given: Mapping[str, Lanes]) -> Lanes:
    """The same in units of d + eps |y|, d of few changes of what is given: for a choice among many states, no verdict.

    Infinite where float64 refuses, and as large as numbers get where float32 alone does.  Sines are those of the
    programs; without one in float32 all are the library's.
    """
    sincos, single_sincos = (programs[s].sincos if "float32" in programs else None for s in TYPES)
    single = in_single_precision(given)
    eps, dice = float(UNIT_ROUNDOFF["float32"]), random.Random(kernel.name)
    moved = [
        {name: rows * _factors(rows.shape[1], eps, dice) for name, rows in single.items()} for _ in range(CHANGES)
    ]
    (unknown, exact), *others = run_together(kernel, sincos, "float64", [single, *moved], numbers="float32")
    refused, made = run_lanes(kernel, single_sincos, "float32", single)
    unit = eps * distances(exact, np.zeros_like(exact))
    changes = np.zeros_like(unit)
    for beside, changed in others:
        changes = np.maximum(changes, np.where(beside == 0, distances(changed, exact), 0.0))
    with np.errstate(all="ignore"):
        units = np.where(refused, np.inf, distances(made, exact) / (unit + changes))
    return np.where(unknown, np.inf, np.nan_to_num(units))


def in_single_precision(given: Mapping[str, Lanes]) -> dict[str, Lanes]:
    """What is given, in single precision."""
    with np.errstate(over="ignore"):
        return {name: rows.astype(np.float32).astype(float) for name, rows in given.items()}


def distances(y: Lanes, z: Lanes) -> Lanes:
    """|y - z| of each row, without overflow of squares."""
    with np.errstate(all="ignore"):
        apart = np.abs(y - z)
        largest = apart.max(axis=1, initial=0.0)
        scale = np.where((largest > 0) & np.isfinite(largest), largest, 1.0)[:, None]
        return np.where(np.isnan(largest), np.nan, scale[:, 0] * np.sqrt(np.square(apart / scale).sum(axis=1)))


def _factors(count: int, eps: float, dice: random.Random) -> Lanes:
    """Every number a roundoff larger or smaller."""
    return np.array([dice.choice((1 - eps, 1 + eps)) for _ in range(count)])
