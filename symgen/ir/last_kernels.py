"""What is worked out of kernels, remembered for the last few: one after another steps look at the same ones."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

from symgen.ir.kernel import Kernel

Made = TypeVar("Made")


class LastKernels(Generic[Made]):
    """Results by kernel, which is known by being the same object: kernels are compared by all that they hold.

    Those of the last `count` kernels, and of as many before as have no more than `statements` together with them.
    """

    def __init__(self, count: int, statements: int = 0) -> None:
        self._count, self._statements, self._held = count, statements, 0
        self._known: OrderedDict[int, tuple[Kernel, Made, int]] = OrderedDict()

    def of(self, kernel: Kernel, make: Callable[[], Made]) -> Made:
        """The result of a kernel, made if it is not among the last ones."""
        known = self._known.get(id(kernel))
        if known is not None:
            self._known.move_to_end(id(kernel))
            return known[1]
        made, size = make(), len(kernel.statements)
        self._known[id(kernel)] = kernel, made, size
        self._held += size
        while len(self._known) > self._count and self._held > self._statements:
            _, (_, _, let_go) = self._known.popitem(last=False)
            self._held -= let_go
        return made
