"""Charts of an identification as SVG: measured and predicted inputs, what is left, and its spectrum."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import signal

from symgen.identification.arrays import Array
from symgen.identification.estimates.identification import Identification
from symgen.paths.drawing import COLOURS, svg

# Inches that the chart of a drive is high.
DRIVE_HEIGHT = 5.4
# Samples of a curve beyond which some are left out.
MOST_DRAWN = 1500
# Samples of one spectrum, of which several are averaged.
SPECTRUM_SAMPLES = 256


def drive_chart(made: Identification, drive: int) -> str:
    """SVG: one input."""
    return svg(lambda figure: _drawn(figure, made, drive), DRIVE_HEIGHT)


def _drawn(figure: Any, made: Identification, drive: int) -> None:
    one = made.model.inputs[drive]
    unit = f" in {one.unit.replace('*', ' ')}" if one.unit else ""
    top, middle, bottom = figure.subplots(3, 1, height_ratios=[2, 1, 1.2])
    middle.sharex(top)
    parts = (made.fitted_to, made.aside)
    step = max(1, sum(len(part.t) for part in parts) // MOST_DRAWN)
    for k, part in enumerate(parts):
        known, label = part.known[:, drive], {} if k else {"label": "measured"}
        t, measured = part.t[::step], (part.inputs[:, drive] + known)[::step]
        top.plot(t, measured, color=COLOURS[0], linewidth=1.2, **label)
        predicted = made.predicted(part)[:, drive]
        top.plot(t, predicted[::step], "--", color=COLOURS[1], linewidth=1.2, **({} if k else {"label": "predicted"}))
        middle.plot(t, made.residuals(part)[::step, drive], color=COLOURS[2], linewidth=0.9)
    for axis in (top, middle):
        axis.axvspan(made.aside.t[0], made.aside.t[-1], color="#F2F2F2", label="set aside" if axis is top else None)
        axis.margins(x=0)
    top.set_ylabel(f"{one.name}{unit}")
    top.tick_params(labelbottom=False)
    top.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    middle.set_ylabel("left over")
    middle.set_xlabel("time in s")
    _spectra(bottom, made, drive)


def _spectra(axis: Any, made: Identification, drive: int) -> None:
    part = made.fitted_to
    total = (part.inputs + part.known)[:, drive]
    for values, label, colour in (
        (total, "inputs", COLOURS[0]),
        (made.residuals(part)[:, drive], "left over", COLOURS[2]),
    ):
        frequencies, density = _spectrum(values, made.settings.rate / made.settings.decimation)
        axis.semilogy(frequencies[1:], np.sqrt(density[1:]), color=colour, linewidth=1.2, label=label)
    axis.margins(x=0)
    axis.set_xlabel("frequency in Hz")
    axis.set_ylabel("amplitude / √Hz")
    axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))


def _spectrum(values: Array, rate: float) -> tuple[Array, Array]:
    frequencies, density = signal.welch(values, rate, nperseg=min(SPECTRUM_SAMPLES, len(values)))
    return np.asarray(frequencies), np.asarray(density)
