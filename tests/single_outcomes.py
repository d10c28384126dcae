"""What kernels for one state of a compiled library make of some states: what variants are held against."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Sequence

from symgen.ir.kernel import Kernel
from symgen.verify.given import entries
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import CFunction, Outcome, c_array


def alone(
    library: ctypes.CDLL, name: str, kernels: Iterable[Kernel], states: Sequence[State]
) -> dict[str, list[Outcome]]:
    """By quantity, of a model's kernels in float64."""
    made = {}
    for kernel in kernels:
        single = CFunction(library, name, kernel, "float64")
        made[kernel.name] = [
            single(
                {a.name: c_array("float64", entries(s, a)) for a in kernel.arguments},
                c_array("float64", s.parameters),
            )
            for s in states
        ]
    return made
