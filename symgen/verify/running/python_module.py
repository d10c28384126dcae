"""The generated NumPy module, run as it would be imported, without touching the disk."""

from __future__ import annotations

import math
import re
import types
from collections.abc import Iterator, Sequence
from typing import Any

from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel, Status
from symgen.verify.given import entries
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import Outcome

MODULE_NAME = "symgen_verified_module"
# Characters; the parser takes 60 bytes for each, all at once.
LARGE_MODULE = 1_000_000
_FUNCTION = re.compile(r"^(?:@.*\n)*def ", re.MULTILINE)


def _parts(source: str) -> Iterator[str]:
    """The module, or its functions one after the other where it is large; what stands before the first comes first."""
    starts = [0] if len(source) <= LARGE_MODULE else [0, *(match.start() for match in _FUNCTION.finditer(source))]
    for start, end in zip(starts, [*starts[1:], len(source)], strict=True):
        yield source[start:end]


class PythonModule:
    """A generated module in a module object of its own."""

    def __init__(self, source: str) -> None:
        self.module = types.ModuleType(MODULE_NAME)
        for part in _parts(source):
            exec(compile(part, "<generated module>", "exec"), self.module.__dict__)

    def unload(self) -> None:
        """Lets go of the functions, which hold the module that holds them."""
        self.module.__dict__.clear()

    def run(self, kernel: Kernel, states: Sequence[State]) -> list[Outcome]:
        """All states in one vectorised call; a state without result has NaN entries and no status of its own."""
        import numpy as np

        arrays = [np.array([entries(s, a) for s in states], dtype=np.float64) for a in array_arguments(kernel)]
        columns = [np.array(column) for column in zip(*(s.parameters for s in states), strict=True)]
        result = getattr(self.module, kernel.name)(*arrays, p=self.module.Parameters(*columns))
        rows: list[list[float]] = result.reshape(len(states), -1).tolist()
        return [Outcome(self._status(row), tuple(row)) for row in rows]

    def run_single(self, kernel: Kernel, state: State) -> Outcome:
        """One state without leading axes."""
        arrays: list[Any] = [list(entries(state, argument)) for argument in array_arguments(kernel)]
        try:
            result = getattr(self.module, kernel.name)(*arrays, p=self.module.Parameters(*state.parameters))
        except self.module.StateError as refusal:
            return Outcome(int(refusal.status), (math.nan,) * max(1, math.prod(kernel.shape)))
        return Outcome(0, tuple(result.reshape(-1).tolist()))

    @staticmethod
    def _status(row: Sequence[float]) -> int:
        return int(Status.OK if all(map(math.isfinite, row)) else Status.NOT_FINITE)
