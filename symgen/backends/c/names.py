"""What the generated C calls things: its files' own names, and those inside of its functions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from symgen.backends.c.causes import cause_names
from symgen.backends.c.lanes import lane_names
from symgen.backends.c.pairs import pair_names
from symgen.backends.c.reserved import is_taken
from symgen.backends.c.steps import local_names
from symgen.backends.c.surroundings import surrounding_names
from symgen.backends.locals import Names, names_of
from symgen.backends.scalars import SUFFIX
from symgen.ir.kernel import Kernel, Program, Status
from symgen.model.model import Model
from symgen.naming import macro_name

_INSIDE = ("rest", "term", "angle", "sine", "cosine")


def status_name(model: Model, status: Status) -> str:
    """The enumerator of a status."""
    return f"{macro_name(model.c_name)}_{status.name}"


def function_name(model: Model, program: Program, kernel: Kernel, ending: str = "") -> str:
    """The function of a kernel; `ending` tells the variants apart."""
    return f"{model.c_name}_{kernel.name}{ending}{SUFFIX[program.scalar]}"


def struct_name(model: Model, program: Program, kind: str) -> str:
    """A type or a function of the file: `kind` is params, default_params, prepared, ..."""
    return f"{model.c_name}_{kind}{SUFFIX[program.scalar]}"


def guard(stem: str) -> str:
    """The macro that a header defines."""
    return f"{macro_name(stem)}_H"


def c_names(model: Model, program: Program) -> Names:
    """Every name of the program's C for one state."""
    return names_in_file(model, program, _own_names(model, program))


def c_members(model: Model, program: Program) -> dict[str, str]:
    """The members of the parameter struct, by parameter: what other files that use the header call them."""
    return names_in_file(model, replace(program, kernels=()), _own_names(model, program)).members


def variant_names(
    model: Model, program: Program, kernels: tuple[Kernel, ...], ending: str, own: Iterable[str]
) -> Names:
    """Names of a file with a variant of kernels; the members of the parameter struct are those of the other header."""
    made = replace(program, kernels=kernels)
    names = names_in_file(model, made, {*own, *_of_functions(model, made, ending)})
    return replace(names, members=c_members(model, program))


def names_in_file(model: Model, program: Program, own: Iterable[str]) -> Names:
    """Names of a file whose global names are `own`."""
    return names_of(model, program, is_taken, own, {*_INSIDE, *lane_names(program), *local_names(program)})


def _own_names(model: Model, program: Program) -> set[str]:
    own = {struct_name(model, program, kind) for kind in ("params", "default_params")}
    own |= {f"{model.c_name}_status", f"{macro_name(model.c_name)}_STATUS_DEFINED"}
    return own | _of_functions(model, program, "")


def _of_functions(model: Model, program: Program, ending: str) -> set[str]:
    """The functions of a file for one state, and what stands before them."""
    prefix, suffix = model.c_name, SUFFIX[program.scalar]
    names = {guard(f"{prefix}{ending}{suffix}")} | pair_names(prefix, suffix) | surrounding_names(prefix, suffix)
    names |= {status_name(model, status) for status in Status}
    for kernel in program.kernels:
        function = function_name(model, program, kernel, ending)
        names |= {function, *cause_names(kernel, function)}
    return names
