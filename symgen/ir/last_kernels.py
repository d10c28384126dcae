"""What is worked out of kernels, remembered for the last few: one after another steps look at the same ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

from symgen.ir.kernel import Kernel

Made = TypeVar("Made")


class LastKernels(Generic[Made]):
    """Results by kernel, which is known by being the same object: kernels are compared by all that they hold."""

    def __init__(self, count: int) -> None:
        self._known: deque[tuple[Kernel, Made]] = deque(maxlen=count)

    def of(self, kernel: Kernel, make: Callable[[], Made]) -> Made:
        """The result of a kernel, made if it is not among the last ones."""
        for known, made in self._known:
            if known is kernel:
                return made
        made = make()
        self._known.append((kernel, made))
        return made
