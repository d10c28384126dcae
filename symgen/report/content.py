"""What a report needs to know: the model, its closed forms and the facts found on the way, as frozen data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from symgen.model.model import Model


class ClosedForm(Protocol):
    """A quantity in closed form.

    `matrix` is a SymPy matrix in names of the model and of the intermediates (None: not attempted, `note` says why);
    `intermediates` are (symbol, expression) pairs in order of use.
    """

    @property
    def matrix(self) -> Any: ...

    @property
    def intermediates(self) -> Sequence[tuple[Any, Any]]: ...

    @property
    def note(self) -> str: ...


@dataclass(frozen=True, slots=True)
class Structure:
    """Dimensions and classes of the system; `rank` is the generic rank of B, `alpha` the generic degree of actuation."""

    rank: int
    delta_loc: int
    delta_diff: int
    alpha: int
    actuation: str


@dataclass(frozen=True, slots=True)
class SingularSet:
    """Where a quantity does not exist or changes rank: the zeros of a SymPy expression, or words where it is None."""

    quantity: str
    zero: Any
    text: str


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on one entry of the model's `published` block (by position), with the line of proof."""

    position: int
    verdict: str
    proof: str


@dataclass(frozen=True, slots=True)
class ErrorRow:
    """Errors of one quantity in one language and precision: largest in units of the tolerance, and relative."""

    quantity: str
    kernel: str
    largest: float
    percentile_99: float
    median: float
    tolerance_units: float


@dataclass(frozen=True, slots=True)
class Verification:
    """What verification measured; shown in the PDF only."""

    states: int
    remarks: tuple[str, ...]
    errors: tuple[ErrorRow, ...]
    invariants: tuple[tuple[str, str], ...]
    conditions: tuple[tuple[str, str], ...] = ()
    versions: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Chart:
    """A drawing with its caption."""

    name: str
    caption: str
    svg: str


@dataclass(frozen=True, slots=True)
class ReportInput:
    """Everything the report says; without `verification` and `charts` it is a function of model and symgen alone."""

    model: Model
    version: str
    structure: Structure
    closed_forms: Mapping[str, ClosedForm]
    skipped: tuple[tuple[str, str], ...] = ()
    operation_counts: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    singular_sets: tuple[SingularSet, ...] = ()
    integrability: tuple[str, ...] = ()
    verdicts: tuple[Verdict, ...] = ()
    notices: tuple[str, ...] = ()
    verification: Verification | None = None
    charts: tuple[Chart, ...] = ()
