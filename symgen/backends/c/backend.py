"""C99: one state at a time, many states, prepared parameters, given sines; each in float64 and float32."""

from __future__ import annotations

from symgen.backends.backend import Backend
from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared

BACKEND = Backend("c", "C", (emit_c, emit_c_batch, emit_c_prepared, emit_c_sc), "c")
