"""MATLAB and Octave: the kernels for one state in float64, called for any number of states at once."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.matlab.functions import emit_functions
from symgen.backends.matlab.kernels import emit_kernels

BACKEND = Backend(
    "matlab",
    "MATLAB",
    (Variant(emit_kernels),),
    (".h", ".c"),
    "c",
    of_each_scalar=False,
    around=emit_functions,
)
