"""The C that is called: the files for one state in float64, so that the folder builds by itself."""

from __future__ import annotations

from symgen.backends.c.backend import BACKEND as C
from symgen.backends.c.plain import emit_c
from symgen.ir.kernel import Program
from symgen.model.model import Model


def emit_kernels(model: Model, program: Program) -> dict[str, str]:
    """`matlab/<model>.h` and `.c`, with the text of those in `c/`."""
    return {f"matlab/{path.removeprefix(f'{C.name}/')}": text for path, text in emit_c(model, program).items()}
