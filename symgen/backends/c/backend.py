"""C99: one state, many states, prepared parameters, given sines, several results; each in float64 and float32."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.endings import BATCH, PREPARED, SINES_GIVEN, TOGETHER
from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.backends.c.together import emit_c_together

VARIANTS = (
    Variant(emit_c),
    Variant(emit_c_batch, BATCH),
    Variant(emit_c_prepared, PREPARED),
    Variant(emit_c_sc, SINES_GIVEN),
    Variant(emit_c_together, TOGETHER),
)
BACKEND = Backend("c", "C", VARIANTS, (".h", ".c"), "c")
