"""What was found on targets, as data that goes into target.json."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from symgen.ir.kernel import Scalar
from symgen.laboratory.target.footprint import KernelFootprint


@dataclass(frozen=True, slots=True)
class Cell:
    """One build (core or host, compiler, level, kind of sine and cosine) compared with the host's gcc -O2.

    `kernels` were built, and `different` of `records` are not the same (one for each kernel and vector: status and
    output bits).  Where a libm is involved they may differ, and `distance` is the largest of regular states in units
    of d + eps |y|.
    """

    where: str
    compiler: str
    level: str
    scalar: Scalar
    trig: str
    kernels: int
    records: int
    different: int
    distance: float = 0.0


@dataclass(frozen=True, slots=True)
class KernelCost:
    """One kernel on one core at one level: instructions per call over `calls` vectors with status 0 (from its first
    to its return), bytes of painted stack, and the footprint (at -Os; None elsewhere).
    """

    kernel: str
    scalar: Scalar
    level: str
    calls: int
    fewest: int
    most: int
    stack: int
    footprint: KernelFootprint | None


@dataclass(frozen=True, slots=True)
class CoreReport:
    """What one core costs."""

    name: str
    note: str
    costs: tuple[KernelCost, ...]


@dataclass(frozen=True, slots=True)
class TargetReport:
    """Everything measured for one model; `failures` name what is wrong, `notes` what could not be done."""

    model: str
    vectors: dict[str, int]
    statuses: dict[str, dict[str, int]]
    versions: dict[str, str]
    sources: dict[str, str]
    cells: tuple[Cell, ...]
    cores: tuple[CoreReport, ...]
    failures: tuple[str, ...]
    notes: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """A JSON-able form."""
        return {"model": self.model, "passed": not self.failures, **asdict(self)}
