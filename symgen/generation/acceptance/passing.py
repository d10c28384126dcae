"""An alternative that verification was held against, and what a user may do who is left without any."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.generation.acceptance.worst_errors import Kernels
from symgen.generation.results import AUTO
from symgen.ir.kernel import Scalar
from symgen.quantities.alternatives import Alternative
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Passing:
    """An alternative with its kernels and its largest error in `scalars`, where it passes."""

    largest: float
    scalars: tuple[Scalar, ...]
    alternative: Alternative
    kernels: Kernels


def digest(kernels: Kernels) -> int:
    """A number for kernels that were looked at: they themselves need not stay."""
    return hash(tuple(kernels.items()))


def remedy(asked: str, quantity: str, without: Sequence[Scalar]) -> str:
    """What a user may do who is left without a quantity in some types; `asked` is the method that was asked for."""
    if asked != AUTO:
        return f"leave `--method {quantity}={asked}` away: another method may pass"
    if "float64" not in without:
        return f"float64 has {quantity}; `--scalar float64` asks for that type alone"
    return "give narrower `ranges` if states near a singularity are never met; `--no-verify` writes it as it is"
