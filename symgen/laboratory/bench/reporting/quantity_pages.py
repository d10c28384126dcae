"""Every quantity of every model beside the cheapest peer in any form: instructions over instructions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import exp, log
from typing import Any, TypeAlias

from symgen.laboratory.bench.symgen_kernels import LIBRARY, PORTABLE
from symgen.model.quantities import ROWS

Row: TypeAlias = Mapping[str, Any]
# The mean over all cells, and each cell, at most: by whose sine and cosine symgen's kernels have.
GOALS = {LIBRARY: (0.8, 1.0), PORTABLE: (0.65, 0.9)}
TEXT = """## Every quantity

Instructions of symgen's kernel over those of the cheapest peer in any form, float64, statuses included; first with the
C library's sine and cosine on both sides, in brackets with symgen's own. Bold is what is above {0} ({1}). The means
are geometric; the goal for the mean of all is {2} ({3}).

"""


def quantity_section(results: Sequence[Row]) -> str:
    """The section; empty where instructions were not counted."""
    cells = {result["model"]: dict(_cells(result)) for result in results}
    names = [name for name in ROWS if any(name in row for row in cells.values())]
    if not names:
        return ""
    lines = [
        [model, *(_shown(row[name]) if name in row else "" for name in names)] for model, row in cells.items() if row
    ]
    means = [_mean([row[name] for row in cells.values() if name in row]) for name in names]
    every = _mean([cell for row in cells.values() for cell in row.values()])
    lines.append(["geometric mean", *map(_shown, means)])
    head = ["", *(ROWS[name].symbol for name in names)]
    table = [head, ["---"] * len(head), *lines]
    text = TEXT.format(GOALS[LIBRARY][1], GOALS[PORTABLE][1], GOALS[LIBRARY][0], GOALS[PORTABLE][0])
    written = "\n".join(f"| {' | '.join(line)} |" for line in table)
    return f"{text}{written}\n\nAll together: {_shown(every, mean=True)}.\n"


def _cells(result: Row) -> Iterator[tuple[str, dict[str, float]]]:
    for comparison in result["comparisons"]:
        counted = [
            row
            for row in comparison["measured"]
            if row["language"] == "C" and row["scalar"] == "float64" and row["instructions"] is not None
        ]
        own = {way: [r["instructions"] for r in counted if r["chosen"] and way in r["form"]] for way in GOALS}
        peers = [row["instructions"] for row in counted if row["generator"] != "symgen"]
        if own[PORTABLE] and peers:
            # a kernel without angles has one form
            ratios = {way: (own[way] or own[PORTABLE])[0] / min(peers) for way in GOALS}
            yield comparison["quantity"], ratios


def _mean(cells: Sequence[Mapping[str, float]]) -> dict[str, float]:
    return {way: exp(sum(log(cell[way]) for cell in cells) / len(cells)) for way in GOALS}


def _shown(cell: Mapping[str, float], mean: bool = False) -> str:
    place = 0 if mean else 1
    first, second = (
        f"{cell[way]:.2f}" if cell[way] <= GOALS[way][place] else f"**{cell[way]:.2f}**" for way in (LIBRARY, PORTABLE)
    )
    return f"{first} ({second})"
