"""A motion as CSV and as a chart."""

from __future__ import annotations

from io import StringIO

import matplotlib as mpl
from matplotlib.figure import Figure

from symgen.model.model import Model
from symgen.paths.drawing import COLOURS, FIGURE_WIDTH, STYLE, STYLES
from symgen.simulate.integrate import SimulatedMotion

# Inches that the chart of one panel is high.
CURVES_HEIGHT = 2.4
# Curves that one panel shows: those of the first coordinates.
MOST_CURVES = 8


def motion_csv(model: Model, motion: SimulatedMotion) -> str:
    """One line a frame: t, coordinates, rates, T, U and the largest violation of a constraint."""
    names = [c.name for c in model.coordinates], [c.rate for c in model.coordinates]
    lines = [",".join(("t", *names[0], *names[1], "kinetic_energy", "potential_energy", "constraint_violation"))]
    rows = zip(motion.times, motion.q, motion.qd, motion.energy, motion.residual, strict=True)
    for time, q, qd, energy, residual in rows:
        lines.append(",".join(f"{value:.12g}" for value in (time, *q, *qd, *energy, residual)))
    return "\n".join(lines) + "\n"


def motion_chart(model: Model, motion: SimulatedMotion) -> str:
    """SVG: coordinates by unit, energies, and the violation of the constraints where there are any."""
    units = list(dict.fromkeys(c.unit or "1" for c in model.coordinates))
    panels = [(f"coordinates in {unit}", [i for i, c in enumerate(model.coordinates) if (c.unit or "1") == unit])
              for unit in units]
    geometric = any(row.kind == "geometric" for row in model.constraints)
    with mpl.rc_context(STYLE):
        count = len(panels) + 1 + geometric
        figure = Figure(figsize=(FIGURE_WIDTH, CURVES_HEIGHT * count), layout="constrained")
        axes = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
        for axis, (title, members) in zip(axes, panels, strict=False):
            for k, i in enumerate(members[:MOST_CURVES]):
                curve = [q[i] for q in motion.q]
                label = model.coordinates[i].name
                axis.plot(motion.times, curve, STYLES[k % len(STYLES)], color=COLOURS[k % len(COLOURS)], label=label)
            axis.set_ylabel(title)
            axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        energies = axes[len(panels)]
        first = sum(motion.energy[0])
        energies.plot(motion.times, [t + u - first for t, u in motion.energy], color=COLOURS[0], label="T + U")
        energies.set_ylabel("energy gained")
        energies.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        if geometric:
            axes[-1].semilogy(motion.times, [max(r, 1e-18) for r in motion.residual], color=COLOURS[1], label="max |g|")
            axes[-1].set_ylabel("constraints")
            axes[-1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        axes[-1].set_xlabel("time in s")
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()
