"""What a verification found, as data that goes into certificate.json."""

from __future__ import annotations

from dataclasses import asdict
from math import isfinite
from typing import Any

from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class ErrorRecord:
    """Errors of one quantity on one target over all states, in units of d + eps |y*| (at most 16 is allowed)."""

    quantity: str
    target: str
    states: int
    median: float
    percentile_99: float
    largest: float
    largest_relative: float
    worst_state: int
    refused: int


@dataclass(frozen=True, slots=True)
class InvariantRecord:
    """A law checked on generated results; `largest` is the defect over what the tolerances allow (at most 1)."""

    name: str
    target: str
    states: int
    largest: float


@dataclass(frozen=True, slots=True)
class ConditionRecord:
    """Condition numbers over the states: of B with rows of norm 1, or of F'M with F orthonormal."""

    name: str
    median: float
    largest: float


@dataclass(frozen=True, slots=True)
class Certificate:
    """The result of verifying one model's files.

    `failures` name what is wrong (empty: verified); `notes` what could not be verified and why.
    """

    model: str
    states: int
    ranks: tuple[tuple[str, int], ...]
    errors: tuple[ErrorRecord, ...]
    invariants: tuple[InvariantRecord, ...]
    conditions: tuple[ConditionRecord, ...]
    versions: tuple[tuple[str, str], ...]
    hashes: tuple[tuple[str, str], ...]
    failures: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Whether everything that was checked holds."""
        return not self.failures

    @property
    def targets(self) -> tuple[str, ...]:
        """`C float64`, `C float64 batch`, `Python float64` and so on: what was checked."""
        return tuple(dict.fromkeys(record.target for record in self.errors))

    def worst(self, target: str) -> ErrorRecord:
        """The record with the largest error of a target."""
        return max((record for record in self.errors if record.target == target), key=lambda record: record.largest)

    def to_json(self) -> dict[str, Any]:
        """A JSON-able form, in a fixed order; an infinite error is null."""
        return {
            "model": self.model,
            "passed": self.passed,
            "failures": list(self.failures),
            "notes": list(self.notes),
            "tolerance": _tolerance(),
            "states": self.states,
            "ranks": dict(self.ranks),
            "versions": dict(self.versions),
            "hashes": dict(self.hashes),
            "conditions": [_finite(asdict(record)) for record in self.conditions],
            "invariants": [_finite(asdict(record)) for record in self.invariants],
            "errors": [_finite(asdict(record)) for record in self.errors],
        }


def _finite(record: dict[str, Any]) -> dict[str, Any]:
    return {key: None if isinstance(value, float) and not isfinite(value) else value for key, value in record.items()}


def _tolerance() -> str:
    # imported here: a report reads certificates without the reference
    from symgen.verify.tolerance import FACTOR, PERTURBATIONS

    return (
        f"|y - y*| <= {FACTOR:g} (d + eps |y*|), y* the reference with at least 50 digits, "
        f"d the largest |y*(x + dx) - y*| over {PERTURBATIONS} random dx, |dx_i| = eps |x_i| in all inputs, "
        "parameters and literals, eps = 2^-53 or 2^-24"
    )
