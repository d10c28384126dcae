"""FMI: the kernels for one state in float64, inside of functional mock-up units."""

from __future__ import annotations

from symgen.backends.backend import Backend, Variant
from symgen.backends.c.elsewhere import emit_c_into
from symgen.backends.fmi.mockup_units import emit_mockup_units, lacking_quantities

BACKEND = Backend(
    "fmi",
    "FMI",
    (Variant(emit_c_into("fmi/sources")),),
    (".h", ".c"),
    "c",
    of_each_scalar=False,
    folder="fmi/sources",
    around=emit_mockup_units,
    lacks=lacking_quantities,
)
