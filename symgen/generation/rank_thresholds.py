"""Thresholds of rank that a draft's kernels have above what rounding leaves: looked for once for each of them."""

from __future__ import annotations

from dataclasses import replace

from symgen.generation.draft import Draft
from symgen.ir.kernel import Kernel, Scalar
from symgen.model.quantities import MAIN
from symgen.verify.expected import Expected
from symgen.verify.next_to_singular import NextToSingular


class RankThresholds:
    """Those of one model, through all rounds of its verification."""

    WHAT = "how near states may be to singular ones"

    def __init__(self, expected: Expected) -> None:
        self._states = NextToSingular(expected)
        self._known: dict[str, tuple[dict[Scalar, Kernel], dict[Scalar, int]]] = {}

    def of(self, draft: Draft) -> Draft:
        """The draft with the decades by which thresholds of its kernels are raised."""
        by_scalar: dict[Scalar, dict[str, int]] = {scalar: {} for scalar in draft.programs}
        for name in (kernel.name for kernel in draft.program.kernels if kernel.name in MAIN):
            kernels, known = draft.kernels(name), self._known.get(name)
            if known is None or any(kernel is not known[0].get(scalar) for scalar, kernel in kernels.items()):
                known = self._known[name] = kernels, self._states.decades(kernels, draft.programs)
            for scalar, decades in known[1].items():
                by_scalar[scalar][name] = decades
        return replace(draft, raised=by_scalar)
