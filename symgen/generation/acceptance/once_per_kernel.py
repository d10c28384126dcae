"""What verification finds out about the kernels of a quantity, once for as long as they stay the same."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Generic, TypeAlias, TypeVar

from symgen.generation.draft import Draft
from symgen.ir.kernel import Kernel, Scalar

Limit = TypeVar("Limit")
Look: TypeAlias = Callable[[Draft, str, Mapping[Scalar, Kernel]], Mapping[Scalar, Limit]]
"""At a quantity of a draft and its kernels: what there is to be said of each type."""


class OncePerKernel(Generic[Limit]):
    """Through all rounds of the verification of one model."""

    def __init__(self, look: Look[Limit]) -> None:
        self._look = look
        self._known: dict[str, tuple[Mapping[Scalar, Kernel], Mapping[Scalar, Limit]]] = {}

    def of(self, draft: Draft, names: Iterable[str]) -> dict[Scalar, dict[str, Limit]]:
        """By type and name, of quantities of a draft."""
        by_scalar: dict[Scalar, dict[str, Limit]] = {scalar: {} for scalar in draft.programs}
        for name in names:
            kernels, known = draft.kernels(name), self._known.get(name)
            if known is None or any(kernel is not known[0].get(scalar) for scalar, kernel in kernels.items()):
                known = self._known[name] = kernels, self._look(draft, name, kernels)
            for scalar in kernels:
                if scalar in known[1]:
                    by_scalar[scalar][name] = known[1][scalar]
        return by_scalar
