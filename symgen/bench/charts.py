"""Run time against error as SVG text: every candidate, whiskers up to its largest error, the Pareto front."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, log10
from typing import Any

from symgen.bench.run import SCALARS, Comparison, Measured
from symgen.paths.charts import COLOURS, svg

LOOKS = {
    "symgen": (COLOURS[0], "o"),
    "CasADi": (COLOURS[1], "s"),
    "SymPy": (COLOURS[2], "^"),
    "wrenfold": (COLOURS[3], "v"),
    "NumPy": (COLOURS[4], "D"),
    "C": (COLOURS[6], "P"),
}
PANEL_HEIGHT = 3.1  # inches
LABEL_SPACING = 0.058  # of a panel's height
FIRST_LABEL, LABEL_X = 1.0, 1.04
SMALLEST, LARGEST = 1e-18, 10.0  # errors are drawn within; an exact result has error 0


def time_against_error(comparison: Comparison) -> str:
    """One panel for each scalar type; the same numbers give the same text."""
    panels = [(scalar, [m for m in comparison.measured if m.scalar == scalar]) for scalar in SCALARS]

    def draw(figure: Any) -> None:
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for panel, (scalar, measured) in zip(axes, panels, strict=True):
            _panel(panel, measured)
            panel.set_title(f"{comparison.task.quantity}, {scalar}", loc="left", fontsize=9)
            panel.set_ylabel("relative error: 99 % (mark), largest")
        axes[-1].set_xlabel("median time of one call in ns; Python: of one state in a batch")

    return svg(draw, height=PANEL_HEIGHT * len(panels) + 0.3)


def _panel(panel: Any, measured: Sequence[Measured]) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    for m in measured:
        colour, marker = LOOKS.get(m.generator, (COLOURS[5], "x"))
        low, high = _drawn(m.errors.percentile_99), _drawn(m.errors.largest)
        panel.plot([m.nanoseconds] * 2, [low, high], color=colour, linewidth=0.8, zorder=2)
        face = colour if m.chosen or m.generator != "symgen" else "white"
        size = 6.5 if m.generator == "symgen" else 5.0
        panel.plot(
            [m.nanoseconds], [low], marker, color=colour, markerfacecolor=face, markersize=size, linestyle="none", zorder=3
        )
    front = sorted((m for m in measured if m.on_front), key=lambda m: m.nanoseconds)
    if front:
        xs, ys = [m.nanoseconds for m in front], [_drawn(m.errors.percentile_99) for m in front]
        end = max(m.nanoseconds for m in measured) * 1.3
        panel.step([*xs, end], [*ys, ys[-1]], where="post", color="#555555", linewidth=1.0, linestyle="--", zorder=1)
    lowest = min(_drawn(m.errors.percentile_99) for m in measured)
    highest = max(_drawn(m.errors.largest) for m in measured)
    bottom, top = log10(lowest) - 0.4, log10(highest) + 0.4
    panel.set_ylim(10**bottom, 10**top)
    _labels(panel, measured, bottom, top)


def _labels(panel: Any, measured: Sequence[Measured], bottom: float, top: float) -> None:
    """Names in a column beside the panel, in the order of the marks, each tied to its mark."""
    ordered = sorted(measured, key=lambda m: (-_drawn(m.errors.percentile_99), -m.nanoseconds, m.label))
    wanted = [(log10(_drawn(m.errors.percentile_99)) - bottom) / (top - bottom) for m in ordered]
    for m, height in zip(ordered, spread(wanted, LABEL_SPACING, FIRST_LABEL), strict=True):
        colour, _ = LOOKS.get(m.generator, (COLOURS[5], "x"))
        panel.annotate(
            m.label,
            (m.nanoseconds, _drawn(m.errors.percentile_99)),
            xycoords="data",
            xytext=(LABEL_X, height),
            textcoords="axes fraction",
            fontsize=6.5,
            color=colour,
            fontweight="bold" if m.chosen else "normal",
            verticalalignment="center",
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.35, "alpha": 0.6, "shrinkB": 3},
        )


def spread(wanted: Sequence[float], spacing: float, top: float) -> list[float]:
    """Falling heights near the falling `wanted` ones, `spacing` apart at least, not above `top`, within [0, top]
    as far as there is room."""
    placed: list[float] = []
    for height in wanted:
        placed.append(min(height, placed[-1] - spacing if placed else top))
    lowest = 0.0
    for k in reversed(range(len(placed))):
        if placed[k] >= lowest:
            break
        placed[k] = lowest
        lowest += spacing
    return placed


def _drawn(error: float) -> float:
    return min(max(error, SMALLEST), LARGEST) if isfinite(error) else LARGEST
