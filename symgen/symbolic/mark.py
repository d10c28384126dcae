"""Where a graph stands at a moment, so that what is made later can be let go of."""

from __future__ import annotations

from typing import NamedTuple


class Mark(NamedTuple):
    """How many scalars, keys of scalars and products taken apart there are."""

    scalars: int
    keys: int
    products: int


# That of a graph that nothing is made on yet.
START = Mark(0, 0, 0)
