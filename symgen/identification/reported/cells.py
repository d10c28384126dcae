"""Tables of the report of an identification, and how numbers and units stand in them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from symgen.report.document import Table


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> Table:
    """One whose first column takes the room that is left."""
    cells = tuple(tuple((cell,) if cell else () for cell in row) for row in rows)
    return Table(tuple((heading,) for heading in headings), cells, (1, *(0 for _ in headings[1:])))


def numbers(*given: float) -> tuple[str, ...]:
    """Four digits, and a dash for what is open."""
    return tuple("–" if x != x else f"{x:.4g}" for x in given)


def unit_words(unit: str) -> str:
    """A unit with raised powers."""
    return unit.replace("**2", "²").replace("**3", "³").replace("*", " ")
