"""Charts of a path as SVG text: coordinates (Fig. 5), determinants with their zeros (Fig. 6), inputs (Fig. 7)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from symgen.model.model import Model
from symgen.naming import GREEK
from symgen.paths.drawing import COLOURS, STYLES, svg
from symgen.paths.figures import FigureData
from symgen.paths.path_equations import Array

# Inches: the height of a panel, and what the labels of the times take below the last one.
PANEL_HEIGHT, TIMES_HEIGHT = 2.1, 0.35
GREY = "#888888"


@dataclass(frozen=True, slots=True)
class Line:
    """One curve: its values at the times of the chart, where it is zero, and its entry in the legend."""

    label: str
    values: Array
    zeros: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Panel:
    """Curves on common axes; `verticals` and `threshold` are dashed lines, which `note` explains in the legend."""

    label: str
    lines: tuple[Line, ...]
    title: str = ""
    verticals: tuple[float, ...] = ()
    threshold: float | None = None
    note: str = ""
    from_zero: bool = False


def charts(model: Model, data: FigureData) -> dict[str, str]:
    """SVG text by chart name: `coordinates`, `determinants` (where m ≥ δ), `inputs` (where there are any).

    The same data give the same text: no date, no random identifiers.
    """
    return {name: _drawn(data.trajectory.t, panels) for name, panels in panels_of(model, data).items()}


def panels_of(model: Model, data: FigureData) -> dict[str, tuple[Panel, ...]]:
    """What the charts show, by their names."""
    panels = {"coordinates": _coordinates(model, data)}
    if data.curves:
        panels["determinants"] = (_determinants(model, data),)
    if model.inputs:
        panels["inputs"] = _inputs(model, data)
    return panels


def _drawn(times: Array, panels: Sequence[Panel]) -> str:
    return svg(lambda figure: draw_panels(figure, times, panels), PANEL_HEIGHT * len(panels) + TIMES_HEIGHT)


def draw_panels(figure: Any, times: Array, panels: Sequence[Panel]) -> None:
    """Panels one below the other over `times` (s), with legends beside them."""
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axis, panel in zip(axes, panels, strict=True):
        for k, line in enumerate(panel.lines):
            colour = COLOURS[k % len(COLOURS)]
            # curves are interrupted where they have no value
            values = np.where(np.isfinite(line.values), line.values, np.nan)
            axis.plot(times, values, STYLES[k % len(STYLES)], color=colour, label=line.label)
            if line.zeros:
                axis.plot(line.zeros, [0.0] * len(line.zeros), "^", color=colour, clip_on=False, zorder=3)
        dashed = {"color": GREY, "linestyle": ":", "linewidth": 1.0}
        for t in panel.verticals:
            axis.axvline(t, **dashed)
        if panel.threshold is not None:
            axis.axhline(panel.threshold, **dashed)
        if panel.note:
            axis.plot([], [], label=panel.note, **dashed)
        axis.set_ylabel(panel.label)
        axis.set_xlim(float(times[0]), float(times[-1]))
        if panel.from_zero:
            axis.set_ylim(bottom=0.0)
        axis.ticklabel_format(axis="y", scilimits=(-3, 5), useMathText=True)
        axis.legend(title=panel.title or None, loc="center left", bbox_to_anchor=(1.01, 0.5), alignment="left")
    axes[-1].set_xlabel("time in s")


def _coordinates(model: Model, data: FigureData) -> tuple[Panel, ...]:
    columns = [
        (coordinate.name, coordinate.unit or "", data.trajectory.q[:, i])
        for i, coordinate in enumerate(model.coordinates)
    ]
    return _by_unit(data, columns, "coordinates")


def _inputs(model: Model, data: FigureData) -> tuple[Panel, ...]:
    columns = [(actuator.name, actuator.unit or "", data.u[:, i]) for i, actuator in enumerate(model.inputs)]
    return _by_unit(data, columns, "inputs")


def _by_unit(data: FigureData, columns: Sequence[tuple[str, str, Array]], what: str) -> tuple[Panel, ...]:
    """One panel per unit, in the order in which the units first occur; singular times marked on each."""
    units = list(dict.fromkeys(unit for _, unit, _ in columns))
    zeros = tuple(sorted({t for curve in data.curves for t in curve.zeros}))
    return tuple(
        Panel(
            f"{what} in {_unit(unit)}" if unit else what,
            tuple(Line(symbol(name), values) for name, own_unit, values in columns if own_unit == unit),
            verticals=zeros,
            note="zeros of the\ndeterminants" if zeros and unit == units[-1] else "",
        )
        for unit in units
    )


def _determinants(model: Model, data: FigureData) -> Panel:
    several = len(data.curves) > 1
    control = r"\tilde{M}" + ("_1" if several else "")
    lines = (
        Line(", ".join(symbol(model.inputs[j].name) for j in curve.inputs), curve.values, curve.zeros)
        for curve in data.curves
    )
    return Panel(
        rf"$\det\,{control}^{{\mathsf{{T}}}}{control}$",
        tuple(lines),
        title="inputs",
        threshold=data.threshold if several else None,
        note="threshold of\nswitching (28)" if several else "",
        from_zero=True,
    )


def symbol(name: str) -> str:
    """A name of the model file as a formula of Matplotlib: `theta_1` and `theta1` become θ with index 1."""
    match = re.fullmatch(r"([A-Za-z]+?)_?(\d+|(?<=_)\w+)?", name)
    base, index = match.groups() if match else (name, None)
    letter = GREEK.get(base, base)
    upright, spaced = letter.replace("_", r"\_"), (index or "").replace("_", r"\ ")
    source = rf"\mathit{{{letter}}}" if len(letter) == 1 else rf"\mathrm{{{upright}}}"
    lowered = rf"_{{\mathrm{{{spaced}}}}}" if index else ""
    return f"${source}{lowered}$"


def _unit(unit: str) -> str:
    return unit.replace("**2", "²").replace("**3", "³").replace("*", "·")
