"""The C for one state in the folder of another backend, which so builds by itself."""

from __future__ import annotations

from symgen.backends.backend import Emit
from symgen.backends.c.plain import emit_c
from symgen.ir.kernel import Program
from symgen.model.model import Model


def emit_c_into(folder: str) -> Emit:
    """What prints `<folder>/<model>.h` and `.c`, with the text of those in `c/`."""

    def emit(model: Model, program: Program) -> dict[str, str]:
        return {f"{folder}/{path.rpartition('/')[2]}": text for path, text in emit_c(model, program).items()}

    return emit
