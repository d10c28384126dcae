"""What the generated C calls things: its files' own names, and those inside of its functions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from symgen.backends.c.bodies.causes import cause_names
from symgen.backends.c.bodies.pairs import pair_names
from symgen.backends.c.bodies.steps import local_names
from symgen.backends.c.identity import identity_names
from symgen.backends.c.reserved import is_taken
from symgen.backends.c.surroundings import surrounding_names
from symgen.backends.locals import Names, names_of
from symgen.backends.scalars import SUFFIX, file_stem
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.model.model import Model
from symgen.naming import macro_name

_INSIDE = ("rest", "term", "angle", "sine", "cosine")


def status_name(model: Model, status: Status) -> str:
    """The enumerator of a status."""
    return f"{macro_name(model.c_name)}_{status.name}"


def global_name(model: str, scalar: Scalar, what: str, ending: str = "") -> str:
    """A function or type: `what` is a quantity, params, default_params, prepared, ...; `ending` tells variants apart.

    `model` is what names of the model begin with.
    """
    return f"{model}_{what}{ending}{SUFFIX[scalar]}"


def guard(stem: str) -> str:
    """The macro that a header defines."""
    return f"{macro_name(stem)}_H"


def defined_macro(model: Model) -> str:
    """The macro that says that what both scalar types have in common is defined."""
    return f"{macro_name(model.c_name)}_MODEL_DEFINED"


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
    return names_of(model, program, is_taken, own, {*_INSIDE, *local_names(program)})


def _own_names(model: Model, program: Program) -> set[str]:
    own = {global_name(model.c_name, program.scalar, kind) for kind in ("params", "default_params")}
    own |= {f"{model.c_name}_status", defined_macro(model), *identity_names(model, program)}
    return own | _of_functions(model, program, "")


def _of_functions(model: Model, program: Program, ending: str) -> set[str]:
    """The functions of a file for one state, and what stands before them."""
    prefix, suffix = model.c_name, SUFFIX[program.scalar]
    names = {guard(file_stem(prefix, program.scalar, ending))}
    names |= pair_names(prefix, suffix) | surrounding_names(prefix, suffix)
    names |= {status_name(model, status) for status in Status}
    for kernel in program.kernels:
        function = global_name(prefix, program.scalar, kernel.name, ending)
        names |= {function, *cause_names(kernel, function)}
    return names
