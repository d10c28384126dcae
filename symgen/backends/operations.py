"""What a kernel costs: operations counted by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from functools import lru_cache

from symgen.ir.kernel import OperationName, Statement
from symgen.ir.wide_functions import is_wide, wide_function
from symgen.records import dataclass

_KIND = {
    "add": "add",
    "sub": "add",
    "mul": "mul",
    "div": "div",
    "ratio_or_zero": "div",
    "sqrt": "sqrt",
    "sincos": "sincos",
    "neg": "sign",
    "abs": "sign",
    "copysign": "sign",
}


@dataclass(frozen=True, slots=True)
class OperationCounts:
    """Operations of a straight-line program; `sign` counts neg, abs and copysign, `other` functions, min, max."""

    add: int
    mul: int
    div: int
    sqrt: int
    sincos: int
    sign: int
    other: int

    @property
    def total(self) -> int:
        """All operations; a sine/cosine pair counts as one."""
        return self.add + self.mul + self.div + self.sqrt + self.sincos + self.sign + self.other


def count_operations(statements: Iterable[Statement]) -> OperationCounts:
    """Counts the statements by kind; operations on pairs of numbers are those of their bodies."""
    counts = Counter(dict.fromkeys(("add", "mul", "div", "sqrt", "sincos", "sign", "other"), 0))
    for statement in statements:
        counts.update(_of_pairs(statement.operation) if is_wide(statement) else (_kind(statement),))
    return OperationCounts(**counts)


def _kind(statement: Statement) -> str:
    return _KIND.get(statement.operation, "other")


@lru_cache
def _of_pairs(operation: OperationName) -> Mapping[str, int]:
    return Counter(map(_kind, wide_function(operation).statements))
