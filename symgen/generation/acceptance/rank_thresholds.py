"""Thresholds of rank that a draft's kernels have above what rounding leaves."""

from __future__ import annotations

from dataclasses import replace

from symgen.generation.acceptance.once_per_kernel import OncePerKernel
from symgen.generation.draft import Draft
from symgen.ir.raised import Raised
from symgen.model.quantities import MAIN
from symgen.verify.expected import Expected
from symgen.verify.margins.next_to_singular import NextToSingular


class RankThresholds:
    """Those of one model, through all rounds of its verification."""

    WHAT = "how near states may be to singular ones"

    def __init__(self, expected: Expected) -> None:
        states = NextToSingular(expected)
        self._known = OncePerKernel[Raised](lambda draft, _, kernels: states.raised(kernels, draft.programs))

    def of(self, draft: Draft) -> Draft:
        """The draft with thresholds of its kernels raised where that is needed."""
        names = (kernel.name for kernel in draft.program.kernels if kernel.name in MAIN)
        return replace(draft, raised=self._known.of(draft, names))
