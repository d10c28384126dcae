"""A quantity as scalars, with the denominators it depends on: what is scheduled and printed."""

from __future__ import annotations

from symgen.linear_algebra.guards import Guard
from symgen.records import dataclass
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity as scalars: row-major outputs of `shape`, and the denominators they depend on.

    `remark` is what its reader must know for this system.
    """

    name: str
    shape: tuple[int, ...]
    outputs: Vector
    guards: tuple[Guard, ...]
    remark: str = ""


def resting_on(guards: tuple[Guard, ...], name: str, outputs: Vector) -> Quantity:
    """A vector that divides by what these guards look at."""
    return Quantity(name, (len(outputs),), outputs, () if is_fixed(outputs) else guards)


def is_fixed(outputs: Vector) -> bool:
    """Whether a result depends on nothing: a status is decided on what it depends on."""
    return all(output.constant is not None for output in outputs)


def scalars(derived: Quantity) -> tuple[Scalar, ...]:
    """Everything a kernel of the quantity computes on the way of a regular state."""
    return (*derived.outputs, *(guard.denominator for guard in derived.guards))
