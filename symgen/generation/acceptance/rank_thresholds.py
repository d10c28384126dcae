"""Thresholds of rank that a draft's kernels have above what rounding leaves."""

from __future__ import annotations

from dataclasses import replace

from symgen.generation.acceptance.once_per_kernel import OncePerKernel
from symgen.generation.draft import Draft
from symgen.ir.kernel import Scalar
from symgen.ir.raised import Raised
from symgen.model.quantities import MAIN
from symgen.verify.certificate import Fault
from symgen.verify.comparison import INACCURATE
from symgen.verify.expected import Expected
from symgen.verify.margins.next_to_singular import NextToSingular
from symgen.verify.tolerance import FACTOR

UNREFUSED = f"{INACCURATE} above {FACTOR:g} times d + eps |y*| next to a singular state, which no threshold refuses"


class RankThresholds:
    """Those of one model, through all rounds of its verification."""

    WHAT = "how near states may be to singular ones"

    def __init__(self, expected: Expected) -> None:
        states = NextToSingular(expected)
        self._known = OncePerKernel[Raised | None](lambda draft, _, kernels: states.raised(kernels, draft.programs))

    def of(self, draft: Draft) -> Draft:
        """The draft with thresholds of its kernels raised where that is needed."""
        known = self._looked_at(draft).items()
        helped = {scalar: {name: one for name, one in by.items() if one is not None} for scalar, by in known}
        return replace(draft, raised=helped)

    def faults(self, draft: Draft) -> tuple[Fault, ...]:
        """Kernels that lose digits next to singular states, which no threshold refuses."""
        known = self._looked_at(draft).items()
        return tuple(Fault(UNREFUSED, name, scalar) for scalar, by in known for name, one in by.items() if one is None)

    def _looked_at(self, draft: Draft) -> dict[Scalar, dict[str, Raised | None]]:
        names = (kernel.name for kernel in draft.program.kernels if kernel.name in MAIN)
        return self._known.of(draft, names)
