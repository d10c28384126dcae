"""An alternative that verification was held against, and what speaks against its kernels where they are worst."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from symgen.generation.results import AUTO
from symgen.ir.kernel import Kernel, Scalar
from symgen.quantities.alternatives import Alternative
from symgen.records import dataclass
from symgen.verify.certificate import Fault
from symgen.verify.comparison import INACCURATE
from symgen.verify.tolerance import FACTOR

Kernels: TypeAlias = Mapping[Scalar, Kernel]


@dataclass(frozen=True, slots=True)
class Passing:
    """An alternative with its kernels and its largest error in `scalars`, where it passes."""

    largest: float
    scalars: tuple[Scalar, ...]
    alternative: Alternative
    kernels: Kernels


@dataclass(frozen=True, slots=True)
class Searched:
    """Kernels whose worst states were looked for, and their largest error there."""

    kernels: Kernels
    largest: float


def digest(kernels: Kernels) -> int:
    """A number for kernels that were looked at: they themselves need not stay."""
    return hash(tuple(kernels.items()))


def faults_at_worst(quantity: str, errors: Mapping[Scalar, float]) -> tuple[Fault, ...]:
    """What is wrong at the states that were searched for."""
    what = f"{INACCURATE} {{:.3g}} times d + eps |y*| at a state searched for, {FACTOR:g} is allowed"
    return tuple(Fault(what.format(error), quantity, scalar) for scalar, error in errors.items() if error > FACTOR)


def plain_kernel(one: Alternative, kernels: Kernels) -> Kernel | None:
    """The kernel of plain numbers among those of an alternative: where it is worst is looked for."""
    return None if "float64" in one.choice.wide else kernels["float64"]


def remedy(asked: str, quantity: str, without: Sequence[Scalar]) -> str:
    """What a user may do who is left without a quantity in some types; `asked` is the method that was asked for."""
    if asked != AUTO:
        return f"leave `--form {quantity}={asked}` away: another method may pass"
    if "float64" not in without:
        return f"float64 has {quantity}; `--scalar float64` asks for that type alone"
    return "give narrower `ranges` if states near a singularity are never met; `--no-verify` writes it as it is"
