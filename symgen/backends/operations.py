"""What a kernel costs: operations counted by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from functools import lru_cache
from operator import attrgetter

from symgen.ir.kernel import OperationName, Statement
from symgen.ir.pairs.wide_functions import is_wide_operation, wide_function
from symgen.records import dataclass

_operation = attrgetter("operation")
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
    counts = dict.fromkeys(("add", "mul", "div", "sqrt", "sincos", "sign", "other"), 0)
    for operation, times in Counter(map(_operation, statements)).items():
        for kind, number in _kinds(operation).items():
            counts[kind] += times * number
    return OperationCounts(**counts)


@lru_cache
def _kinds(operation: OperationName) -> Mapping[str, int]:
    """Of one operation."""
    if not is_wide_operation(operation):
        return {_KIND.get(operation, "other"): 1}
    return Counter(_KIND.get(part.operation, "other") for part in wide_function(operation).statements)
