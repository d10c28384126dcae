"""Charts of a stress run as SVG text: error against d by method, symgen along every family, the long run."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, get_args

from symgen.generation.runnable import SCALARS, STRESSED
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.laboratory.stress.families import Kind
from symgen.laboratory.stress.reporting.axes import logarithmic
from symgen.laboratory.stress.reporting.method_charts import method_chart
from symgen.laboratory.stress.run import Stress
from symgen.laboratory.stress.series import FIXED, PARTITION, SWITCHING, SYMGEN, Series, by_method
from symgen.model.quantities import ROWS
from symgen.paths.drawing import COLOURS, svg
from symgen.verify.tolerance import FACTOR

SYMBOLS = {name: ROWS[name].symbol for name in STRESSED}
# symgen last: drawn on top
LOOKS: Mapping[str, tuple[str, str, str]] = {
    PARTITION: (COLOURS[1], "--", "s"),
    FIXED: (COLOURS[4], "-.", "^"),
    SWITCHING: (COLOURS[2], ":", "v"),
    SYMGEN: (COLOURS[0], "-", "o"),
}
NOTHING = 10.0  # where a method without any result is drawn: an error of more than everything
PANEL = 2.5
DECIMALS = re.compile(r"(\d\d\.\d{2})\d+")  # a hundredth of a point is enough; scales of glyphs stay


def stress_charts(result: Stress) -> dict[str, str]:
    """SVG text by file name."""
    charts = {"stress.svg": _methods(result)}
    if result.families:
        charts["stress.families.svg"] = _families(result)
    if claim_families(result) and any(s.quantity == "inverse_dynamics" for s in result.series):
        charts["stress.claim.svg"] = _claim(result)
    if (methods := method_chart(result)) is not None:
        charts["stress.own_methods.svg"] = methods
    if any(run.time for run in result.runs):
        charts["stress.long_run.svg"] = _long_run(result)
    return {name: DECIMALS.sub(r"\1", text) for name, text in charts.items()}


def claim_families(result: Stress) -> list[int]:
    """The families where a choice of coordinates fails and the mechanism does not; also a choice of inputs, if any."""
    parameter = [i for i, family in enumerate(result.families) if family.kind == "parameter" and family.partitions]
    both = [i for i in parameter if result.families[i].inputs]
    return both or parameter


def _claim(result: Stress) -> str:
    """Error of u against d where a choice fails, in the best conditioned of these families."""

    def floor(index: int) -> float:
        return max(e.relative for e in by_method(result.series, "inverse_dynamics", "float64", [index])[SYMGEN].errors)

    shown = min(claim_families(result), key=floor)

    def draw(figure: Any) -> None:
        panel = figure.subplots()
        _curves(panel, by_method(result.series, "inverse_dynamics", "float64", [shown]), "float64", True)
        panel.set_title(f"towards {result.families[shown].label} = 0, float64", fontsize=9, loc="left")
        panel.set_ylabel("relative error of u")
        panel.set_xlabel("distance d from the singularity")
        panel.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0)

    return svg(draw, height=3.2)


def _methods(result: Stress) -> str:
    """Every quantity in both types along the parameter singularities (all singularities where there are none)."""
    chosen = claim_families(result) or list(range(len(result.families)))
    quantities = [name for name in SYMBOLS if any(s.quantity == name for s in result.series)]

    def draw(figure: Any) -> None:
        panels = figure.subplots(len(quantities), 2, sharex="col", squeeze=False)
        for row, quantity in zip(panels, quantities, strict=True):
            for panel, scalar in zip(row, SCALARS, strict=True):
                _curves(panel, by_method(result.series, quantity, scalar, chosen), scalar)
            row[0].set_ylabel(f"relative error of {SYMBOLS[quantity]}")
        for panel, scalar in zip(panels[0], SCALARS, strict=True):
            panel.set_title(scalar, fontsize=9, loc="left")
        for panel in panels[-1]:
            panel.set_xlabel("distance d")
        handles, labels = panels[0][0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)

    return svg(draw, height=PANEL * 0.8 * len(quantities) + 0.6)


def _curves(panel: Any, methods: Mapping[str, Series], scalar: Scalar, marked: bool = False) -> None:
    eps = float(UNIT_ROUNDOFF[scalar])
    for method, (colour, line, marker) in LOOKS.items():
        if method not in methods:
            continue
        errors = methods[method].errors
        heights = [max(min(e.relative, NOTHING), eps / 30) for e in errors]
        panel.plot(
            [e.distance for e in errors], heights, label=method, color=colour, linestyle=line,
            marker=marker if marked else "",
            markersize=2.6, linewidth=1.2, zorder=3 if method == SYMGEN else 2,
        )
    panel.axhline(eps, color="#888888", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
    logarithmic(panel.xaxis)
    logarithmic(panel.yaxis)
    panel.set_ylim(eps / 50, 3 * NOTHING)
    panel.set_xlim(2, min((e.distance for one in methods.values() for e in one.errors), default=0.1) / 2)


def _families(result: Stress) -> str:
    """symgen's largest error in units of the tolerance along every family, one panel for each kind of trouble."""
    kinds = [kind for kind in get_args(Kind) if any(family.kind == kind for family in result.families)]
    rows = math.ceil(len(kinds) / 2)

    def draw(figure: Any) -> None:
        panels = figure.subplots(rows, 2, sharey=True, squeeze=False).ravel()
        for panel, kind in zip(panels, kinds, strict=False):
            chosen = [i for i, family in enumerate(result.families) if family.kind == kind]
            for k, (quantity, symbol) in enumerate(SYMBOLS.items()):
                for scalar, line in zip(SCALARS, ("-", ":"), strict=True):
                    methods = by_method(result.series, quantity, scalar, chosen)
                    if SYMGEN in methods:
                        _units(panel, methods[SYMGEN], COLOURS[k], line, f"{symbol} {scalar}")
            panel.axhline(FACTOR, color="#888888", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
            logarithmic(panel.xaxis)
            logarithmic(panel.yaxis)
            panel.set_ylim(0.03, 1e3)
            panel.invert_xaxis()
            panel.set_title(kind, fontsize=9, loc="left")
            panel.set_xlabel("d", labelpad=0)
        for panel in panels[len(kinds) :]:
            panel.set_visible(False)
        for panel in panels[::2]:
            panel.set_ylabel("error over unit")
        handles, labels = _all_labels(panels)
        figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=7.5)

    return svg(draw, height=PANEL * 0.8 * rows + 0.8)


def _all_labels(panels: Sequence[Any]) -> tuple[list[Any], list[str]]:
    by_label: dict[str, Any] = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            by_label.setdefault(label, handle)
    return list(by_label.values()), list(by_label)


def _units(panel: Any, series: Series, colour: str, line: str, label: str) -> None:
    heights = [min(max(e.units, 0.03), 1e3) for e in series.errors]
    panel.plot([e.distance for e in series.errors], heights, color=colour, linestyle=line, linewidth=1.1, label=label)


def _long_run(result: Stress) -> str:
    """Drift, tracking error and energy balance over the run, with and without projections."""
    rows = (
        ("position_drift", "|g|"),
        ("rate_drift", "|B q̇|"),
        ("tracking", "tracking error"),
        ("energy", "energy error in J"),
    )
    shown = [(name, label) for name, label in rows if any(any(getattr(run, name)) for run in result.runs)]

    def draw(figure: Any) -> None:
        panels = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (name, label) in zip(panels, shown, strict=True):
            for run in result.runs:
                look = (COLOURS[0], "-") if run.projected else (COLOURS[1], "--")
                values = [x if x > 0 else math.nan for x in getattr(run, name)]
                panel.plot(
                    run.time, values, color=look[0], linestyle=look[1], linewidth=1.1,
                    label="with projections" if run.projected else "without projections",
                )
            values = [x for run in result.runs for x in getattr(run, name) if x > 0]
            if max(values) > 10 * min(values):
                logarithmic(panel.yaxis)
            panel.minorticks_off()
            panel.set_ylabel(label)
        panels[-1].set_xlabel("time in s")
        panels[0].legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0)

    return svg(draw, height=1.5 * len(shown) + 0.6)


