"""What the witness says: numbers beside the truth, and what is wrong with files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from symgen.laboratory.zoo.witness.coverage import Coverage


@dataclass(frozen=True)
class Finding:
    """A number that is wrong, or a status that is not honest."""

    kind: str
    text: str


@dataclass(frozen=True)
class CheckResult:
    """What was compared, the largest error in units of what is allowed, and what is wrong."""

    coverage: Coverage
    largest: float
    findings: tuple[Finding, ...]

    @property
    def states(self) -> int:
        """At how many states."""
        return self.coverage.states


@dataclass(frozen=True)
class Truth:
    """A quantity at a state, and how well the state determines it, 0 to 1.

    `stray` is how far rows that depend on others are from doing so: two truths may be so far apart.
    """

    value: list[Any]
    clear: float
    stray: float


@dataclass(frozen=True)
class JudgedResult:
    """One result beside the truth: a status, or the error in units of what is allowed and relative to the truth.

    `clear` is how well the state determines the result; where that is `certain` there is no reason for the status.
    """

    status: int
    units: float
    relative: float
    clear: float
    certain: bool
