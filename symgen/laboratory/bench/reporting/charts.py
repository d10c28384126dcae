"""Run time against error as SVG text: every candidate, whiskers up to its largest error, the Pareto front."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, log10
from typing import Any

from symgen.laboratory.bench.run import SCALARS, Comparison, MeasuredCandidate
from symgen.paths.drawing import COLOURS, svg, with_numbered_regions

LOOKS = {
    "symgen": (COLOURS[0], "o"),
    "CasADi": (COLOURS[1], "s"),
    "SymPy": (COLOURS[2], "^"),
    "wrenfold": (COLOURS[3], "v"),
    "NumPy": (COLOURS[4], "D"),
    "C": (COLOURS[6], "P"),
}
ROW_HEIGHT, FRAME_HEIGHT, FEWEST_ROWS = 0.165, 0.75, 5  # inches; a panel has a row for every name
TICKS = (1.0, 2.0, 3.0, 5.0, 7.0)  # labelled in every decade of the times
FIRST_LABEL, LABEL_X = 1.0, 1.04
# it starts at the left edge of a name: from its middle it would cross the letters
LEADER = {"arrowstyle": "-", "linewidth": 0.35, "alpha": 0.6, "shrinkA": 1, "shrinkB": 3, "relpos": (0.0, 0.5)}
PYTHON_TITLE = "Python, float64, all states in one call"
SMALLEST, LARGEST = 1e-18, 10.0  # errors are drawn within; an exact result has error 0


def time_against_error(comparison: Comparison) -> str:
    """A panel for the C of each scalar type and one for Python; the same numbers give the same text."""
    groups: dict[str, list[MeasuredCandidate]] = {f"C, {scalar}": [] for scalar in SCALARS}
    groups[PYTHON_TITLE] = []
    for m in comparison.measured:
        groups[PYTHON_TITLE if m.language == "Python" else f"C, {m.scalar}"].append(m)
    panels = [(title, measured) for title, measured in groups.items() if measured]
    heights = [max(len(measured), FEWEST_ROWS) * ROW_HEIGHT + FRAME_HEIGHT for _, measured in panels]

    def draw(figure: Any) -> None:
        axes = figure.subplots(len(panels), 1, squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
        for panel, (title, measured) in zip(axes, panels, strict=True):
            _panel(panel, measured)
            panel.set_title(f"{comparison.task.quantity}: {title}", loc="left", fontsize=9)
        figure.supylabel("relative error: 99 % of the states (mark), largest (line)", fontsize=9)
        axes[-1].set_xlabel("median time of one state in ns")

    return with_numbered_regions(svg(draw, height=sum(heights)))


def _panel(panel: Any, measured: Sequence[MeasuredCandidate]) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    for m in measured:
        colour, marker = LOOKS.get(m.generator, (COLOURS[5], "x"))
        low, high = _drawn(m.errors.percentile_99), _drawn(m.errors.largest)
        panel.plot([m.nanoseconds] * 2, [low, high], color=colour, linewidth=0.8, zorder=2)
        face = colour if m.chosen or m.generator != "symgen" else "white"
        size = 6.5 if m.generator == "symgen" else 5.0
        look = {"color": colour, "markerfacecolor": face, "markersize": size, "linestyle": "none", "zorder": 3}
        panel.plot([m.nanoseconds], [low], marker, **look)
    lowest = min(_drawn(m.errors.percentile_99) for m in measured)
    highest = max(_drawn(m.errors.largest) for m in measured)
    bottom, top = log10(lowest) - 0.4, log10(highest) + 0.4
    panel.set_ylim(10**bottom, 10**top)
    _time_axis(panel, measured)
    front = sorted((m for m in measured if m.on_front), key=lambda m: m.nanoseconds)
    if front:
        xs, ys = [m.nanoseconds for m in front], [_drawn(m.errors.percentile_99) for m in front]
        corners = ([xs[0], *xs, panel.get_xlim()[1]], [10**top, *ys, ys[-1]])
        panel.step(*corners, where="post", color="#555555", linewidth=1.0, linestyle="--", zorder=1)
    _labels(panel, measured, bottom, top)


def _time_axis(panel: Any, measured: Sequence[MeasuredCandidate]) -> None:
    """Numbers, not powers of ten, because all candidates lie within a decade or two."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    times = [m.nanoseconds for m in measured]
    panel.set_xlim(min(times) / 1.15, max(times) * 1.15)
    wide = max(times) > 15 * min(times)
    panel.xaxis.set_major_locator(LogLocator(subs=TICKS[:1] if wide else TICKS))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panel.xaxis.set_minor_formatter(NullFormatter())


def _labels(panel: Any, measured: Sequence[MeasuredCandidate], bottom: float, top: float) -> None:
    """Names in a column beside the panel, in the order of the marks, each tied to its mark."""
    ordered = sorted(measured, key=lambda m: (-_drawn(m.errors.percentile_99), -m.nanoseconds, m.label))
    wanted = [(log10(_drawn(m.errors.percentile_99)) - bottom) / (top - bottom) for m in ordered]
    for m, height in zip(ordered, spread(wanted, 1 / max(len(ordered), FEWEST_ROWS), FIRST_LABEL), strict=True):
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
            arrowprops={"color": colour, **LEADER},
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
