"""A motion under control as CSV, as a chart and as a summary."""

from __future__ import annotations

from collections.abc import Sequence
from io import StringIO

import matplotlib as mpl
from matplotlib.figure import Figure

from symgen.model.model import Model
from symgen.paths.drawing import COLOURS, FIGURE_WIDTH, STYLE, STYLES
from symgen.simulate.tables import CURVES_HEIGHT, MOST_CURVES
from symgen.simulate.tracking import TrackedMotion


def tracking_csv(model: Model, tracked: TrackedMotion) -> str:
    """One line a frame: t, coordinates, rates, what was planned of the coordinates, inputs."""
    names = [c.name for c in model.coordinates]
    planned = [f"{name}_planned" for name in names]
    header = ("t", *names, *(c.rate for c in model.coordinates), *planned, *(i.name for i in model.inputs))
    motion = tracked.motion
    rows = zip(motion.times, motion.q, motion.qd, tracked.planned, tracked.inputs, strict=True)
    lines = [",".join(header)]
    for time, *parts in rows:
        lines.append(",".join(f"{value:.12g}" for value in (time, *(x for part in parts for x in part))))
    return "\n".join(lines) + "\n"


def tracking_chart(model: Model, tracked: TrackedMotion) -> str:
    """SVG: errors of coordinates by unit, planned minus actual, and the inputs by unit."""
    motion = tracked.motion
    errors = [
        [a - b for a, b in zip(planned, q, strict=True)] for planned, q in zip(tracked.planned, motion.q, strict=True)
    ]
    panels = [
        *_panels("error", [(c.name, c.unit) for c in model.coordinates], errors),
        *_panels("inputs", [(i.name, i.unit) for i in model.inputs], tracked.inputs),
    ]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(FIGURE_WIDTH, CURVES_HEIGHT * len(panels)), layout="constrained")
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for axis, (title, curves) in zip(axes, panels, strict=True):
            for k, (name, curve) in enumerate(curves[:MOST_CURVES]):
                style, colour = STYLES[k % len(STYLES)], COLOURS[k % len(COLOURS)]
                axis.plot(motion.times, curve, style, color=colour, label=name)
            axis.set_ylabel(title)
            axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        axes[-1].set_xlabel("time in s")
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def tracking_summary(model: Model, tracked: TrackedMotion) -> list[str]:
    """How far it was from what was planned, and what the drives did."""
    lines = [f"{model.name}: {tracked.motion.times[-1]:g} s in {tracked.samples} samples"]
    for unit in dict.fromkeys(c.unit or "1" for c in model.coordinates):
        errors = [
            (x, c.name) for x, c in zip(tracked.largest, model.coordinates, strict=True) if (c.unit or "1") == unit
        ]
        largest, name = max(errors)
        lines.append(f"  error in {unit:14} {largest: .3e} at most ({name})")
    if tracked.held:
        lines.append(f"  no result at {tracked.held} samples: the inputs stayed as they were")
    if tracked.saturated:
        lines.append(f"  a drive at its limit at {tracked.saturated} samples")
    return lines


def _panels(
    what: str, named: Sequence[tuple[str, str | None]], rows: Sequence[Sequence[float]]
) -> list[tuple[str, list[tuple[str, list[float]]]]]:
    """By unit a title, and the curves with their names."""
    panels: dict[str, list[tuple[str, list[float]]]] = {}
    for k, (name, unit) in enumerate(named):
        panels.setdefault(unit or "1", []).append((name, [row[k] for row in rows]))
    return [(f"{what} in {unit}", curves) for unit, curves in panels.items()]
