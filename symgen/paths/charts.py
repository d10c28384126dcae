"""Charts of a path as SVG text: coordinates (Fig. 5), determinants with their zeros (Fig. 6), inputs (Fig. 7)."""

from __future__ import annotations

import re
from collections.abc import Sequence

from symgen.model.model import Model
from symgen.naming import GREEK
from symgen.paths.figures import FigureData
from symgen.paths.line_chart import Label, Line, Panel, line_chart, plain
from symgen.paths.path_equations import Array

# The height of a panel, in points.
PANEL_HEIGHT = 148.0


def charts(model: Model, data: FigureData) -> dict[str, str]:
    """SVG text by chart name: `coordinates`, `determinants` (where m ≥ δ), `inputs` (where there are any).

    The same data give the same text: no date, no random identifiers.
    """
    drawn = {"coordinates": _coordinates(model, data)}
    if data.curves:
        drawn["determinants"] = _determinants(model, data)
    if model.inputs:
        drawn["inputs"] = _inputs(model, data)
    return drawn


def _coordinates(model: Model, data: FigureData) -> str:
    columns = [
        (coordinate.name, coordinate.unit or "", data.trajectory.q[:, i])
        for i, coordinate in enumerate(model.coordinates)
    ]
    return _panels(data, columns, "coordinates")


def _inputs(model: Model, data: FigureData) -> str:
    columns = [(actuator.name, actuator.unit or "", data.u[:, i]) for i, actuator in enumerate(model.inputs)]
    return _panels(data, columns, "inputs")


def _panels(data: FigureData, columns: Sequence[tuple[str, str, Array]], what: str) -> str:
    """One panel per unit, in the order in which the units first occur; singular times marked on each."""
    units = list(dict.fromkeys(unit for _, unit, _ in columns))
    zeros = tuple(sorted({t for curve in data.curves for t in curve.zeros}))
    panels = [
        Panel(
            plain(f"{what} in {_unit(unit)}" if unit else what),
            tuple(Line(_symbol(name), values) for name, own_unit, values in columns if own_unit == unit),
            verticals=zeros,
            note=("dashed: zeros of", "the determinants") if zeros and unit == units[-1] else (),
        )
        for unit in units
    ]
    return line_chart(data.trajectory.t, panels, PANEL_HEIGHT)


def _determinants(model: Model, data: FigureData) -> str:
    several = len(data.curves) > 1
    control = '<tspan font-style="italic">M\u0303</tspan>' + (_lowered("1") if several else "")
    transposed = '<tspan font-size="70%" dy="-3.4">T</tspan><tspan dy="3.4">\u2009</tspan>'
    lines = (
        Line(_listed([_symbol(model.inputs[j].name) for j in curve.inputs]), curve.values, curve.zeros)
        for curve in data.curves
    )
    panel = Panel(
        Label(f"det {control}{transposed}{control}", 12),
        tuple(lines),
        title="inputs",
        threshold=data.threshold if several else None,
        note=("dashed: threshold", "of switching (28)") if several else (),
        from_zero=True,
    )
    return line_chart(data.trajectory.t, (panel,), PANEL_HEIGHT + 28)


def _listed(labels: Sequence[Label]) -> Label:
    return Label(", ".join(label.source for label in labels), sum(label.letters + 1 for label in labels))


def _symbol(name: str) -> Label:
    """A name of the model file as a formula: `theta_1` and `theta1` become θ with index 1."""
    match = re.fullmatch(r"([A-Za-z]+?)_?(\d+|(?<=_)\w+)?", name)
    base, index = match.groups() if match else (name, None)
    letter = GREEK.get(base, base)
    source = f'<tspan font-style="italic">{letter}</tspan>' if len(letter) == 1 else letter
    lowered = _lowered(index.replace("_", " ")) if index else ""
    return Label(source + lowered, len(letter) + 0.7 * len(index or ""))


def _lowered(index: str) -> str:
    """An index; an empty step brings what follows back to the line."""
    return f'<tspan font-size="70%" dy="2.2">{index}</tspan><tspan dy="-2.2">\u200a</tspan>'


def _unit(unit: str) -> str:
    return unit.replace("**2", "²").replace("**3", "³").replace("*", "·")
