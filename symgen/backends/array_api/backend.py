"""Pure functions on the array API, in float64 and float32; the kernels are those of the Python module."""

from __future__ import annotations

from symgen.backends.array_api.module import emit_array_api
from symgen.backends.backend import Backend, Variant

BACKEND = Backend("array_api", "array API", (Variant(emit_array_api),), (".py",), "python")
