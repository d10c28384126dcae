"""What the derivation of the kernels tells the report."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.emit.operations import OperationCounts
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Facts:
    """What the derivation of the kernels tells the report: operations by quantity, what is skipped and why."""

    operations: Mapping[str, OperationCounts]
    skipped: tuple[tuple[str, str], ...]
