"""Logarithmic axes whose labels are plain text: Matplotlib parses its own as formulas, one by one."""

from __future__ import annotations

from math import log10
from typing import Any

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def logarithmic(axis: Any) -> None:
    """A scale with ticks at powers of ten only."""
    from matplotlib.ticker import FuncFormatter

    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.axes.minorticks_off()
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"10{power(value)}"))


def power(value: float) -> str:
    """The exponent of a power of ten, raised."""
    return str(round(log10(value))).translate(RAISED) if value > 0 else ""
