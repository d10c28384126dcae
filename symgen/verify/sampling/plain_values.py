"""What the reference says at a state, as plain floats to the digits of sampling: no result is judged by them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from symgen.verify.reference.reference import Reference, State

# Binary digits that sampling needs.
SAMPLING_BITS = 128
# Of the width of a range: less than this is what searches and projections leave of 0.
SETTLED_REST = 1e-25
PROJECTED = ("admissible_velocity", "admissible_acceleration")


def measured(reference: Reference) -> tuple[str, ...]:
    """What makes a sample of a regular state."""
    return *PROJECTED, *(("inverse_dynamics",) if reference.model.m else ())


def values_at(reference: Reference, state: State, names: Sequence[str]) -> dict[str, tuple[float, ...]]:
    """Row-major entries of quantities, to the digits that sampling needs."""
    return in_floats(reference.matrices(state, names, SAMPLING_BITS))


def in_floats(matrices: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    """Row-major entries by quantity; of projections 0 where nothing else is known."""
    return {name: (_rates if name in PROJECTED else floats)(matrix) for name, matrix in matrices.items()}


def settled(values: Sequence[Any], ranges: Sequence[tuple[Any, Any]]) -> list[float]:
    """Floats, with 0 for what searches and projections leave of it: squares of such rests underflow in float32."""
    pairs = zip(map(float, values), ranges, strict=True)
    return [0.0 if abs(x) < SETTLED_REST * float(high - low) else x for x, (low, high) in pairs]


def floats(matrix: Any) -> tuple[float, ...]:
    """The entries of a matrix."""
    return tuple(map(float, matrix.entries()))


def _rates(matrix: Any) -> tuple[float, ...]:
    """Entries rounded to float64; what cannot be told from 0 is 0, such as the rate of a joint that cannot move."""
    return tuple(0.0 if x.is_finite() and x.contains(0) else float(x) for x in matrix.entries())
