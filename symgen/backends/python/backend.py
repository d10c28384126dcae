"""Python: one module of NumPy in float64, for one state or arrays of them."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.python.module import emit_python

BACKEND = Backend("python", "Python", (Variant(emit_python),), (".py",), "python", of_each_scalar=False)
