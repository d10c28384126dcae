"""What an elimination did to its unknowns, to find those that it started from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from symgen.records import dataclass
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class TurnedUnknowns:
    """Two unknowns that were replaced by their components along and across (cosine, sine)."""

    first: int
    second: int
    cosine: Scalar
    sine: Scalar


@dataclass(frozen=True, slots=True)
class SolvedUnknown:
    """An unknown that a row was solved for."""

    name: int
    value: Scalar


Step: TypeAlias = TurnedUnknowns | SolvedUnknown


def taken_back(
    steps: Sequence[Step], left: Mapping[int, Scalar], zero: Scalar, homogeneous: bool
) -> dict[int, Scalar]:
    """All unknowns, given those that were `left`; with right-hand sides of 0 where `homogeneous`."""
    unknowns = dict(left)
    for step in reversed(steps):
        if isinstance(step, TurnedUnknowns):
            x, y = (unknowns.get(name, zero) for name in (step.first, step.second))
            unknowns[step.first] = step.cosine * x - step.sine * y
            unknowns[step.second] = step.sine * x + step.cosine * y
        else:
            unknowns[step.name] = zero if homogeneous else step.value
    return unknowns
