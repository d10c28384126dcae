"""What a verification found, as data that goes into certificate.json."""

from __future__ import annotations

from dataclasses import asdict
from math import isfinite
from typing import Any

from symgen.ir.kernel import Scalar
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
    """A law checked on generated results; `largest` is the defect over what the tolerances allow (at most 1).

    `quantity` is the one that the law judges.
    """

    name: str
    target: str
    states: int
    largest: float
    quantity: str


@dataclass(frozen=True, slots=True)
class ConditionRecord:
    """Condition numbers over the states: of B with rows of norm 1, or of F'M with F orthonormal."""

    name: str
    median: float
    largest: float


@dataclass(frozen=True, slots=True)
class SearchRecord:
    """At how many states something was looked for in a quantity, and at how many it would be were its kernels short."""

    quantity: str
    looked_for: str
    states: int
    in_full: int


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong: what, with which quantity on which target; both are empty where all of it is.

    `state` is one of the states at which it shows.
    """

    what: str
    quantity: str = ""
    target: str = ""
    state: int = 0

    @property
    def scalar(self) -> Scalar:
        """The scalar type of the target."""
        return "float32" if "float32" in self.target else "float64"

    @property
    def text(self) -> str:
        """The fault as a sentence."""
        place = ", ".join(part for part in (self.target, self.quantity) if part)
        return f"{place}: {self.what}" if place else self.what


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A quantity that is not written in some scalar types, because verification rejects every method of it there.

    `tried` tells each with the reason.
    """

    quantity: str
    scalars: tuple[Scalar, ...]
    tried: tuple[tuple[str, str], ...]
    remedy: str


@dataclass(frozen=True, slots=True)
class Certificate:
    """The result of verifying one model's files.

    `faults` name what is wrong (empty: verified); `notes` what could not be verified and why; `left_out` what was
    asked for and is not among the files.  `states` were drawn, those of `searches` looked at beside them.
    """

    model: str
    states: int
    ranks: tuple[tuple[str, int], ...]
    errors: tuple[ErrorRecord, ...]
    invariants: tuple[InvariantRecord, ...]
    conditions: tuple[ConditionRecord, ...]
    versions: tuple[tuple[str, str], ...]
    hashes: tuple[tuple[str, str], ...]
    faults: tuple[Fault, ...]
    notes: tuple[str, ...]
    left_out: tuple[LeftOut, ...] = ()
    searches: tuple[SearchRecord, ...] = ()

    @property
    def failures(self) -> tuple[str, ...]:
        """The faults as sentences."""
        return tuple(fault.text for fault in self.faults)

    @property
    def passed(self) -> bool:
        """Whether everything that was asked for is there and everything that was checked holds."""
        return not self.faults and not self.left_out

    @property
    def rejected(self) -> dict[str, tuple[Fault, ...]]:
        """The faults of each quantity that has some; empty where something is wrong with all of it."""
        names = dict.fromkeys(fault.quantity for fault in self.faults)
        return {} if "" in names else {name: tuple(f for f in self.faults if f.quantity == name) for name in names}

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
            "left_out": [
                {
                    "quantity": one.quantity,
                    "scalars": list(one.scalars),
                    "tried": [{"method": method, "why": why} for method, why in one.tried],
                    "remedy": one.remedy,
                }
                for one in self.left_out
            ],
            "notes": list(self.notes),
            "tolerance": _tolerance(),
            "states": self.states,
            "searches": [asdict(record) for record in self.searches],
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
