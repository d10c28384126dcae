"""The functions with several results of generated C: the bits and statuses of the kernels alone, at every state."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping, Sequence
from typing import Any

from symgen.backends.c.endings import TOGETHER
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.ir.together import Together, together_of
from symgen.model.model import Model
from symgen.verify.certificate import Fault
from symgen.verify.given import entries
from symgen.verify.running.batch import HARD
from symgen.verify.running.compile import C_TYPES, CFunction, Outcome, c_array
from symgen.verify.sampling.states import Sample


class FunctionOfSeveral:
    """One function with several results of a library."""

    def __init__(self, library: ctypes.CDLL, model: str, one: Together, scalar: Scalar) -> None:
        self._function = library[global_name(model, scalar, one.kernel.name, TOGETHER)]
        self._function.restype = ctypes.c_int
        self._arguments = tuple(argument.name for argument in array_arguments(one.kernel))
        self._results = [C_TYPES[scalar] * math.prod(part.shape) for part in one.parts]

    def __call__(self, arrays: dict[str, Any], parameters: Any) -> list[Outcome]:
        """What it makes of each quantity, on C arrays made by `c_array`."""
        results = [kind(*([math.nan] * kind._length_)) for kind in self._results]
        status = self._function(*(arrays[name] for name in self._arguments), parameters, *results)
        return [Outcome(int(status), tuple(result)) for result in results]


def run_several(
    library: ctypes.CDLL,
    model: Model,
    kernels: Sequence[Kernel],
    scalar: Scalar,
    samples: Sequence[Sample],
    alone: Mapping[str, Sequence[Outcome]],
    header: str,
) -> tuple[dict[str, list[Outcome]], list[Fault]]:
    """Outcomes of the functions that the header names, and faults where kernels alone give something else."""
    outcomes: dict[str, list[Outcome]] = {}
    faults = []
    for one in together_of(model.together, Program(scalar, None, tuple(kernels))):
        group = [part.name for part in one.parts]
        if f"{global_name(model.c_name, scalar, one.kernel.name, TOGETHER)}(" not in header:
            continue
        several = FunctionOfSeveral(library, model.c_name, one, scalar)
        made: list[list[Outcome]] = []
        for sample in samples:
            given: dict[str, Any] = {
                a.name: c_array(scalar, entries(sample.state, a)) for a in array_arguments(one.kernel)
            }
            made.append(several(given, c_array(scalar, sample.state.parameters)))
        place = group[0], f"C {scalar} together"
        by_themselves = list(zip(*(alone[name] for name in group), strict=True))
        differing = (k for k, pair in enumerate(zip(by_themselves, made, strict=True)) if _differ(*pair))
        faults += [Fault(f"state {k} alone and in one call differ", *place) for k in list(differing)[:1]]
        outcomes |= {name: list(column) for name, column in zip(group, zip(*made, strict=True), strict=True)}
        singles = [CFunction(library, model.c_name, part, scalar) for part in one.parts]
        parameters = c_array(scalar, samples[0].state.parameters)
        for value in HARD:
            arrays: dict[str, Any] = {a.name: c_array(scalar, [value] * a.length) for a in array_arguments(one.kernel)}
            if _differ([single(arrays, parameters) for single in singles], several(arrays, parameters)):
                faults.append(Fault(f"alone and in one call differ where every input is {value}", *place))
    return outcomes, faults


def _differ(alone: Sequence[Outcome], made: Sequence[Outcome]) -> bool:
    """Whether one call makes something else: another status, other bits with status 0, or anything with another."""
    expected = _first([outcome.status for outcome in alone])
    if any(outcome.status != expected for outcome in made):
        return True
    if expected == Status.OK:
        return any(one != other for one, other in zip(alone, made, strict=True))
    return not all(math.isnan(entry) for outcome in made for entry in outcome.entries)


def _first(statuses: Sequence[int]) -> int:
    """The status of all: the first that a test gives; that results are not finite where none does, else 0."""
    tested = [status for status in statuses if status not in (Status.OK, Status.NOT_FINITE)]
    return tested[0] if tested else max(statuses)
