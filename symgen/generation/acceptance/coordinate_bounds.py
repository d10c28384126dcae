"""How far coordinates may be out of their ranges: found for each kernel of a draft once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from symgen.generation.acceptance.once_per_kernel import OncePerKernel
from symgen.generation.draft import Draft
from symgen.ir.bounded_coordinates import CoordinateBound
from symgen.ir.kernel import Kernel, Scalar
from symgen.model.quantities import MAIN
from symgen.verify.expected import Expected
from symgen.verify.margins.far_coordinates import FarCoordinates


class CoordinateBounds:
    """The bounds for one model, through all rounds of its verification."""

    WHAT = "how far out of their ranges coordinates may be"

    def __init__(self, expected: Expected) -> None:
        far = FarCoordinates(expected)

        def look(draft: Draft, _: str, kernels: Mapping[Scalar, Kernel]) -> dict[Scalar, tuple[CoordinateBound, ...]]:
            made = far.bounds(kernels, draft.programs)
            return {scalar: bounds for scalar, bounds in made.items() if bounds}

        self._known = OncePerKernel[tuple[CoordinateBound, ...]](look)

    def of(self, draft: Draft) -> Draft:
        """The draft with the bounds of its kernels."""
        names = (kernel.name for kernel in draft.program.kernels if kernel.name in MAIN)
        return replace(draft, coordinate_bounds=self._known.of(draft, names))
