"""What encoders and drives say of a motion at each sample: a log such as `symgen identify` reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from symgen.model.model import Model
from symgen.simulate.controllers import Array


@dataclass(frozen=True, slots=True)
class DriveLog:
    """Samples (N) at equal steps: `t` in s, measured coordinates by `names` (N x k), inputs (N x m) in their units."""

    names: tuple[str, ...]
    t: Array
    measured: Array
    inputs: Array


def drive_log(
    names: tuple[str, ...], readings: Sequence[tuple[float, Array, Array]], noise: float, seed: int
) -> DriveLog:
    """The log of readings: a time, what the encoders said, what acts from then on.

    A drive says the mean over the period about the sample, half of what acted before and half of what acts after it;
    else its inputs would be half a sample ahead of the encoders.  `noise` is the standard deviation of what it adds.
    """
    t = np.array([time for time, _, _ in readings])
    measured = np.array([said for _, said, _ in readings])
    acting = np.array([inputs for _, _, inputs in readings])
    before = np.concatenate([acting[:1], acting[:-1]])
    spread = noise * np.random.default_rng((seed, 1)).standard_normal(acting.shape)
    return DriveLog(names, t, measured, (before + acting) / 2 + spread)


def drive_log_csv(model: Model, log: DriveLog) -> str:
    """One line a sample: t, measured coordinates, inputs."""
    header = ",".join(("t", *log.names, *(one.name for one in model.inputs)))
    table = np.column_stack([log.t, log.measured, log.inputs])
    return "\n".join([header, *(",".join(f"{x:.9g}" for x in row) for row in table)]) + "\n"
