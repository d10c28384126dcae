"""Errors of the methods along the families, as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from symgen.ir.kernel import Scalar
from symgen.laboratory.stress.method_kernels import LABELS
from symgen.verify.tolerance import FACTOR

SYMGEN = "symgen"
PARTITION = "(9) fixed partition"
FIXED = "(27)+(28) fixed"
SWITCHING = "(27)+(28) switching"
METHODS = (PARTITION, FIXED, SWITCHING, SYMGEN, *LABELS.values())


@dataclass(frozen=True, slots=True)
class Error:
    """|y − y*| of one method at one distance: relative to |y*|, and in units of d + eps |y*|; the largest of a family.

    `relative` is infinite where the method has no finite result.  `floor` is eps κ, with κ estimated from the measures
    of singularity and the eigenvalues of G: what a normwise stable algorithm may lose although the data determine the
    result better.
    """

    distance: float
    relative: float
    units: float
    floor: float

    @property
    def normwise(self) -> bool:
        """Whether the error is no more than a normwise stable algorithm may make."""
        return self.relative <= FACTOR * self.floor

    def worse(self, other: Error) -> Error:
        """The larger of both, entry by entry."""
        return Error(
            self.distance,
            max(self.relative, other.relative),
            max(self.units, other.units),
            max(self.floor, other.floor),
        )


@dataclass(frozen=True, slots=True)
class Series:
    """Errors of one method of one quantity along a family, from d = 1 downwards."""

    family: int
    scalar: Scalar
    quantity: str
    method: str
    errors: tuple[Error, ...]

    @property
    def breaks(self) -> float | None:
        """The largest d at which the error exceeds the tolerance; None where it never does."""
        return max((e.distance for e in self.errors if not e.units <= FACTOR), default=None)

    @property
    def largest(self) -> Error:
        """The worst in units of the tolerance."""
        return max(self.errors, key=lambda e: e.units)


def by_method(series: Sequence[Series], quantity: str, scalar: Scalar, families: Sequence[int]) -> Mapping[str, Series]:
    """The worst over some families for each method, distance by distance."""
    worst: dict[str, dict[float, Error]] = {}
    for one in series:
        if one.quantity == quantity and one.scalar == scalar and one.family in families:
            errors = worst.setdefault(one.method, {})
            for e in one.errors:
                errors[e.distance] = e.worse(errors.get(e.distance, e))
    return {
        one: Series(-1, scalar, quantity, one, tuple(worst[one][d] for d in sorted(worst[one], reverse=True)))
        for one in METHODS
        if one in worst
    }
