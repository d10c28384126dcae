"""C99 with sines and cosines from the caller: a struct of them by coordinate, and kernels that read it."""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.c.bodies.functions import kernel_function
from symgen.backends.c.endings import SINES_GIVEN
from symgen.backends.c.file import StructView, file_view, files
from symgen.backends.c.names import global_name, variant_names
from symgen.backends.comments import c_comment
from symgen.backends.quantities import IN_FORMS, meaning
from symgen.backends.scalars import file_stem
from symgen.ir.given_trig import GivenTrig, given_trig
from symgen.ir.kernel import Program
from symgen.model.model import Model

_ABOUT = (
    "Kernels of {header} that take sines and cosines from the caller: from an encoder, a table, or computed once",
    "for several kernels. The angles behind them may be of any size. Coordinates that enter elsewhere are read from q.",
)


def emit_c_sc(model: Model, program: Program) -> dict[str, str]:
    """`c/<model>_sc.h`, `.c` (float32: `_sc_f`), or nothing where no kernel has a sine of coordinates."""
    made = [made for kernel in program.kernels if kernel.name in IN_FORMS and (made := given_trig(kernel))]
    if not made:
        return {}
    kernels = tuple(one.kernel for one in made)
    struct, params = (global_name(model.c_name, program.scalar, kind) for kind in ("trig", "params"))
    names = variant_names(model, program, kernels, SINES_GIVEN, {"sc", struct})
    given = {"sc": f"const {struct} *sc", "p": f"const {params} *p"}
    functions = (kernel_function(model, program, k, names, meaning(k), given, SINES_GIVEN) for k in kernels)
    view = file_view(
        model,
        replace(program, kernels=kernels),
        SINES_GIVEN,
        tuple(line.format(header=f"{file_stem(model.c_name, program.scalar)}.h") for line in _ABOUT),
        tuple(functions),
        StructView(struct, _members(model, made), "Sines and cosines of coordinates."),
    )
    return files(view)


def _members(model: Model, made: list[GivenTrig]) -> tuple[str, ...]:
    """Sine and cosine of every coordinate that a kernel asks for, in the order of q."""
    indices = sorted({load.index for one in made for load in one.coordinates})
    halves = ((half, index, model.coordinates[index].name) for index in indices for half in ("sin", "cos"))
    return tuple(f"{half}_{name}; /**< {c_comment(f'{half}({name}), q[{index}]')} */" for half, index, name in halves)
