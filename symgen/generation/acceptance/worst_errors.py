"""The errors of kernels by interpretation: at the states of a verification, and at those where they are worst."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TypeAlias

from symgen.generation.draft import Draft
from symgen.ir.kernel import Kernel, Scalar
from symgen.quantities.alternatives import Alternative
from symgen.records import dataclass
from symgen.verify.certificate import Certificate, Fault
from symgen.verify.comparison import INACCURATE
from symgen.verify.expected import Expected
from symgen.verify.interpreted import Measurements
from symgen.verify.sampling.searched import WorstStateSearch
from symgen.verify.tolerance import FACTOR

Kernels: TypeAlias = Mapping[Scalar, Kernel]


@dataclass(frozen=True, slots=True)
class _Searched:
    """Kernels whose worst states were looked for, and their largest error there."""

    kernels: Kernels
    largest: float


class WorstErrors:
    """What was measured of the kernels of one model, through all rounds of its verification."""

    def __init__(self, progress: Callable[[str], None]) -> None:
        self._progress = progress
        self._search: WorstStateSearch | None = None
        self._searched: dict[str, _Searched] = {}
        self.measurements = Measurements()

    def begin(self, expected: Expected) -> None:
        """From now on states are searched for near those of a verification."""
        self._search = WorstStateSearch(expected)

    def largest(self, quantity: str) -> float:
        """The largest error of a quantity where its kernels were last worst; 0 before these were looked for."""
        return self._searched[quantity].largest if quantity in self._searched else 0.0

    def keep(self, quantity: str, kernels: Kernels, largest: float) -> None:
        """Of these kernels worst states need not be looked for again."""
        self._searched[quantity] = _Searched(kernels, largest)

    def faults(self, draft: Draft, certificate: Certificate, expected: Expected) -> dict[str, tuple[Fault, ...]]:
        """What is wrong with quantities that nothing speaks against, at states where they are worst."""
        by_quantity = {}
        for quantity in (kernel.name for kernel in draft.program.kernels):
            kernels = draft.kernels(quantity)
            searched = self._searched.get(quantity)
            if quantity in certificate.rejected or (searched is not None and searched.kernels == kernels):
                continue
            self._progress(f"verifying: where {quantity} is worst")
            judged = {scalar: kernel for scalar, kernel in kernels.items() if scalar in expected.scalars}
            errors: dict[Scalar, float] = {}
            if judged:
                errors = self.at_worst(draft, judged, draft.taken(quantity))
            self.keep(quantity, kernels, max(errors.values(), default=0.0))
            if faults := faults_at_worst(quantity, errors):
                by_quantity[quantity] = faults
        return by_quantity

    def at_worst(self, draft: Draft, kernels: Kernels, looked_at: Alternative | None) -> dict[Scalar, float]:
        """The errors of kernels where their quantity is worst, by a method that is `looked_at` and by others before."""
        assert self._search is not None
        if looked_at is not None:
            choice, plain = looked_at.choice, partial(draft.plain_kernel, looked_at, kernels)
            self._search.look(choice.quantity, choice.title, plain)
        programs = draft.programs
        return {
            scalar: self._search.largest(kernel, programs[scalar].sincos, scalar) for scalar, kernel in kernels.items()
        }

    def of_types(self, draft: Draft, quantity: str, expected: Expected) -> dict[Scalar, float]:
        """The largest error of a quantity in each type, at the states of the verification and where it is worst."""
        judged = {scalar: kernel for scalar, kernel in draft.kernels(quantity).items() if scalar in expected.scalars}
        errors = self.at_worst(draft, judged, None)
        for scalar, kernel in judged.items():
            record, _ = self.measurements.of(kernel, draft.programs[scalar].sincos, scalar, expected)
            errors[scalar] = max(errors[scalar], record.largest)
        return errors


def faults_at_worst(quantity: str, errors: Mapping[Scalar, float]) -> tuple[Fault, ...]:
    """What is wrong at the states that were searched for."""
    what = f"{INACCURATE} {{:.3g}} times d + eps |y*| at a state searched for, {FACTOR:g} is allowed"
    return tuple(Fault(what.format(error), quantity, scalar) for scalar, error in errors.items() if error > FACTOR)
