"""Charts of a path as SVG text: coordinates (Fig. 5), determinants with their zeros (Fig. 6), inputs (Fig. 7)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from io import StringIO
from typing import Any

from symgen.model.model import Model
from symgen.paths.figures import FigureData
from symgen.paths.path_equations import Array

# Okabe and Ito's palette: told apart with every common colour blindness, and by line style in black and white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
STYLES = ("-", "--", "-.", ":")
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "mathtext.fontset": "dejavusans",
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.hashsalt": "symgen",
    "svg.fonttype": "path",
}
GREEK = re.compile(
    "alpha|beta|gamma|delta|epsilon|zeta|eta|theta|kappa|lambda|mu|nu|xi|rho|sigma|tau|phi|chi|psi|omega"
)
WIDTH, PANEL_HEIGHT = 6.4, 2.6  # inches
LEGEND_X = 1.01  # beside the axes, where no curve can run


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
    zeros = sorted({t for curve in data.curves for t in curve.zeros})

    def draw(figure: Any) -> None:
        axes = figure.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0]
        for panel, unit in zip(axes, units, strict=True):
            members = [(name, values) for name, own_unit, values in columns if own_unit == unit]
            for k, (name, values) in enumerate(members):
                panel.plot(data.trajectory.t, values, label=_symbol(name), color=_colour(k), linestyle=_line(k))
            for t in zeros:
                panel.axvline(t, color="#888888", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
            panel.set_ylabel(f"{what} in {_unit(unit)}" if unit else what)
            panel.legend(loc="upper left", bbox_to_anchor=(LEGEND_X, 1.0), borderaxespad=0)
        axes[-1].set_xlabel("time in s")
        if zeros:
            _note(axes[-1], "dashed: zeros of\nthe determinants")

    return svg(draw, height=PANEL_HEIGHT * len(units) + 0.2)


def _determinants(model: Model, data: FigureData) -> str:
    def draw(figure: Any) -> None:
        panel = figure.subplots()
        for k, curve in enumerate(data.curves):
            name = ", ".join(_symbol(model.inputs[j].name) for j in curve.inputs)
            panel.plot(data.trajectory.t, curve.values, label=name, color=_colour(k), linestyle=_line(k))
            heights = [0.0] * len(curve.zeros)
            panel.plot(curve.zeros, heights, "^", color=_colour(k), markersize=7, clip_on=False, zorder=5)
        if len(data.curves) > 1:
            panel.axhline(data.threshold, color="#888888", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
            _note(panel, "dashed: threshold\nof switching (28)")
        panel.set_ylim(0, 1.06 * max(float(curve.values.max()) for curve in data.curves) or 1.0)
        panel.set_xlabel("time in s")
        matrix = r"\tilde{M}_1" if len(data.curves) > 1 else r"\tilde{M}"
        panel.set_ylabel(rf"$\det\,{matrix}^{{\mathrm{{T}}}} {matrix}$")
        panel.legend(
            title="inputs", loc="upper left", bbox_to_anchor=(LEGEND_X, 1.0), borderaxespad=0, alignment="left"
        )

    return svg(draw, height=PANEL_HEIGHT + 0.4)


def _note(panel: Any, text: str) -> None:
    """A remark beside the axes, below the legend."""
    panel.annotate(
        text,
        (LEGEND_X, 0.0),
        xycoords="axes fraction",
        xytext=(4, 0),
        textcoords="offset points",
        fontsize=7.5,
        color="#555555",
    )


def _colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def _line(k: int) -> str:
    return STYLES[k % len(STYLES)]


def _symbol(name: str) -> str:
    """A name of the model file as a formula: `theta_1` and `theta1` become θ with index 1."""
    match = re.fullmatch(r"([A-Za-z]+?)_?(\d+|(?<=_)\w+)?", name)
    base, index = match.groups() if match else (name, None)
    letter = f"\\{base}" if GREEK.fullmatch(base) else base if len(base) == 1 else rf"\mathrm{{{base}}}"
    return f"${letter}_{{\\mathrm{{{index.replace('_', ' ')}}}}}$" if index else f"${letter}$"


def _unit(unit: str) -> str:
    return unit.replace("**2", "²").replace("**3", "³").replace("*", "·")


def svg(draw: Any, height: float) -> str:
    """Draws without a display and without pyplot's global state."""
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, height), layout="constrained")
        FigureCanvasSVG(figure)
        draw(figure)
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines()) + "\n"
