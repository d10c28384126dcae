"""Line charts over time as SVG text: panels one below the other, legends beside them.

Written directly: a plotting library takes longer to load than a model takes to be derived and verified.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from symgen.paths.path_equations import Array

FONT = "'New Computer Modern', 'Latin Modern Roman', serif"
# The size of letters, in points.
SIZE = 9.5
# The width of a chart, in points: as wide as a text of A4.
CHART_WIDTH = 461.0
# Room in points left of a panel, above the first one, between two, and below the last one.
LEFT_MARGIN, TOP_MARGIN, PANEL_GAP, BOTTOM_MARGIN = 56.0, 14.0, 20.0, 34.0
LETTER = 0.52 * SIZE  # mean width
# Ticks of an axis, at least.
FEWEST_TICKS = 4
# Of their size: curves that vary less are drawn as constants.
FLAT = 1e-9
GREY, FAINT, DARK = "#888888", "#DDDDDD", "#555555"
DASHES = ("", "6 2.5", "8 2.5 1.6 2.5", "1.6 2.6")
# Okabe and Ito's palette: told apart with every common colour blindness, and by dashes in black and white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")


@dataclass(frozen=True, slots=True)
class Label:
    """A text as SVG (`source`, escaped) and about how many letters wide it is."""

    source: str
    letters: float


@dataclass(frozen=True, slots=True)
class Line:
    """One curve: its values at the times of the chart, where it is zero, and its entry in the legend."""

    label: Label
    values: Array
    zeros: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Panel:
    """Curves on common axes; `verticals` and `threshold` are dashed lines, which `note` explains below the legend."""

    label: Label
    lines: tuple[Line, ...]
    title: str = ""
    verticals: tuple[float, ...] = ()
    threshold: float | None = None
    note: tuple[str, ...] = ()
    from_zero: bool = False


@dataclass(frozen=True, slots=True)
class _PanelArea:
    """Where a panel lies on the page, and the ranges of its axes."""

    left: float
    right: float
    top: float
    bottom: float
    times: tuple[float, float]
    values: tuple[float, float]

    def x(self, t: float) -> float:
        low, high = self.times
        return self.left + (t - low) / (high - low) * (self.right - self.left)

    def y(self, value: float) -> float:
        low, high = self.values
        return self.bottom - (value - low) / (high - low) * (self.bottom - self.top)


def plain(text: str) -> Label:
    """A label in upright letters."""
    return Label(escape(text), len(text))


def line_chart(times: Array, panels: Sequence[Panel], height: float) -> str:
    """The chart over `times` (s, at least two, growing), each panel `height` points high; the same text every time."""
    beside = max(_room(panel) for panel in panels)
    total = TOP_MARGIN + len(panels) * (height + PANEL_GAP) - PANEL_GAP + BOTTOM_MARGIN
    parts = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_n(CHART_WIDTH)}pt" height="{_n(total)}pt" '
        f'viewBox="0 0 {_n(CHART_WIDTH)} {_n(total)}" font-family="{FONT}" font-size="{SIZE}">',
        f'<rect width="{_n(CHART_WIDTH)}" height="{_n(total)}" fill="white"/>',
    ]
    for position, panel in enumerate(panels):
        top = TOP_MARGIN + position * (height + PANEL_GAP)
        span = float(times[0]), float(times[-1])
        frame = _PanelArea(LEFT_MARGIN, CHART_WIDTH - beside, top, top + height, span, _limits(panel))
        parts += ['<g class="panel">', *_axes(frame, panel, last=position == len(panels) - 1)]
        for k, line in enumerate(panel.lines):
            parts += _curve(frame, times, line, k)
        parts += [*_legend(frame, panel), "</g>"]
    return "\n".join((*parts, "</svg>")) + "\n"


def _room(panel: Panel) -> float:
    """What the legend takes beside the axes."""
    widest = max((line.label.letters + 6 for line in panel.lines), default=0.0)
    return 14.0 + LETTER * max(widest, len(panel.title) + 1, *(len(text) for text in panel.note), 4)


def _limits(panel: Panel) -> tuple[float, float]:
    """The range of the values with a little room, never of width 0."""
    values = [float(v) for line in panel.lines for v in line.values if math.isfinite(v)] or [0.0]
    low, high = min(values), max(values)
    if panel.from_zero:
        return 0.0, 1.06 * max(high, panel.threshold or 0.0) or 1.0
    size = max(abs(low), abs(high))
    margin = 0.05 * (high - low if high - low > FLAT * size else size or 1.0)
    return low - margin, high + margin


def ticks(low: float, high: float) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten in a range, at least four of them."""
    decade = 10.0 ** math.floor(math.log10((high - low) / FEWEST_TICKS))
    step = max(factor * decade for factor in (1, 2, 5) if factor * decade * FEWEST_TICKS <= high - low)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [k * step for k in range(first, last + 1)]


def _power(values: Sequence[float]) -> int:
    """The power of ten that is written beside an axis instead of at every tick."""
    largest = max((abs(v) for v in values), default=0.0)
    exponent = math.floor(math.log10(largest)) if largest else 0
    return exponent if not -3 <= exponent <= 4 else 0


def _axes(frame: _PanelArea, panel: Panel, last: bool) -> Iterator[str]:
    below = frame.bottom + 12
    for t in ticks(*frame.times):
        x = _n(frame.x(t))
        yield _segment(x, _n(frame.top), x, _n(frame.bottom), FAINT, 0.6)
        if last:
            yield _text(x, _n(below), _number(t, 0), "middle")
    marks = ticks(*frame.values)
    power = _power(marks)
    for value in marks:
        y = _n(frame.y(value))
        yield _segment(_n(frame.left), y, _n(frame.right), y, FAINT, 0.6)
        yield _text(_n(frame.left - 4), _n(frame.y(value) + 3), _number(value, power), "end")
    if power:
        scale = f'×10<tspan dy="-3.2" font-size="70%">{_signed(str(power))}</tspan>'
        yield _text(_n(frame.left), _n(frame.top - 4), scale, "start")
    for t in panel.verticals:
        yield _segment(_n(frame.x(t)), _n(frame.top), _n(frame.x(t)), _n(frame.bottom), GREY, 0.7, "1.4 1.4", "zero")
    if panel.threshold is not None:
        y = _n(frame.y(panel.threshold))
        yield _segment(_n(frame.left), y, _n(frame.right), y, GREY, 0.7, "1.4 1.4", "threshold")
    yield _segment(_n(frame.left), _n(frame.top), _n(frame.left), _n(frame.bottom), "black", 0.8)
    yield _segment(_n(frame.left), _n(frame.bottom), _n(frame.right), _n(frame.bottom), "black", 0.8)
    middle = _n((frame.top + frame.bottom) / 2)
    yield f'<text transform="translate(11 {middle}) rotate(-90)" text-anchor="middle">{panel.label.source}</text>'
    if last:
        yield _text(_n((frame.left + frame.right) / 2), _n(frame.bottom + 26), "time in s", "middle")


def _curve(frame: _PanelArea, times: Array, line: Line, k: int) -> Iterator[str]:
    """The curve, interrupted where it has no value, with a triangle at each of its zeros."""
    steps, pen = [], "M"
    for t, value in zip(times, line.values, strict=True):
        if math.isfinite(value):
            steps.append(f"{pen}{_n(frame.x(float(t)))} {_n(frame.y(float(value)))}")
        pen = "L" if math.isfinite(value) else "M"
    colour = COLOURS[k % len(COLOURS)]
    yield f'<path d="{"".join(steps)}" {_stroke(colour, 1.6, DASHES[k % len(DASHES)])} stroke-linejoin="round"/>'
    for t in line.zeros:
        x, y = frame.x(t), frame.y(0.0)
        corners = f"{_n(x)},{_n(y - 3.5)} {_n(x - 3.5)},{_n(y + 3.5)} {_n(x + 3.5)},{_n(y + 3.5)}"
        yield f'<polygon class="zero" points="{corners}" fill="{colour}"/>'


def _legend(frame: _PanelArea, panel: Panel) -> Iterator[str]:
    x, y = frame.right + 8, frame.top + 7
    if panel.title:
        yield _text(_n(x), _n(y), escape(panel.title), "start")
        y += 13
    for k, line in enumerate(panel.lines):
        yield _segment(_n(x), _n(y - 3), _n(x + 18), _n(y - 3), COLOURS[k % len(COLOURS)], 1.6, DASHES[k % len(DASHES)])
        yield _text(_n(x + 23), _n(y), line.label.source, "start")
        y += 13
    for position, text in enumerate(panel.note):
        below = frame.bottom - 10 * (len(panel.note) - 1 - position)
        yield f'<text x="{_n(x)}" y="{_n(below)}" font-size="7.8" fill="{DARK}">{escape(text)}</text>'


def _segment(x1: str, y1: str, x2: str, y2: str, colour: str, width: float, dashes: str = "", kind: str = "") -> str:
    named = f'class="{kind}" ' if kind else ""
    return f'<line {named}x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {_stroke(colour, width, dashes)}/>'


def _stroke(colour: str, width: float, dashes: str) -> str:
    dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
    return f'fill="none" stroke="{colour}" stroke-width="{width}"{dashed}'


def _text(x: str, y: str, source: str, anchor: str) -> str:
    return f'<text x="{x}" y="{y}" text-anchor="{anchor}">{source}</text>'


def _number(value: float, power: int) -> str:
    return _signed(f"{value / 10.0**power:.6g}")


def _signed(text: str) -> str:
    return text.replace("-", "−")


def _n(value: float) -> str:
    """A place on the page to a hundredth of a point."""
    return f"{value:.2f}".rstrip("0").rstrip(".")
