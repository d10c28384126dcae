"""The ranges of coordinates that a file states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import Any


class StatedRanges:
    """Those of one file; a coordinate without one may be anywhere."""

    def __init__(self, blocks: Mapping[str, Any], coordinates: Sequence[str]) -> None:
        self._ends = [_ends(blocks, name) for name in coordinates]

    def hold(self, q: Sequence[float]) -> bool:
        """Whether no coordinate is out of its range."""
        return all(low <= x <= high for x, (low, high) in zip(q, self._ends, strict=True))


def _ends(blocks: Mapping[str, Any], name: str) -> tuple[float, float]:
    of_coordinate = (blocks.get("coordinates") or {}).get(name) or {}
    low, high = (blocks.get("ranges") or {}).get(name) or of_coordinate.get("range") or (-inf, inf)
    return float(low), float(high)
