"""The batch kernels of generated C: the bits and statuses of the kernels for one state, at every state."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping, Sequence
from typing import Any

from symgen.backends.c.endings import BATCH
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.backends.quantities import BATCHED
from symgen.ir.kernel import Kernel, Scalar
from symgen.verify.certificate import Fault
from symgen.verify.given import entries
from symgen.verify.reference.reference import State
from symgen.verify.running.compile import C_TYPES, CFunction, Outcome, c_array
from symgen.verify.sampling.states import Sample

# Every component set to one of these: a symmetric pose, an angle beyond any range, not a number.
HARD = (0.0, 1e30, math.nan)
# The last block is not full, and rows are longer than the number of states.
SPARE = 3


class BatchFunction:
    """One batch kernel of a library over fixed states, the hard ones last."""

    def __init__(
        self, library: ctypes.CDLL, model: str, kernel: Kernel, scalar: Scalar, states: Sequence[State]
    ) -> None:
        self._function = library[global_name(model, scalar, kernel.name, BATCH)]
        self._function.restype = ctypes.c_size_t
        self._count = len(states) + len(HARD)
        self._stride = self._count + SPARE
        self._size = math.prod(kernel.shape)
        self._result = C_TYPES[scalar] * (self._size * self._stride)
        self._rows = []
        for argument in array_arguments(kernel):
            columns = [[float(v) for v in entries(s, argument)] for s in states]
            columns += [[value] * argument.length for value in HARD]
            spare = [0.0] * SPARE
            self._rows.append(c_array(scalar, [x for row in zip(*columns, strict=True) for x in (*row, *spare)]))

    def __call__(self, parameters: Any) -> list[Outcome]:
        """Outcomes of all states for one set of parameters."""
        result = self._result(*([7.0] * len(self._result())))
        statuses = (ctypes.c_ubyte * self._stride)()
        sizes = ctypes.c_size_t(self._count), ctypes.c_size_t(self._stride)
        refused = self._function(*sizes, *self._rows, parameters, result, statuses)
        if refused != sum(map(bool, statuses[: self._count])):
            return [Outcome(-1, ())] * self._count
        columns = [tuple(result[k :: self._stride]) for k in range(self._count)]
        return [Outcome(statuses[k], column) for k, column in enumerate(columns)]


def run_batch(
    library: ctypes.CDLL,
    model: str,
    kernels: Sequence[Kernel],
    scalar: Scalar,
    samples: Sequence[Sample],
    alone: Mapping[str, Sequence[Outcome]],
) -> tuple[dict[str, list[Outcome]], list[Fault]]:
    """Outcomes of every batch kernel at every state, and faults where they are not those of one state `alone`."""
    of_batches = outcomes_of_batches(library, model, kernels, scalar, samples)
    faults = []
    first = c_array(scalar, samples[0].state.parameters)
    for kernel in (kernel for kernel in kernels if kernel.name in of_batches):
        outcomes, hard = of_batches[kernel.name]
        place = kernel.name, f"C {scalar} batch"
        for k, (one, many) in enumerate(zip(alone[kernel.name], outcomes, strict=True)):
            if one.valid and one != many:
                faults.append(Fault(f"state {k} alone and in a batch differ", *place))
                break
        single = CFunction(library, model, kernel, scalar)
        for value, many in zip(HARD, hard, strict=True):
            arrays: dict[str, Any] = {a.name: c_array(scalar, [value] * a.length) for a in array_arguments(kernel)}
            if single(arrays, first).status != many.status:
                faults.append(Fault(f"other status than alone where every input is {value}", *place))
    return {name: outcomes for name, (outcomes, _) in of_batches.items()}, faults


def outcomes_of_batches(
    library: ctypes.CDLL, model: str, kernels: Sequence[Kernel], scalar: Scalar, samples: Sequence[Sample]
) -> dict[str, tuple[list[Outcome], list[Outcome]]]:
    """Outcomes of every batch kernel at every state, and at hard ones.

    A batch has one set of parameters.  One holds all states, with the parameters of the first; states that have others
    are run in a batch with those that share theirs.
    """
    states = [sample.state for sample in samples]
    together: dict[tuple[Any, ...], list[int]] = {}
    for k, state in enumerate(states):
        together.setdefault(state.parameters, []).append(k)
    outcomes = {}
    for kernel in (kernel for kernel in kernels if kernel.name in BATCHED):
        batch = BatchFunction(library, model, kernel, scalar, states)
        whole = batch(c_array(scalar, states[0].parameters))
        of_states, hard = whole[: len(states)], whole[len(states) :]
        for parameters, places in list(together.items())[1:]:
            others = BatchFunction(library, model, kernel, scalar, [states[k] for k in places])
            made = others(c_array(scalar, parameters))
            for k, one in zip(places, made[: len(places)], strict=True):
                of_states[k] = one
        outcomes[kernel.name] = of_states, hard
    return outcomes
