"""What passes between a run and its report, which is made in a process of its own: nothing heavy, both load it."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.backends.operations import OperationCounts
from symgen.diagnostics import Mistake, Notice
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Facts:
    """What the derivation of the kernels tells the report: operations by quantity, what is skipped and why."""

    operations: Mapping[str, OperationCounts]
    skipped: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class ReportFiles:
    """The report of one model, what the user should know, and mistakes in the model's paths."""

    files: dict[str, str | bytes]
    notices: tuple[Notice, ...] = ()
    mistakes: tuple[Mistake, ...] = ()
