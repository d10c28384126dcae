"""A designed motion as CSV, and as a path of the model language."""

from __future__ import annotations

import numpy as np

from symgen.identification.excitation.excitation import Excitation
from symgen.identification.excitation.series import HARMONICS

# Names in the path, which no model has.
_PATH, _PHASE = "excitation", "excitation_phase"
# Samples of the path: loops are closed at each.
PATH_SAMPLES = 201


def excitation_csv(made: Excitation) -> str:
    """One line a sample of the period: t, coordinates, rates, accelerations, inputs by the values of the file."""
    coordinates = made.model.coordinates
    names = ["t", *(c.name for c in coordinates), *(c.rate for c in coordinates)]
    names += [*(c.acceleration for c in coordinates), *(one.name for one in made.model.inputs)]
    table = np.column_stack([made.t, made.q, made.qd, made.qdd, made.u])
    return "\n".join([",".join(names), *(",".join(f"{x:.12g}" for x in row) for row in table)]) + "\n"


def excitation_path(made: Excitation) -> str | None:
    """The motion under `paths`, for `symgen simulate --track excitation`; None where the task leads.

    What leads is a series there, too; the other coordinates follow from the constraints.
    """
    if made.leading.given_by == "task":
        return None
    period = made.request.period
    lines = [
        "# to be put into the model file, or under its `paths`: symgen simulate MODEL.yaml --track excitation",
        "paths:",
        f"  {_PATH}:",
        "    description: a motion to identify by, from rest to rest",
        f"    duration: {period:.12g}",
        f"    samples: {PATH_SAMPLES}",
        "    definitions:",
        f"      {_PHASE}: 2*pi*t/{period:.12g}",
        "    conditions:",
    ]
    constants, factors = made.series
    for name, constant, row in zip(made.leading.names, constants, factors, strict=True):
        lines.append(f"      {_PATH}_{name}: >-")
        lines.append(f"        {name} - ({constant:.12g})")
        for function, of in (("sin", row[:HARMONICS]), ("cos", row[HARMONICS:])):
            lines += [f"        - ({x:.12g})*{function}({k}*{_PHASE})" for k, x in enumerate(of, 1)]
    start = ", ".join(f"{c.name}: {x:.12g}" for c, x in zip(made.model.coordinates, made.q[0], strict=True))
    return "\n".join([*lines, f"    start: {{{start}}}"]) + "\n"
