"""Pictures of a study as SVG: curves with bands over one axis, maps over two, else scatter plots."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from symgen.drawing.sketch import MachineSketch
from symgen.paths.drawing import COLOURS, STYLES, svg, with_numbered_regions
from symgen.study.asked.request import GRID, MOTOR_TORQUE, SINGULARITY
from symgen.study.chunks import Array
from symgen.study.interest import CHOICE, Interest, interests
from symgen.study.plan import StudyPlan
from symgen.study.reductions import MAXIMUM_OF, MEAN_OF, MINIMUM_OF, QUANTILES_OF
from symgen.study.shown.labels import axis_label, value_label
from symgen.study.shown.machine import draw_machine, machine_in_map
from symgen.study.shown.scatter import parallel, scattered, worst_channel

# Inches: the height of a panel with a curve, and of one with a map.
CURVE_HEIGHT, MAP_HEIGHT = 1.9, 3.0
# Axes up to which scatter plots are made of all pairs; more are drawn as parallel coordinates.
MOST_PAIRED_AXES = 4
# Colours of a map, and lines of equal values, about as many.
MAP_LEVELS, MAP_LINES = 16, 8
# Panels of a picture: further channels are in the data.
MOST_PANELS = 8


@dataclass(frozen=True, slots=True)
class StudyPicture:
    """A picture with what it shows."""

    title: str
    caption: str
    text: str


@dataclass(frozen=True, slots=True)
class _ShownChannel:
    """A channel of a quantity of interest over the points: what is bad about it, and where it can be the band of its
    states."""

    label: str
    values: Array
    bands: tuple[tuple[Array, Array], ...] = ()


def study_pictures(plan: StudyPlan, results: Any) -> list[StudyPicture]:
    """All pictures of the results, an xarray Dataset."""
    made = []
    machine = machine_in_map(plan)
    for one in interests(plan):
        if one.name == MOTOR_TORQUE:  # a table says which of them fit
            continue
        channels = _channels(plan, one, results)[:MOST_PANELS]
        if not any(np.isfinite(channel.values).any() for channel in channels):
            continue
        draw, height, caption = _drawing(plan, one, channels, results, machine)
        made.append(StudyPicture(one.about, caption, with_numbered_regions(svg(draw, height))))
    if curves := _singular_curves(plan, results, machine):
        made.append(curves)
    return made


def _channels(plan: StudyPlan, one: Interest, results: Any) -> list[_ShownChannel]:
    """Channels with the shape of the points."""
    if plan.states == 1:
        return [_ShownChannel(label, values) for label, values in _split(one, results[one.name].values)]
    figures = {
        name: _split(one, results[f"{one.name}_{name}"].values) for name in (MAXIMUM_OF, MINIMUM_OF, MEAN_OF)
    }
    channels = []
    for k, (label, high) in enumerate(figures[MAXIMUM_OF]):
        low, mean = figures[MINIMUM_OF][k][1], figures[MEAN_OF][k][1]
        bands = [(low, high)]
        if len(plan.request.quantiles) > 1:
            levels = _split(one, np.moveaxis(results[f"{one.name}_{QUANTILES_OF}"].values, -1, 0))[k][1]
            bands.append((levels[0], levels[-1]))
        shown = _smallest_magnitude(low, high) if one.smallest else np.maximum(np.abs(low), np.abs(high))
        channels.append(_ShownChannel(label, mean if len(plan.over) == 1 else shown, tuple(bands)))
    return channels


def _smallest_magnitude(low: Array, high: Array) -> Array:
    """Of values between two bounds: 0 where these have different signs."""
    return np.where(low * high <= 0, 0.0, np.minimum(np.abs(low), np.abs(high))) + 0.0 * low


def _split(one: Interest, values: Array) -> list[tuple[str, Array]]:
    """Label and values of each channel, which are the last axis."""
    if not one.dimension:
        return [("", values)]
    return [(label, values[..., k]) for k, label in enumerate(one.channels)]


def _drawing(
    plan: StudyPlan, one: Interest, channels: Sequence[_ShownChannel], results: Any, machine: MachineSketch | None
) -> tuple[Callable[[Any], None], float, str]:
    """What draws a picture, its height and its caption."""
    gridded = plan.request.sample == GRID
    if gridded and len(plan.over) == 1:
        caption = "The line is the mean along the states of a point, the bands reach to the smallest and the largest"
        caption += " value, and to the outer quantiles." if plan.request.quantiles else " value."
        return (
            lambda figure: _curves(figure, plan, one, channels),
            CURVE_HEIGHT * len(channels) + 0.4,
            caption if plan.states > 1 else "",
        )
    if gridded and len(plan.over) == 2:
        rows = -(-len(channels) // 2) if len(channels) > 1 else 1
        kept = "smallest magnitude" if one.smallest else "largest magnitude"
        caption = f"The {kept} along the states of each point. " if plan.states > 1 else ""
        caption += "" if one.counted else "Lines join equal values"
        caption += "; the thick one is where it vanishes." if one.signed else "" if one.counted else "."
        caption += "" if machine is None else " The machine is drawn where it starts."
        return lambda figure: _maps(figure, plan, one, channels, machine), MAP_HEIGHT * rows, caption
    worst = worst_channel(one, [channel.values for channel in channels])
    if len(plan.over) > MOST_PAIRED_AXES:
        return lambda figure: parallel(figure, plan, one, worst, results), 3.2, "Each line is a point of the study."
    height = 3.0 if len(plan.over) < 3 else 1.7 * (len(plan.over) - 1) + 0.5
    return lambda figure: scattered(figure, plan, one, worst, results), height, "Each dot is a point of the study."


def _curves(figure: Any, plan: StudyPlan, one: Interest, channels: Sequence[_ShownChannel]) -> None:
    axes = figure.subplots(len(channels), 1, sharex=True, squeeze=False)[:, 0]
    axis = plan.over[0].axis
    x = np.linspace(axis.first, axis.last, axis.count or 1)
    for k, (panel, channel) in enumerate(zip(axes, channels, strict=True)):
        colour = COLOURS[k % len(COLOURS)]
        for shade, (low, high) in zip((0.15, 0.3), channel.bands, strict=False):
            panel.fill_between(x, low, high, color=colour, alpha=shade, linewidth=0)
        panel.plot(x, channel.values, STYLES[0], color=colour)
        panel.set_ylabel(value_label(one, channel.label))
        panel.set_xlim(axis.first, axis.last if axis.last > axis.first else axis.first + 1)
    axes[-1].set_xlabel(axis_label(plan, 0))


def _maps(
    figure: Any, plan: StudyPlan, one: Interest, channels: Sequence[_ShownChannel], machine: MachineSketch | None
) -> None:
    columns = 1 if len(channels) == 1 else 2
    panels = figure.subplots(-(-len(channels) // columns), columns, squeeze=False).ravel()
    for panel in panels[len(channels) :]:
        panel.set_axis_off()
    for panel, channel in zip(panels, channels, strict=False):
        _map(figure, panel, plan, channel.values, one)
        if machine is not None:
            draw_machine(panel, machine)
        if channel.label:
            panel.set_title(value_label(one, channel.label), loc="left", fontsize=9)


def _map(figure: Any, panel: Any, plan: StudyPlan, values: Array, one: Interest) -> None:
    """Filled levels with lines between some, and the zeros of what changes its sign; of what is counted, its steps."""
    x, y = (np.linspace(one.axis.first, one.axis.last, one.axis.count or 1) for one in plan.over)
    known = np.ma.masked_invalid(values.T)
    _frame(panel, plan)
    low, high = float(known.min()), float(known.max())
    if low == high:
        panel.text(0.5, 0.5, f"{low:.4g} everywhere", transform=panel.transAxes, ha="center")
        return
    if min(len(x), len(y)) < 2:
        dots = panel.scatter(*np.meshgrid(x, y), c=known, s=8)
        figure.colorbar(dots, ax=panel)
        return
    if one.counted:
        steps = panel.imshow(known, origin="lower", extent=_extent(x, y), aspect=panel.get_aspect())
        bar = figure.colorbar(steps, ax=panel, shrink=0.8, ticks=_numbers(low, high))
        bar.ax.tick_params(labelsize=7)
        return
    changes_sign = one.signed and low < 0 < high
    reach = max(abs(low), abs(high))
    ends = {"vmin": -reach, "vmax": reach, "cmap": "RdBu_r"} if changes_sign else {"cmap": "viridis"}
    filled = panel.contourf(x, y, known, levels=MAP_LEVELS, **ends)
    panel.contour(x, y, known, levels=MAP_LINES, colors="#00000066", linewidths=0.5, linestyles="-")
    if changes_sign:
        panel.contour(x, y, known, levels=[0.0], colors=COLOURS[6], linewidths=1.8)
    bar = figure.colorbar(filled, ax=panel, shrink=0.8 if panel.get_aspect() != "auto" else 1.0)
    bar.ax.tick_params(labelsize=7)


def _extent(x: Array, y: Array) -> tuple[float, float, float, float]:
    """The ends of a picture whose cells have these centres."""
    across, up = ((z[1] - z[0]) / 2 for z in (x, y))
    return x[0] - across, x[-1] + across, y[0] - up, y[-1] + up


def _numbers(low: float, high: float) -> list[int]:
    """Whole numbers between two of them, as many as fit beside a map."""
    step = max(1, round((high - low) / MAP_LINES))
    return list(range(int(low), int(high) + 1, step))


def _frame(panel: Any, plan: StudyPlan) -> None:
    """Labels and limits of a map; of two lengths, or two coordinates of the task, both axes have one scale."""
    panel.set_xlabel(axis_label(plan, 0))
    panel.set_ylabel(axis_label(plan, 1))
    panel.grid(False)
    for limits, one in zip((panel.set_xlim, panel.set_ylim), plan.over, strict=True):
        if one.axis.first < one.axis.last:
            limits(one.axis.first, one.axis.last)
    if all(one.kind == "task" for one in plan.over):
        panel.set_aspect("equal")


def _singular_curves(plan: StudyPlan, results: Any, machine: MachineSketch | None) -> StudyPicture | None:
    """Where each choice of drives is singular, over what all of them together leave."""
    if plan.request.sample != GRID or len(plan.over) != 2 or plan.states > 1 or CHOICE not in results:
        return None
    determinants = results[CHOICE].values
    together = results[SINGULARITY].values[..., 1]
    labels = [str(label) for label in results["drives"].values]
    if len(labels) < 2 or min(determinants.shape[:2]) < 2:
        return None

    def draw(figure: Any) -> None:
        panel = figure.subplots()
        x, y = (np.linspace(one.axis.first, one.axis.last, one.axis.count or 1) for one in plan.over)
        _frame(panel, plan)
        known = np.ma.masked_invalid(together.T)
        filled = panel.contourf(x, y, known, levels=MAP_LEVELS, cmap="Greys_r", alpha=0.5)
        figure.colorbar(filled, ax=panel, shrink=0.8, label="distance from singularities of all inputs together")
        for k, label in enumerate(labels):
            values = np.ma.masked_invalid(determinants[..., k].T)
            colour, style = COLOURS[k % len(COLOURS)], STYLES[k % len(STYLES)]
            if float(values.min()) < 0 < float(values.max()):
                panel.contour(x, y, values, levels=[0.0], colors=colour, linewidths=1.8, linestyles=style)
            panel.plot([], [], style, color=colour, label=label.replace("+", ", "))
        if machine is not None:
            draw_machine(panel, machine)
        panel.legend(title="singular with", loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=min(3, len(labels)))

    nearest = float(np.nanmin(together))
    caption = "Curves are the level sets at which the determinant of a choice of drives vanishes."
    caption += f" With all drives together the distance from singularities is {nearest:.2g} or more at each point."
    return StudyPicture("singular curves of choices of drives", caption, with_numbered_regions(svg(draw, 4.8)))
