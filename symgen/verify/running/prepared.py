"""The kernels with parameters prepared, of generated C: the bits and statuses of the plain kernels, at every state."""

from __future__ import annotations

import ctypes
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

from symgen.backends.c.endings import PREPARED
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel, Scalar
from symgen.verify.certificate import Fault
from symgen.verify.given import entries
from symgen.verify.running.batch import HARD
from symgen.verify.running.compile import C_TYPES, CFunction, Outcome, c_array
from symgen.verify.sampling.states import Sample


class PreparedFunction:
    """One prepared kernel of a library, called as the plain one: the parameters are prepared at each call."""

    def __init__(self, library: ctypes.CDLL, model: str, kernel: Kernel, scalar: Scalar, size: int) -> None:
        entries = C_TYPES[scalar] * size
        struct = type("Prepared", (ctypes.Structure,), {"_fields_": [("value", entries)]})
        self._prepare = library[global_name(model, scalar, "prepare")]
        self._prepare.restype = struct
        self._function = library[global_name(model, scalar, kernel.name, PREPARED)]
        self._function.restype = ctypes.c_int
        self._arguments = tuple(argument.name for argument in array_arguments(kernel))
        self._result = C_TYPES[scalar] * math.prod(kernel.shape)

    def __call__(self, arrays: dict[str, Any], parameters: Any) -> Outcome:
        """Run on C arrays made by `c_array`."""
        result = self._result(*([math.nan] * self._result._length_))
        prepared = self._prepare(parameters)
        status = self._function(*(arrays[name] for name in self._arguments), ctypes.byref(prepared), result)
        return Outcome(int(status), tuple(result))


def run_prepared(
    library: ctypes.CDLL,
    model: str,
    kernels: Sequence[Kernel],
    scalar: Scalar,
    samples: Sequence[Sample],
    alone: Mapping[str, Sequence[Outcome]],
    header: str,
) -> tuple[dict[str, list[Outcome]], list[Fault]]:
    """Outcomes of the prepared kernels that the header names, and faults where plain ones give something else."""
    (size,) = (int(text) for text in re.findall(r"value\[(\d+)\];", header))
    outcomes: dict[str, list[Outcome]] = {}
    faults = []
    for kernel in kernels:
        if f"{global_name(model, scalar, kernel.name, PREPARED)}(" not in header:
            continue
        prepared = PreparedFunction(library, model, kernel, scalar, size)
        plain = CFunction(library, model, kernel, scalar)
        place = kernel.name, f"C {scalar} prepared"
        outcomes[kernel.name] = [
            prepared(
                {a.name: c_array(scalar, entries(sample.state, a)) for a in array_arguments(kernel)},
                c_array(scalar, sample.state.parameters),
            )
            for sample in samples
        ]
        for k, (one, other) in enumerate(zip(alone[kernel.name], outcomes[kernel.name], strict=True)):
            if one.valid and one != other:
                faults.append(Fault(f"at state {k} the plain kernel gives something else", *place))
                break
        parameters = c_array(scalar, samples[0].state.parameters)
        for value in HARD:
            arrays: dict[str, Any] = {a.name: c_array(scalar, [value] * a.length) for a in array_arguments(kernel)}
            if plain(arrays, parameters).status != prepared(arrays, parameters).status:
                faults.append(Fault(f"other status than the plain kernel's where every input is {value}", *place))
    return outcomes, faults
