"""The kernels of generated C that take sines and cosines from the caller, given the exact ones, rounded once."""

from __future__ import annotations

import ctypes
import math
import re
from collections.abc import Sequence
from typing import Any

from flint import arb, ctx

from symgen.backends.c.endings import SINES_GIVEN
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel, Scalar
from symgen.model.model import Model
from symgen.verify.given import entries
from symgen.verify.running.compile import C_TYPES, Outcome, c_array
from symgen.verify.sampling.states import Sample

# Binary digits of the sines and cosines before they are rounded once.
TRIG_BITS = 160


def exact_trig(model: Model, header: str, q: Sequence[Any]) -> list[float]:
    """The members of the struct that the header declares, at a configuration, rounded to double precision."""
    places = {coordinate.name: index for index, coordinate in enumerate(model.coordinates)}
    previous, ctx.prec = ctx.prec, TRIG_BITS
    try:
        members = re.findall(r"^    (?:double|float) (sin|cos)_(\w+);", header, re.MULTILINE)
        return [float(getattr(arb(float(q[places[name]])), half)()) for half, name in members]
    finally:
        ctx.prec = previous


def run_given_trig(
    library: ctypes.CDLL,
    model: Model,
    kernels: Sequence[Kernel],
    scalar: Scalar,
    samples: Sequence[Sample],
    header: str,
) -> dict[str, list[Outcome]]:
    """Outcomes of the kernels that the header names."""
    outcomes: dict[str, list[Outcome]] = {}
    for kernel in kernels:
        name = global_name(model.c_name, scalar, kernel.name, SINES_GIVEN)
        if f"{name}(" not in header:
            continue
        function = library[name]
        function.restype = ctypes.c_int
        kind = C_TYPES[scalar] * math.prod(kernel.shape)
        outcomes[kernel.name] = []
        for sample in samples:
            state = sample.state
            given = c_array(scalar, exact_trig(model, header, state.q))
            arrays: list[Any] = [c_array(scalar, entries(state, a)) for a in array_arguments(kernel)]
            result = kind(*([math.nan] * kind._length_))
            status = function(given, *arrays, c_array(scalar, state.parameters), result)
            outcomes[kernel.name].append(Outcome(int(status), tuple(result)))
    return outcomes
