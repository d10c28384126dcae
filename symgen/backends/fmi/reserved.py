"""Words of FMI: its macros, what importers call the time, and the headers that lie beside those of a model."""

from __future__ import annotations

from symgen.registered import Words, words

TIME = "time"
_MACROS = words("fmi2Version fmi2TypesPlatform fmi3Version FMI2_Export FMI3_Export")
WORDS = Words(dict.fromkeys(sorted(_MACROS), "a macro of FMI"), lambda name: name == TIME, words("fmi2 fmi3"))
