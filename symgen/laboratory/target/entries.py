"""What the driver calls: the functions of the generated files, by kernel and by form (plain, prepared, sines given)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symgen.backends.c.endings import PREPARED, SINES_GIVEN
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.backends.quantities import IN_FORMS
from symgen.backends.scalars import C_TYPE, file_stem
from symgen.ir.given_trig import given_trig
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.prepare import prepare
from symgen.model.model import Model


@dataclass(frozen=True, slots=True)
class Entry:
    """One function of generated C: its kernel, whose `name` is the quantity, and the text of a call.

    `plain` is the kernel of the same quantity that works on the state alone; `unit` the source file without its ending.
    """

    kernel: Kernel
    plain: Kernel
    form: str
    function: str
    call: str
    unit: str

    @property
    def name(self) -> str:
        """The quantity, with the ending of its form."""
        return self.kernel.name + self.form

    @property
    def size(self) -> int:
        """How many numbers it returns."""
        return max(1, math.prod(self.kernel.shape))


@dataclass(frozen=True, slots=True)
class Entries:
    """The functions of one scalar type; `given` are the places in q whose sines and cosines some of them take."""

    scalar: Scalar
    functions: tuple[Entry, ...]
    given: tuple[int, ...] = ()

    @property
    def prepared(self) -> bool:
        """Whether a function takes parameters prepared."""
        return any(entry.form == PREPARED for entry in self.functions)


def plain_entries(model: Model, program: Program) -> Entries:
    """The kernels of `c/<model>.c`."""
    functions = tuple(_entry(model, program.scalar, kernel, kernel, "") for kernel in program.kernels)
    return Entries(program.scalar, functions)


def with_companions(model: Model, entries: Entries, program: Program) -> Entries:
    """Those of the prepared and `_sc` files of a program as well."""
    plain = {kernel.name: kernel for kernel in program.kernels}
    prepared = prepare(program, IN_FORMS)
    ready = () if prepared is None else prepared.kernels
    given = [made for kernel in program.kernels if kernel.name in IN_FORMS and (made := given_trig(kernel))]
    functions = (
        *entries.functions,
        *(_entry(model, program.scalar, kernel, plain[kernel.name], PREPARED) for kernel in ready),
        *(_entry(model, program.scalar, made.kernel, plain[made.kernel.name], SINES_GIVEN) for made in given),
    )
    places = sorted({load.index for made in given for load in made.coordinates})
    return Entries(program.scalar, functions, tuple(places))


def _entry(model: Model, scalar: Scalar, kernel: Kernel, plain: Kernel, form: str) -> Entry:
    kind, function = C_TYPE[scalar], global_name(model.c_name, scalar, kernel.name, form)
    arguments = [f"&sc_{kind}"] if form == SINES_GIVEN else []
    arguments += [f"row_{kind}.{argument.name}" for argument in array_arguments(kernel)]
    arguments += [f"&ready_{kind}" if form == PREPARED else f"&p_{kind}", f"y_{kind}"]
    call = f"{function}({', '.join(arguments)})"
    return Entry(kernel, plain, form, function, call, file_stem(model.c_name, scalar, form))
