"""`symgen excite`: a motion to identify by, printed and written."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from symgen.identification.excitation.charts import excitation_chart
from symgen.identification.excitation.excitation import Excitation, ExcitationRequest, excitation
from symgen.identification.excitation.tables import excitation_csv, excitation_path
from symgen.identification.not_identified import NotIdentifiedError
from symgen.identification.reported.summary import reason_lines, wrapped
from symgen.output.write import write_files

Progress = Callable[[str], None]
# Limits that are printed: those that are nearest.
LIMITS_SHOWN = 4
# Of the nearest limit of rates, accelerations and inputs, the share below which a shorter period is worth a thought.
UNHURRIED = 0.5


def run_excite(path: Path, out: Path, request: ExcitationRequest, quiet: bool, progress: Progress) -> int:
    """Writes excitation.csv, .svg and, where coordinates lead, .paths.yaml into OUT/<model>/; 0, or 1 without a motion.

    Raises ModelError for mistakes in the model file.
    """
    try:
        made = excitation(path, request, progress)
    except NotIdentifiedError as reason:
        progress("")
        print(*reason_lines(f"{path}: no motion: {reason}"), sep="\n", file=sys.stderr)
        return 1
    progress("drawing")
    files: dict[str, str | bytes] = {"excitation.csv": excitation_csv(made), "excitation.svg": excitation_chart(made)}
    if (text := excitation_path(made)) is not None:
        files["excitation.paths.yaml"] = text
    progress("")
    paths = write_files(out / made.model.name, files)
    if not quiet:
        print(*_summary(made), "written:", *(f"  {file}" for file in paths), "", sep="\n")
    return 0


def _summary(made: Excitation) -> Iterator[str]:
    best, half = made.drawn
    yield from wrapped(
        f"{made.model.name}: {made.request.period:g} s, led by {', '.join(made.leading.names)}; condition number "
        f"{made.condition:.3g} of {len(made.shown)} parameters, their columns at unit length; of drawn motions "
        f"{best:.3g} at best, {half:.3g} in the middle",
        "",
    )
    yield ""
    yield "  limits that are nearest"
    for k in np.argsort(-made.shares, kind="stable")[:LIMITS_SHOWN]:
        yield f"    {made.limits.names[k]:<46} {100 * made.shares[k]:5.1f} %"
    yield ""
    for note in _notes(made):
        yield from wrapped(note, "  ")


def _notes(made: Excitation) -> Iterator[str]:
    yield from made.limits.taken
    n, m = made.model.n, made.model.m
    if np.max(made.shares[n : 3 * n + m]) < UNHURRIED:
        yield "rates, accelerations and inputs stay far below their limits: a shorter --period shows more beside noise"
    if made.unseen:
        yield f"no motion shows {', '.join(name.split(' ')[0] for name in made.unseen)} beside the others"
