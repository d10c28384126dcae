"""What a report needs to know: the model, its closed forms and the facts found on the way, as frozen data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from symgen.closedform.forms import ClosedForm
from symgen.closedform.frame_steps import FrameStep
from symgen.closedform.laws.choice import Laws
from symgen.closedform.laws.singular_sets import DeterminantSet
from symgen.closedform.published import Verdict
from symgen.closedform.singular import SingularSet
from symgen.closedform.structure import Integrability, RankStructure
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.report.proof import ProofFacts
from symgen.report.targets import TargetCore


@dataclass(frozen=True, slots=True)
class ErrorRow:
    """Errors of one kernel on one target, in units of d + eps |y*|."""

    quantity: str
    target: str
    median: float
    largest: float


@dataclass(frozen=True, slots=True)
class Verification:
    """What a run measured: (target, law, violation) and (name, value) as text."""

    states: int
    errors: tuple[ErrorRow, ...]
    invariants: tuple[tuple[str, str, str], ...] = ()
    facts: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Chart:
    """A drawing as SVG text, with its caption."""

    caption: str
    svg: str


@dataclass(frozen=True, slots=True)
class ReportInput:
    """Everything the report says.

    Without `verification`, `charts`, `targets`, `proof` a function of model and symgen alone.

    `laws` are printed in the place of closed forms that are long, `determinants` in that of singular sets.
    `drawing` is the machine as SVG, `frame_steps` those of its recursion where the mass matrix is not written out.
    `operation_counts`: quantity -> kind of operation (add, mul, div, sqrt, sincos, other) -> number.
    `skipped`: decisions with their reasons, and quantities that do not exist with theirs.
    """

    model: Model
    version: str
    forms: Mapping[str, ClosedForm]
    structure: RankStructure
    integrability: tuple[Integrability, ...] = ()
    singular_sets: tuple[SingularSet, ...] = ()
    skipped: tuple[tuple[str, str], ...] = ()
    operation_counts: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    verdicts: tuple[Verdict, ...] = ()
    notices: tuple[str, ...] = ()
    frame_steps: tuple[FrameStep, ...] = ()
    drawing: str | None = None
    verification: Verification | None = None
    charts: tuple[Chart, ...] = ()
    targets: tuple[TargetCore, ...] = ()
    proof: ProofFacts | None = None
    laws: Laws = field(default_factory=dict)
    determinants: tuple[DeterminantSet, ...] = ()
