"""How far results are from the truth, of which so many digits are known."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

# The truth is known to so much where it is looked at.
KNOWN = 1e-40


def norm(values: Sequence[float]) -> float:
    """The length of a vector."""
    return math.sqrt(math.fsum(x * x for x in values))


def distance(values: Sequence[Any], exact: Sequence[Any]) -> float:
    """Between numbers and the middle of what is known of the truth."""
    return norm([float((x - y).mid()) for x, y in zip(exact, values, strict=True)])


def least_distance(values: Sequence[float], exact: Sequence[Any]) -> float:
    """Between numbers and what is known of the truth: 0 is right where that is 0 to a hundred digits.

    Numbers are held against the middle of what is known less well.
    """
    if any(float(x.rad()) > KNOWN for x in exact):
        return distance(values, exact)
    return norm([float((x - y).abs_lower()) for x, y in zip(exact, values, strict=True)])
