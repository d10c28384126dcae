"""Charts drawn by Matplotlib as SVG text: no display, no date, no random identifiers."""

from __future__ import annotations

import re
from io import StringIO
from typing import Any

STYLES = ("-", "--", "-.", ":")
# Okabe and Ito's palette: told apart with every common colour blindness, and by dashes in black and white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
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
# The width of a chart, in inches.
FIGURE_WIDTH = 6.4


def svg(draw: Any, height: float) -> str:
    """Draws without a display and without pyplot's global state."""
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(FIGURE_WIDTH, height), layout="constrained")
        FigureCanvasSVG(figure)
        draw(figure)
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines()) + "\n"


def with_numbered_regions(text: str) -> str:
    """SVG with clip regions numbered: their usual names hash the last bits of a layout, which differ between runs."""
    names = dict.fromkeys(re.findall(r'<clipPath id="(\w+)">', text))
    for number, name in enumerate(names):
        text = text.replace(name, f"region{number}")
    return text
