"""C99 with sines and cosines from the caller: a struct of them by coordinate, and kernels that read it."""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.c.causes import cause_names
from symgen.backends.c.lanes import each_macro
from symgen.backends.c.pairs import PairsView, pair_names, pairs_view
from symgen.backends.c.plain import FunctionView, c_names, kernel_body, kernel_causes, status_name, uses_library
from symgen.backends.c.surroundings import LibraryPair, apart_macro, library_pair, rare_macro, surrounding_names
from symgen.backends.comments import c_comment, c_comment_lines
from symgen.backends.locals import Names, array_arguments, names_of
from symgen.backends.quantities import BATCHED, meaning
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.ir.given_trig import GivenTrig, given_trig
from symgen.ir.kernel import Kernel, Program, Status
from symgen.model.model import Model
from symgen.naming import macro_name
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class GivenTrigView:
    """Everything the templates of the files print; `members` are names with comments."""

    stem: str
    guard: str
    plain_stem: str
    scalar: str
    struct: str
    members: tuple[tuple[str, str], ...]
    functions: tuple[FunctionView, ...]
    pairs: PairsView | None
    both: LibraryPair | None
    rare: str
    each: str
    apart: str
    includes_math: bool


def emit_c_sc(model: Model, program: Program) -> dict[str, str]:
    """`c/<model>_sc.h`, `.c` (float32: `_sc_f`), or nothing where no kernel has a sine of coordinates."""
    given = [made for kernel in program.kernels if kernel.name in BATCHED and (made := given_trig(kernel))]
    if not given:
        return {}
    suffix = SUFFIX[program.scalar]
    plain = model.c_name
    stem, struct = f"{plain}_sc{suffix}", f"{model.c_name}_trig{suffix}"
    whole = replace(program, kernels=tuple(made.kernel for made in given))
    own = {"sc", struct}
    for kernel in whole.kernels:
        function = f"{model.c_name}_{kernel.name}_sc{suffix}"
        own |= {function, *cause_names(kernel, function)}
    own |= pair_names(model.c_name, suffix) | surrounding_names(model.c_name, suffix)
    own |= {status_name(model, status) for status in Status}
    # the members of the parameter struct are those of the other header
    names = replace(names_of(model, whole, own), members=c_names(model, program).members)
    view = GivenTrigView(
        stem=stem,
        guard=f"{macro_name(stem)}_H",
        plain_stem=plain + suffix,
        scalar=C_TYPE[program.scalar],
        struct=struct,
        members=_members(model, given),
        functions=tuple(_function(model, program, kernel, names, struct, suffix) for kernel in whole.kernels),
        pairs=pairs_view(model.c_name, suffix, whole),
        both=library_pair(model.c_name, whole),
        rare=rare_macro(model.c_name, whole),
        each=each_macro(model.c_name, whole),
        apart=apart_macro(model.c_name, whole),
        includes_math=uses_library(whole),
    )
    return {f"c/{stem}.h": render("c/sc.h.jinja", view), f"c/{stem}.c": render("c/sc.c.jinja", view)}


def _members(model: Model, given: list[GivenTrig]) -> tuple[tuple[str, str], ...]:
    """Sine and cosine of every coordinate that a kernel asks for, in the order of q."""
    indices = sorted({load.index for made in given for load in made.coordinates})
    return tuple(
        (f"{half}_{model.coordinates[index].name}", c_comment(f"{half}({model.coordinates[index].name}), q[{index}]"))
        for index in indices
        for half in ("sin", "cos")
    )


def _function(model: Model, program: Program, kernel: Kernel, names: Names, struct: str, suffix: str) -> FunctionView:
    scalar, output = C_TYPE[program.scalar], names.outputs[kernel.name]
    arguments = [f"const {struct} *sc"]
    arguments += [f"const {scalar} {argument.name}[{argument.length}]" for argument in array_arguments(kernel)]
    arguments += [f"const {model.c_name}_params{suffix} *p", f"{scalar} {output}[{len(kernel.outputs)}]"]
    function = f"{model.c_name}_{kernel.name}_sc{suffix}"
    types = {"sc": f"const {struct} *sc", "p": f"const {model.c_name}_params{suffix} *p"}
    return FunctionView(
        c_comment_lines(meaning(kernel)),
        f"{model.c_name}_status {function}({', '.join(arguments)})",
        kernel_body(model, program, kernel, names, function),
        kernel_causes(model, program, kernel, names, function, types),
    )
