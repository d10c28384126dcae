"""A kernel held against what is expected before any file is made of it: no compiler, the bits of C and Python."""

from __future__ import annotations

import math
from collections.abc import Sequence

from symgen.ir.kernel import Function, Kernel, Scalar
from symgen.runtime.activity import working
from symgen.verify.certificate import ErrorRecord, Fault
from symgen.verify.comparison import compare, faults_of
from symgen.verify.expected import Expected
from symgen.verify.given import parts_of
from symgen.verify.lanes.many_states import run_many
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import Outcome


def measured(
    kernel: Kernel, sincos: Function | None, scalar: Scalar, expected: Expected
) -> tuple[ErrorRecord, Fault | None]:
    """The errors of a kernel at the states of a verification in units of d + eps |y*|, and what is wrong."""
    samples, values = expected.samples(scalar), expected.values(scalar)
    with working(f"trying it in {scalar}"):
        results = outcomes(kernel, sincos, scalar, [sample.state for sample in samples])
    record = compare(kernel.name, scalar, [value[kernel.name] for value in values], results)
    return record, next(faults_of(record, results, samples), None)


class Measurements:
    """What `measured` finds, once for the kernel that a quantity has last been given in a scalar type."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, Scalar], tuple[Kernel, tuple[ErrorRecord, Fault | None]]] = {}

    def of(
        self, kernel: Kernel, sincos: Function | None, scalar: Scalar, expected: Expected
    ) -> tuple[ErrorRecord, Fault | None]:
        """As `measured`."""
        known = self._known.get((kernel.name, scalar))
        if known is None or known[0] is not kernel:
            known = self._known[kernel.name, scalar] = kernel, measured(kernel, sincos, scalar, expected)
        return known[1]


def outcomes(kernel: Kernel, sincos: Function | None, scalar: Scalar, states: Sequence[State]) -> list[Outcome]:
    """What a kernel gives at states of its scalar type: NaN where it refuses."""
    given = [
        {name: tuple(map(float, values)) for name, values in parts_of(state).items()} for state in states
    ]
    nothing = (math.nan,) * max(1, math.prod(kernel.shape))
    return [
        Outcome(int(status), tuple(entries) or nothing)
        for status, entries in run_many(kernel, sincos, scalar, given)
    ]
