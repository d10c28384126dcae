"""What intervals say of a kernel over the whole box of its model, worked out once: several files tell of it."""

from __future__ import annotations

from dataclasses import dataclass

from symgen.ir.kernel import Kernel, Operand
from symgen.ir.last_kernels import LastKernels
from symgen.model.model import Model
from symgen.proof.box import box
from symgen.proof.intervals import Interval, enclose, exact_pair


@dataclass(frozen=True, slots=True)
class Reach:
    """The divisors that may be 0, the largest magnitude of a value, and the angles of sines with their bounds."""

    doubtful: tuple[str, ...]
    largest: float
    angles: tuple[tuple[Operand, Interval], ...]


def reach(model: Model, kernel: Kernel) -> Reach:
    """That of a kernel of a model."""
    return _REACHES.of(kernel, lambda: _reach(model, kernel))


def _reach(model: Model, kernel: Kernel) -> Reach:
    angles: list[tuple[Operand, Interval]] = []

    def pair(angle: Operand, bounds: Interval) -> tuple[Interval, ...]:
        angles.append((angle, bounds))
        return exact_pair(angle, bounds)

    enclosure = enclose(kernel, box(model), pair)
    return Reach(enclosure.doubtful, enclosure.largest, tuple(angles))


# All kernels of a program are looked at before the first one is again.
_REACHES = LastKernels[Reach](4, statements=500_000)
