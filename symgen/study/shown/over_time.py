"""What a path asks for at each of its times, over the variants of a study: bands of all, and lines of some."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from symgen.paths.drawing import COLOURS, STYLES, svg, with_numbered_regions
from symgen.study.asked.request import GRID, MOTOR_TORQUE
from symgen.study.chunks import Array, point_values
from symgen.study.interest import BlockValues, Interest, interests
from symgen.study.plan import StudyPlan
from symgen.study.reductions import BLOCK_STATES, MAXIMUM_OF, MEAN_OF, MINIMUM_OF, TIME, ResultVariable
from symgen.study.shown.labels import axis_label, value_label
from symgen.study.shown.pictures import MOST_PANELS, StudyPicture
from symgen.study.work import StudyWork

# Points of a study that are looked at: all of them, or so many that stand evenly among them.
MOST_BAND_POINTS = 256
# Lines of single values where one name is varied.
MOST_BAND_LINES = 5
# Inches: the height of a panel, and what the labels of the times take below the last one.
BAND_HEIGHT, LEGEND_HEIGHT = 1.9, 0.6
_ABOUT = {MINIMUM_OF: "smallest value", MAXIMUM_OF: "largest value", MEAN_OF: "mean"}


@dataclass(frozen=True, slots=True)
class TimeBand:
    """A quantity of interest at the times (s) of a path: the smallest, the largest and the mean value of the `points`
    that were looked at (channels x times each), NaN where none has a result.

    `lines` are some of them, with the value of the one name that is varied over a grid.
    """

    interest: Interest
    times: Array
    low: Array
    high: Array
    mean: Array
    points: int
    lines: tuple[tuple[float, Array], ...]

    @property
    def arrays(self) -> tuple[tuple[ResultVariable, Array], ...]:
        """What the results have of it, times first."""
        one = self.interest
        dimensions = (TIME, one.dimension) if one.dimension else (TIME,)
        times = tuple(self.times.tolist())
        labels = (times, one.channels) if one.dimension else (times,)
        made = []
        for figure, values in ((MINIMUM_OF, self.low), (MAXIMUM_OF, self.high), (MEAN_OF, self.mean)):
            about = f"{one.about}: {_ABOUT[figure]} of {self.points} points at each time of the path"
            attributes = {"long_name": about, "units": one.unit}
            variable = ResultVariable(f"{one.name}_{TIME}_{figure}", dimensions, labels, "f8", attributes)
            made.append((variable, values.T.reshape(variable.inner_shape)))
        return tuple(made)


def time_bands(work: StudyWork) -> tuple[TimeBand, ...]:
    """Those of what a study along a path shows; they depend on the study alone."""
    plan = work.plan
    path = next((one for one in plan.model.paths if plan.request.path and one.name == plan.request.path.name), None)
    shown = [one for one in interests(plan) if not one.counted and one.name != MOTOR_TORQUE]
    if path is None or not shown:
        return ()
    times = np.linspace(0.0, float(path.duration), path.samples)
    count = min(plan.points, MOST_BAND_POINTS)
    values = point_values(plan, work.chunks, np.linspace(0, plan.points - 1, count).round().astype(int).tolist())
    lines = np.unique(np.linspace(0, count - 1, min(count, MOST_BAND_LINES)).round().astype(int))
    sums = [_Sums(one, len(times)) for one in shown]
    has_lines = plan.request.sample == GRID and len(plan.over) == 1
    step = max(1, BLOCK_STATES // plan.states)
    for start in range(0, count, step):
        here = values[start : start + step]
        block = BlockValues(plan, work.kernels, work.states.of(here))
        kept = [k for k in lines.tolist() if start <= k < start + step] if has_lines else []
        for one in sums:
            one.add(block.of(one.interest.name), [(float(values[k, 0]), k - start) for k in kept])
    return tuple(one.band(times, count) for one in sums)


class _Sums:
    """What is known of one quantity of interest, block by block of points."""

    def __init__(self, interest: Interest, times: int) -> None:
        self.interest = interest
        shape = len(interest.channels), times
        self._low, self._high = np.full(shape, np.nan), np.full(shape, np.nan)
        self._total, self._number = np.zeros(shape), np.zeros(shape)
        self._lines: list[tuple[float, Array]] = []

    def add(self, values: Array, lines: Sequence[tuple[float, int]]) -> None:
        """Further points (points x channels x times), and which of them are lines by a value."""
        self._low, self._high = np.fmin(self._low, np.fmin.reduce(values)), np.fmax(self._high, np.fmax.reduce(values))
        self._total += np.nansum(values, axis=0)
        self._number += np.isfinite(values).sum(axis=0)
        self._lines += [(value, values[place].copy()) for value, place in lines]

    def band(self, times: Array, points: int) -> TimeBand:
        """What has come of it."""
        with np.errstate(invalid="ignore"):
            mean = self._total / self._number
        return TimeBand(self.interest, times, self._low, self._high, mean, points, tuple(self._lines))


def band_pictures(plan: StudyPlan, bands: Sequence[TimeBand]) -> list[StudyPicture]:
    """A picture of each quantity of interest that has a value somewhere."""
    return [_picture(plan, band) for band in bands if np.isfinite(band.mean).any()]


def _picture(plan: StudyPlan, band: TimeBand) -> StudyPicture:
    one = band.interest
    channels = list(enumerate(one.channels))[:MOST_PANELS]
    has_lines = len(band.lines) > 1

    def draw(figure: Any) -> None:
        panels = figure.subplots(len(channels), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (k, label) in zip(panels, channels, strict=True):
            colour = COLOURS[k % len(COLOURS)]
            panel.fill_between(band.times, band.low[k], band.high[k], color=colour, alpha=0.2, linewidth=0)
            if has_lines:
                for place, (value, values) in enumerate(band.lines):
                    shade = _shade(place / (len(band.lines) - 1))
                    panel.plot(band.times, values[k], color=shade, linewidth=0.9, label=f"{value:.4g}")
            else:
                panel.plot(band.times, band.mean[k], STYLES[0], color=colour)
            panel.set_ylabel(value_label(one, label))
            panel.set_xlim(float(band.times[0]), float(band.times[-1]))
        panels[-1].set_xlabel("t in s")
        if has_lines:
            legend = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.25), "ncols": len(band.lines)}
            panels[-1].legend(title=axis_label(plan, 0), **legend)

    looked_at = f"{band.points} of {plan.points:,} points of the study" if band.points < plan.points else "all points"
    caption = f"The band reaches from the smallest to the largest value of {looked_at}"
    caption += "; lines are some of them." if has_lines else "; the line is their mean."
    height = BAND_HEIGHT * len(channels) + LEGEND_HEIGHT
    return StudyPicture(f"{one.about}, over the time", caption, with_numbered_regions(svg(draw, height)))


def _shade(share: float) -> tuple[float, float, float]:
    """From light to dark along the varied name."""
    light, dark = (0.45, 0.72, 0.90), (0.05, 0.15, 0.45)
    red, green, blue = (a + share * (b - a) for a, b in zip(light, dark, strict=True))
    return red, green, blue
