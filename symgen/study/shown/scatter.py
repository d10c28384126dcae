"""Points of a study as dots over pairs of axes, or as lines across parallel ones, coloured by what is worst there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from symgen.paths.drawing import COLOURS
from symgen.study.asked.request import GRID
from symgen.study.chunks import Array
from symgen.study.interest import Interest
from symgen.study.plan import StudyPlan
from symgen.study.shown.labels import axis_label, value_label

# Points that a scatter plot shows; of more, every so many.
MOST_SCATTERED = 1500


def worst_channel(one: Interest, channels: Sequence[Array]) -> Array:
    """Of all channels, each with the shape of the points, the magnitude that is worst at each point."""
    magnitudes = np.abs(np.stack(channels))
    known = np.isfinite(magnitudes)
    ranked = np.where(known, magnitudes, math.inf if one.smallest else -math.inf)
    worst = ranked.min(axis=0) if one.smallest else ranked.max(axis=0)
    return np.where(np.isfinite(worst), worst, np.nan)


def point_values(plan: StudyPlan, results: Any) -> Array:
    """Values of the varied names, points x names."""
    if plan.request.sample == GRID:
        axes = [np.linspace(one.axis.first, one.axis.last, one.axis.count or 1) for one in plan.over]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    return np.stack([results[one.axis.name].values for one in plan.over], axis=-1)


def _points(plan: StudyPlan, worst: Array, results: Any) -> tuple[Array, Array]:
    """Values of the varied names and the worst magnitude at some of the points, the worst drawn last."""
    values = point_values(plan, results)
    step = max(1, -(-len(values) // MOST_SCATTERED))
    chosen, shade = values[::step], worst.ravel()[::step]
    known = np.isfinite(shade)
    order = np.argsort(shade[known], kind="stable")
    return chosen[known][order], shade[known][order]


def scattered(figure: Any, plan: StudyPlan, one: Interest, worst: Array, results: Any) -> None:
    """Dots over each pair of axes, or the worst value over a single axis."""
    values, shade = _points(plan, worst, results)
    count = len(plan.over)
    label = f"worst {value_label(one, '')}"
    if count == 1:
        panel = figure.subplots()
        panel.plot(values[:, 0], shade, ".", color=COLOURS[0], markersize=3)
        panel.set_xlabel(axis_label(plan, 0))
        panel.set_ylabel(label)
        return
    panels = figure.subplots(count - 1, count - 1, squeeze=False)
    for row in range(1, count):
        for column in range(count - 1):
            panel = panels[row - 1, column]
            if column >= row:
                panel.set_axis_off()
                continue
            dots = panel.scatter(values[:, column], values[:, row], c=shade, s=5, linewidths=0)
            if row == count - 1:
                panel.set_xlabel(axis_label(plan, column))
            if column == 0:
                panel.set_ylabel(axis_label(plan, row))
    figure.colorbar(dots, ax=panels, label=label, shrink=0.8)


def parallel(figure: Any, plan: StudyPlan, one: Interest, worst: Array, results: Any) -> None:
    """Each axis upright, scaled to its range; a point is a line across, coloured by what is worst there."""
    from matplotlib import cm, colors

    values, shade = _points(plan, worst, results)
    first, last = (np.array([getattr(of.axis, end) for of in plan.over]) for end in ("first", "last"))
    scaled = (values - first) / np.where(last > first, last - first, 1.0)
    panel = figure.subplots()
    scale = cm.ScalarMappable(colors.Normalize(float(shade.min()), float(shade.max())), "viridis")
    for line, colour in zip(scaled, scale.to_rgba(shade), strict=True):
        panel.plot(range(len(line)), line, color=colour, linewidth=0.5, alpha=0.6)
    panel.set_xticks(range(len(plan.over)), [axis_label(plan, k) for k in range(len(plan.over))])
    panel.set_yticks([0.0, 1.0], ["first", "last"])
    figure.colorbar(scale, ax=panel, label=f"worst {value_label(one, '')}")
