"""Chart of symgen's own methods as SVG text: error in units against d for u, q_ddot and lambda, by kind of trouble."""

from __future__ import annotations

import math
from typing import Any

from symgen.laboratory.stress.families import Kind
from symgen.laboratory.stress.method_kernels import LABELS
from symgen.laboratory.stress.reporting.axes import logarithmic
from symgen.laboratory.stress.run import Stress
from symgen.laboratory.stress.series import SYMGEN, Series, by_method
from symgen.model.quantities import MAIN, ROWS
from symgen.paths.drawing import COLOURS, svg
from symgen.verify.tolerance import FACTOR

KINDS: tuple[Kind, ...] = ("parameter", "input", "constraint", "mass ratios")
LOWEST, HIGHEST = 0.05, 1e9  # units; a method without a result is drawn at the top
STYLES = ("-", "--", ":", "-.")
PANEL = 1.9


def method_chart(result: Stress) -> str | None:
    """Every method in float64, the worst over the families of a kind; None for a model without such families."""
    kinds = [kind for kind in KINDS if any(family.kind == kind for family in result.families)]
    compared = {series.quantity for series in result.series if series.method in LABELS.values()}
    quantities = [name for name in MAIN if name in compared]
    if not kinds or not quantities:
        return None
    looks = {
        label: (COLOURS[k % len(COLOURS)], STYLES[k // len(COLOURS)]) for k, label in enumerate(LABELS.values())
    }

    def draw(figure: Any) -> None:
        panels = figure.subplots(len(quantities), len(kinds), sharex=True, sharey=True, squeeze=False)
        for row, quantity in zip(panels, quantities, strict=True):
            for panel, kind in zip(row, kinds, strict=True):
                chosen = [i for i, family in enumerate(result.families) if family.kind == kind]
                methods = by_method(result.series, quantity, "float64", chosen)
                for label, (colour, style) in looks.items():
                    if label in methods:
                        _line(panel, methods[label], label.removeprefix("method "), colour, style, 1.0, 2)
                if SYMGEN in methods:
                    _line(panel, methods[SYMGEN], SYMGEN, "#BBBBBB", "-", 3.5, 1)
                panel.axhline(FACTOR, color="#888888", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
            row[0].set_ylabel(f"{ROWS[quantity].symbol}: error over unit")
        for panel, kind in zip(panels[0], kinds, strict=True):
            panel.set_title(kind, fontsize=9, loc="left")
            logarithmic(panel.xaxis)
            logarithmic(panel.yaxis)
            panel.set_ylim(LOWEST, HIGHEST * 3)
            panel.set_xlim(2, 5e-13)
        for panel in panels[-1]:
            panel.set_xlabel("d", labelpad=0)
        shown: dict[str, Any] = {}
        for panel in panels.ravel():
            shown |= {label: line for line, label in zip(*panel.get_legend_handles_labels(), strict=True)}
        figure.legend(list(shown.values()), list(shown), loc="outside lower center", ncols=6, fontsize=7.5)

    return svg(draw, height=PANEL * len(quantities) + 0.7)


def _line(panel: Any, series: Series, label: str, colour: str, style: str, width: float, order: int) -> None:
    heights = [min(max(e.units, LOWEST), HIGHEST) if math.isfinite(e.units) else HIGHEST for e in series.errors]
    panel.plot(
        [e.distance for e in series.errors], heights, label=label, color=colour, linestyle=style, linewidth=width,
        zorder=order,
    )
