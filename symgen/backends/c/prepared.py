"""C99 with the work on parameters taken out: a struct made once for each set of parameters, kernels that read it."""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.c.causes import cause_names
from symgen.backends.c.lanes import each_macro
from symgen.backends.c.pairs import PairsView, pair_names, pairs_view
from symgen.backends.c.plain import FunctionView, c_members, kernel_body, kernel_causes, status_name, uses_library
from symgen.backends.c.surroundings import LibraryPair, apart_macro, library_pair, rare_macro, surrounding_names
from symgen.backends.comments import c_comment_lines
from symgen.backends.locals import Names, array_arguments, names_of
from symgen.backends.operations import count_operations
from symgen.backends.quantities import BATCHED, meaning
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.backends.statements import CStatements
from symgen.ir.kernel import Block, Kernel, Program, Status
from symgen.ir.prepare import Prepared, prepare
from symgen.model.model import Model
from symgen.naming import macro_name
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class PreparedView:
    """Everything the templates of the prepared files print."""

    stem: str
    guard: str
    plain_stem: str
    scalar: str
    struct: str
    size: int
    prepare: str
    prepare_body: tuple[str, ...]
    functions: tuple[FunctionView, ...]
    pairs: PairsView | None
    both: LibraryPair | None
    rare: str
    each: str
    apart: str
    includes_math: bool


def emit_c_prepared(model: Model, program: Program) -> dict[str, str]:
    """`c/<model>_prepared.h`, `.c` (float32: `_prepared_f`), or nothing where no kernel would save enough."""
    prepared = prepare(program, BATCHED)
    if prepared is None:
        return {}
    suffix = SUFFIX[program.scalar]
    plain = model.c_name
    stem = f"{plain}_prepared{suffix}"
    once = Kernel("prepare", (), prepared.loads, (Block(prepared.statements, ()),), prepared.values, ())
    whole = replace(program, kernels=(*prepared.kernels, once))
    # the functions of one angle at a time are those that the lines of `prepare` call
    pairs = pairs_view(model.c_name, suffix, whole)
    if pairs is not None and any(statement.operation == "sincos" for statement in prepared.statements):
        pairs = replace(pairs, single=f"{model.c_name}_sincos{suffix}")
    names = _names(model, program, whole, prepared, suffix)
    struct = f"{model.c_name}_prepared{suffix}"
    stated = replace(program, kernels=prepared.kernels)
    view = PreparedView(
        stem=stem,
        guard=f"{macro_name(stem)}_H",
        plain_stem=plain + suffix,
        scalar=C_TYPE[program.scalar],
        struct=struct,
        size=len(prepared.values),
        prepare=f"{struct} {model.c_name}_prepare{suffix}(const {model.c_name}_params{suffix} *p)",
        prepare_body=_prepare_body(model, program, prepared, names, suffix),
        functions=tuple(_function(model, program, kernel, names, struct, suffix) for kernel in prepared.kernels),
        pairs=pairs,
        both=library_pair(model.c_name, stated),
        rare=rare_macro(model.c_name, stated),
        each=each_macro(model.c_name, stated),
        apart=apart_macro(model.c_name, stated),
        includes_math=uses_library(whole),
    )
    return {
        f"c/{stem}.h": render("c/prepared.h.jinja", view),
        f"c/{stem}.c": render("c/prepared.c.jinja", view),
    }


def _names(model: Model, program: Program, whole: Program, prepared: Prepared, suffix: str) -> Names:
    own = {"prepared"}
    for kernel in prepared.kernels:
        function = f"{model.c_name}_{kernel.name}_prepared{suffix}"
        own |= {function, *cause_names(kernel, function)}
    own |= {f"{model.c_name}_{name}{suffix}" for name in ("prepared", "prepare", "params")}
    own |= pair_names(model.c_name, suffix) | surrounding_names(model.c_name, suffix)
    own |= {status_name(model, status) for status in Status}
    members = {f"value[{k}]": f"value[{k}]" for k in range(len(prepared.values))}
    # the members of the parameter struct are those of the other header
    return replace(names_of(model, whole, own), members=members | c_members(model, program))


def _prepare_body(model: Model, program: Program, prepared: Prepared, names: Names, suffix: str) -> tuple[str, ...]:
    scalar = C_TYPE[program.scalar]
    sincos = None if program.sincos is None else f"{model.c_name}_sincos{suffix}"
    targets = {target for statement in prepared.statements for target in statement.targets}
    printer = CStatements(program.scalar, names.locals, targets, sincos)
    lines = [] if prepared.loads else ["(void)p;"]
    lines += [
        f"const {scalar} {names.locals[load.local]} = p->{names.members[load.member]};" for load in prepared.loads
    ]
    lines += [line for statement in prepared.statements for line in printer.statement(statement)]
    lines.append(f"{model.c_name}_prepared{suffix} prepared;")
    lines += [f"prepared.value[{k}] = {printer.operand(value)};" for k, value in enumerate(prepared.values)]
    return (*lines, "return prepared;")


def _function(model: Model, program: Program, kernel: Kernel, names: Names, struct: str, suffix: str) -> FunctionView:
    scalar, output = C_TYPE[program.scalar], names.outputs[kernel.name]
    arguments = [f"const {scalar} {argument.name}[{argument.length}]" for argument in array_arguments(kernel)]
    arguments += [f"const {struct} *p", f"{scalar} {output}[{len(kernel.outputs)}]"]
    name = f"{model.c_name}_{kernel.name}_prepared{suffix}"
    (plain,) = (k for k in program.kernels if k.name == kernel.name)
    now, before = (count_operations(k.statements).total for k in (kernel, plain))
    comment = c_comment_lines(f"{meaning(kernel)}; {now} operations instead of {before}")
    body = kernel_body(model, program, kernel, names, name)
    causes = kernel_causes(model, program, kernel, names, name, {"p": f"const {struct} *p"})
    return FunctionView(comment, f"{model.c_name}_status {name}({', '.join(arguments)})", body, causes)
