"""How far parameters may be from the values that a draft is verified at: found for each of its kernels once."""

from __future__ import annotations

from dataclasses import replace

from symgen.generation.draft import Draft
from symgen.ir.bounded import Bound
from symgen.ir.kernel import Kernel, Scalar
from symgen.verify.expected import Expected
from symgen.verify.far_parameters import FarParameters


class ParameterBounds:
    """The bounds for one model, through all rounds of its verification."""

    WHAT = "how far parameters may be"

    def __init__(self, expected: Expected) -> None:
        self._far = FarParameters(expected)
        self._known: dict[str, tuple[dict[Scalar, Kernel], dict[Scalar, tuple[Bound, ...]]]] = {}

    def of(self, draft: Draft) -> Draft:
        """The draft with the bounds of its kernels."""
        by_scalar: dict[Scalar, dict[str, tuple[Bound, ...]]] = {scalar: {} for scalar in draft.programs}
        for name in (kernel.name for kernel in draft.program.kernels):
            kernels, known = draft.kernels(name), self._known.get(name)
            if known is None or any(kernel is not known[0].get(scalar) for scalar, kernel in kernels.items()):
                known = self._known[name] = kernels, self._far.bounds(kernels, draft.programs, _plain(draft, name))
            for scalar in kernels:
                if bounds := known[1].get(scalar):
                    by_scalar[scalar][name] = bounds
        return replace(draft, bounds=by_scalar)


def _plain(draft: Draft, quantity: str) -> Kernel | None:
    """The kernel in float64 without pairs of numbers, of a quantity that works with them there."""
    taken = draft.taken(quantity)
    if "float64" not in taken.choice.wide:
        return None
    taken = replace(taken, choice=replace(taken.choice, wide=()))
    return draft.kernels_along(taken, ("float64",))["float64"]
