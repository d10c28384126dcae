"""MATLAB and Octave: the kernels for one state in float64, called for any number of states at once."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.c.elsewhere import emit_c_into
from symgen.backends.matlab.functions import emit_functions

BACKEND = Backend(
    "matlab",
    "MATLAB",
    (Variant(emit_c_into("matlab")),),
    (".h", ".c"),
    "c",
    of_each_scalar=False,
    around=emit_functions,
)
