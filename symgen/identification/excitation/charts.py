"""A designed motion as a chart: coordinates, rates, inputs with their limits, distances from singularities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.excitation.excitation import Excitation
from symgen.identification.excitation.limits import MEASURES
from symgen.paths.drawing import COLOURS, STYLES, svg

# Inches that one panel is high.
MOTION_PANEL_HEIGHT = 1.9
# Curves of one panel: those of the first coordinates or inputs.
MOST_DRAWN_CURVES = 8


def excitation_chart(made: Excitation) -> str:
    """SVG: panels by unit, all over the period; limits are lines of the colour of what they limit."""
    coordinates, inputs = made.model.coordinates, made.model.inputs
    units = [c.unit or "1" for c in coordinates]
    panels = [*_panels("", [c.name for c in coordinates], units, made.q, made.limits.places)]
    rates = [c.rate for c in coordinates]
    panels += _panels("rates, ", rates, [f"{unit}/s" for unit in units], made.qd, made.limits.rates)
    named = [one.name for one in inputs]
    panels += _panels("inputs, ", named, [one.unit or "1" for one in inputs], made.u, made.limits.inputs)
    panels.append(("distance", MEASURES, made.distances, np.stack([made.limits.distances, [np.inf, np.inf]])))
    return svg(lambda figure: _drawn(figure, made.t, panels), MOTION_PANEL_HEIGHT * len(panels))


_Panel = tuple[str, Sequence[str], Array, Array]


def _panels(
    what: str, names: Sequence[str], units: Sequence[str], values: Array, ends: Array
) -> list[_Panel]:
    made: list[_Panel] = []
    for unit in dict.fromkeys(units):
        places = [k for k, other in enumerate(units) if other == unit][:MOST_DRAWN_CURVES]
        title = f"{what}{unit.replace('*', ' ')}"
        made.append((title, [names[k] for k in places], values[:, places], ends[:, places]))
    return made


def _drawn(figure: Any, t: Array, panels: Sequence[_Panel]) -> None:
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axis, (title, names, values, ends) in zip(axes, panels, strict=True):
        for k, name in enumerate(names):
            colour = COLOURS[k % len(COLOURS)]
            axis.plot(t, values[:, k], STYLES[k % len(STYLES)], color=colour, label=name)
        low, high = axis.get_ylim()
        for k, limits in enumerate(ends.T):
            # a limit far away would make the motion a line
            for end in (x for x in limits if low - (high - low) <= x <= high + (high - low)):
                axis.axhline(float(end), color=COLOURS[k % len(COLOURS)], linewidth=0.8, alpha=0.6)
        axis.set_ylabel(title)
        axis.margins(x=0)
        axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    axes[-1].set_xlabel("time in s")
