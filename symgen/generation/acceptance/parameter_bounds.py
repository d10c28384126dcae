"""How far parameters may be from the values that a draft is verified at: found for each of its kernels once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from symgen.generation.acceptance.once_per_kernel import OncePerKernel
from symgen.generation.draft import Draft
from symgen.ir.bounded import Bound
from symgen.ir.kernel import Kernel, Scalar
from symgen.verify.expected import Expected
from symgen.verify.margins.far_parameters import FarParameters


class ParameterBounds:
    """The bounds for one model, through all rounds of its verification."""

    WHAT = "how far parameters may be"

    def __init__(self, expected: Expected) -> None:
        far = FarParameters(expected)

        def look(draft: Draft, name: str, kernels: Mapping[Scalar, Kernel]) -> dict[Scalar, tuple[Bound, ...]]:
            share = far.share(draft.programs["float64"].kernels)
            taken = draft.taken(name)
            plain = draft.plain_kernel(taken, kernels) if "float64" in taken.choice.wide else None
            made = far.bounds(kernels, draft.programs, plain, share)
            return {scalar: bounds for scalar, bounds in made.items() if bounds}

        self._known = OncePerKernel[tuple[Bound, ...]](look)

    def of(self, draft: Draft) -> Draft:
        """The draft with the bounds of its kernels."""
        return replace(draft, bounds=self._known.of(draft, (kernel.name for kernel in draft.program.kernels)))
