"""C99 with the work on parameters taken out: a struct made once for each set of parameters, kernels that read it."""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.c.bodies.functions import CFunctionView, kernel_function
from symgen.backends.c.bodies.pairs import pairs_view
from symgen.backends.c.endings import PREPARED
from symgen.backends.c.file import StructView, file_view, files
from symgen.backends.c.names import global_name, variant_names
from symgen.backends.c.statements import CStatements
from symgen.backends.locals import Names
from symgen.backends.operations import count_operations
from symgen.backends.quantities import IN_FORMS, meaning
from symgen.backends.scalars import C_TYPE, SUFFIX, file_stem
from symgen.ir.kernel import Block, Kernel, Program
from symgen.ir.prepare import Prepared, prepare
from symgen.model.model import Model

_ABOUT = (
    "Kernels of {header} with the work that depends on parameters done once: call the first function for each",
    "set of parameters and hand its result to the others. Same results, bit for bit; same statuses.",
)


def emit_c_prepared(model: Model, program: Program) -> dict[str, str]:
    """`c/<model>_prepared.h`, `.c` (float32: `_prepared_f`), or nothing where no kernel would save enough."""
    prepared = prepare(program, IN_FORMS)
    if prepared is None:
        return {}
    kinds = ("prepared", "params", "prepare")
    struct, params, make = (global_name(model.c_name, program.scalar, kind) for kind in kinds)
    once = Kernel("prepare", (), prepared.loads, (Block(prepared.statements, ()),), prepared.values, ())
    kernels = (*prepared.kernels, once)
    names = variant_names(model, program, kernels, PREPARED, {"prepared", struct, params, make})
    values = {f"value[{k}]": f"value[{k}]" for k in range(len(prepared.values))}
    before = {kernel.name: count_operations(kernel.statements).total for kernel in program.kernels}
    placed, given = replace(names, members=names.members | values), {"p": f"const {struct} *p"}

    def function(kernel: Kernel) -> CFunctionView:
        now = count_operations(kernel.statements).total
        about = f"{meaning(kernel)}; {now} operations instead of {before[kernel.name]}"
        return kernel_function(model, program, kernel, placed, about, given, PREPARED)

    about = ("What the parameters determine, worked out once.",)
    made = CFunctionView(about, f"{struct} {make}(const {params} *p)", _lines(model, program, prepared, names, struct))
    view = file_view(
        model,
        replace(program, kernels=prepared.kernels),
        PREPARED,
        tuple(line.format(header=f"{file_stem(model.c_name, program.scalar)}.h") for line in _ABOUT),
        (made, *map(function, prepared.kernels)),
        StructView(
            struct,
            (f"value[{len(prepared.values)}]; /**< in no order that a caller can use */",),
            "What the parameters determine.",
        ),
    )
    # the functions of one angle at a time are those that the lines of `prepare` call
    pairs = pairs_view(model.c_name, SUFFIX[program.scalar], replace(program, kernels=kernels))
    if pairs is not None and any(statement.operation == "sincos" for statement in prepared.statements):
        pairs = replace(pairs, single=global_name(model.c_name, program.scalar, "sincos"))
    return files(replace(view, pairs=pairs))


def _lines(model: Model, program: Program, prepared: Prepared, names: Names, struct: str) -> tuple[str, ...]:
    """The body of the function that prepares."""
    scalar = C_TYPE[program.scalar]
    sincos = None if program.sincos is None else global_name(model.c_name, program.scalar, "sincos")
    targets = {target for statement in prepared.statements for target in statement.targets}
    printer = CStatements(program.scalar, names.locals, targets, sincos)
    lines = [] if prepared.loads else ["(void)p;"]
    lines += [
        f"const {scalar} {names.locals[load.local]} = p->{names.members[load.member]};" for load in prepared.loads
    ]
    lines += [line for statement in prepared.statements for line in printer.statement(statement)]
    lines.append(f"{struct} prepared;")
    lines += [f"prepared.value[{k}] = {printer.operand(value)};" for k, value in enumerate(prepared.values)]
    return (*lines, "return prepared;")
