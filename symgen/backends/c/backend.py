"""C99: one state at a time, many states, prepared parameters, given sines; each in float64 and float32."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.c import batch, given_sines, prepared
from symgen.backends.c.plain import emit_c

VARIANTS = (
    Variant(emit_c),
    Variant(batch.emit_c_batch, batch.ENDING),
    Variant(prepared.emit_c_prepared, prepared.ENDING),
    Variant(given_sines.emit_c_sc, given_sines.ENDING),
)
BACKEND = Backend("c", "C", VARIANTS, (".h", ".c"), "c")
