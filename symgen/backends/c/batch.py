"""C99 over many states at once: arrays of components, a loop without branches that compilers turn into vector code.

The loop computes the results of a block of states and one flag for each: every check passed and every result is
finite. The few states whose flag says no go through the kernel for one state, which alone tells statuses apart.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.c.pairs import pair_body
from symgen.backends.c.plain import c_members, status_name
from symgen.backends.comments import c_comment_lines
from symgen.backends.finite import rests
from symgen.backends.locals import Names, all_statements, array_arguments, names_of
from symgen.backends.quantities import BATCHED, meaning
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.backends.statements import CStatements
from symgen.ir.kernel import Check, Kernel, Local, Operand, Program, Statement, Status
from symgen.ir.split import names_in, names_of_blocks, split, without_first
from symgen.ir.wide_functions import works_with_pairs
from symgen.model.model import Model
from symgen.naming import macro_name
from symgen.records import dataclass

# States a block: local arrays of rows of this length; a multiple of every vector length in use.
BLOCK = 64
_OWN_NAMES = frozenset({"count", "stride", "status", "start", "length", "k", "i", "from", "copy", "result", "LANES"})
_OWN_NAMES |= {"flag", "flags", "bits", "code", "refused", "rest", "y"}


@dataclass(frozen=True, slots=True)
class ArgumentView:
    """An array argument: name, length, and the components that the kernel reads."""

    name: str
    length: int


@dataclass(frozen=True, slots=True)
class RowView:
    """A component that the loop reads: `argument[index]` of every state."""

    argument: str
    index: int


@dataclass(frozen=True, slots=True)
class BatchView:
    """One function: comment, prototype without semicolon, and what its template fills in."""

    comment: tuple[str, ...]
    prototype: str
    single: str
    arguments: tuple[ArgumentView, ...]
    rows: tuple[RowView, ...]
    output: str
    size: int
    fixed: tuple[str, ...]
    body: tuple[str, ...]
    one_by_one: bool


@dataclass(frozen=True, slots=True)
class BatchFileView:
    """Everything the templates of the batch files print."""

    stem: str
    guard: str
    plain_stem: str
    model: str
    scalar: str
    lane: str
    zero: str
    one: str
    ok: str
    block: int
    functions: tuple[BatchView, ...]
    inline: str
    pair: str
    angle: str
    pair_body: tuple[str, ...]
    ratio: str


def emit_c_batch(model: Model, program: Program) -> dict[str, str]:
    """`c/<model>_batch.h`, `.c` (float32: `_batch_f`), or nothing where the program has no quantity of `BATCHED`."""
    kernels = tuple(kernel for kernel in program.kernels if kernel.name in BATCHED)
    if not kernels:
        return {}
    suffix = SUFFIX[program.scalar]
    plain = model.c_name
    stem = f"{plain}_batch{suffix}"
    pair, ratio = f"{model.c_name}_sincos{suffix}", f"{model.c_name}_ratio{suffix}"
    inline = f"{macro_name(stem)}_INLINE"
    own = {f"{model.c_name}_{kernel.name}{tail}{suffix}" for kernel in program.kernels for tail in ("", "_batch")}
    own |= {pair, ratio, inline, f"{macro_name(stem)}_H", f"{model.c_name}_params{suffix}", *_OWN_NAMES}
    own |= {status_name(model, status) for status in Status}
    own |= {f"{argument.name}_one" for kernel in kernels for argument in kernel.arguments}
    # the members of the parameter struct are those of the other header
    few = replace(program, kernels=kernels)
    names = replace(names_of(model, few, own), members=c_members(model, program))
    in_lanes = [kernel for kernel in kernels if not works_with_pairs(kernel)]
    operations = {statement.operation for kernel in in_lanes for statement in all_statements(kernel)}
    own_pair = program.sincos if "sincos" in operations else None
    angle, body = ("", ()) if own_pair is None else pair_body(program.scalar, own_pair, pair)
    view = BatchFileView(
        stem=stem,
        guard=f"{macro_name(stem)}_H",
        plain_stem=f"{plain}{suffix}",
        model=model.c_name,
        scalar=C_TYPE[program.scalar],
        lane="int64_t" if program.scalar == "float64" else "int32_t",
        zero="0.0" if program.scalar == "float64" else "0.0f",
        one="1.0" if program.scalar == "float64" else "1.0f",
        ok=status_name(model, Status.OK),
        block=BLOCK,
        functions=tuple(_function(model, program, kernel, names, (pair, ratio), suffix) for kernel in kernels),
        inline=inline,
        pair=pair,
        angle=angle,
        pair_body=body,
        ratio=ratio if "ratio_or_zero" in operations else "",
    )
    return {
        f"c/{stem}.h": render("c/batch.h.jinja", view),
        f"c/{stem}.c": render("c/batch.c.jinja", view),
    }


def _function(
    model: Model, program: Program, kernel: Kernel, names: Names, private: tuple[str, str], suffix: str
) -> BatchView:
    scalar, output = C_TYPE[program.scalar], names.outputs[kernel.name]
    single = f"{model.c_name}_{kernel.name}{suffix}"
    arguments = tuple(ArgumentView(a.name, a.length) for a in array_arguments(kernel))
    given = ["size_t count", "size_t stride", *(f"const {scalar} *{a.name}" for a in arguments)]
    given += [f"const {model.c_name}_params{suffix} *p", f"{scalar} *{output}", "unsigned char *status"]
    name = f"{model.c_name}_{kernel.name}_batch{suffix}"
    by_pairs = works_with_pairs(kernel)
    flat = Kernel(kernel.name, (), (), (), (), ()) if by_pairs else without_first(kernel)
    parts = split(flat)
    pair, ratio = private
    own_pair = None if program.sincos is None else pair
    printer = _Lanes(CStatements(program.scalar, names.locals, _used(flat), own_pair), ratio)
    rows = [load for load in flat.loads if load.argument != "p"]
    fixed = [
        f"const {scalar} {names.locals[load.local]} = p->{names.members[load.member]};"
        for load in flat.loads
        if load.argument == "p"
    ]
    fixed += [line for statement in parts.fixed for line in printer.statement(statement)]
    body = [f"const {scalar} {names.locals[load.local]} = from[{k}][k];" for k, load in enumerate(rows)]
    body += [line for block in parts.blocks for statement in block.statements for line in printer.statement(statement)]
    body += printer.flag([check for block in parts.blocks for check in block.checks], flat.outputs)
    body += [f"result[{k}][k] = {printer.plain.operand(operand)};" for k, operand in enumerate(flat.outputs)]
    return BatchView(
        comment=c_comment_lines(f"{meaning(kernel)}; {output} has {len(kernel.outputs)} rows"),
        prototype=f"size_t {name}({', '.join(given)})",
        single=single,
        arguments=arguments,
        rows=tuple(RowView(load.argument, load.index) for load in rows),
        output=output,
        size=len(kernel.outputs),
        fixed=tuple(fixed),
        body=tuple(body),
        one_by_one=by_pairs,
    )


def _used(kernel: Kernel) -> frozenset[str]:
    return frozenset(names_of_blocks(kernel.blocks) | names_in(kernel.outputs))


@dataclass(frozen=True, slots=True)
class _Lanes:
    """Prints statements without branches, and checks as terms of one flag."""

    plain: CStatements
    ratio: str

    def statement(self, statement: Statement) -> tuple[str, ...]:
        """One statement as lines; a division that may be left out is a function without branches."""
        if statement.operation != "ratio_or_zero":
            return self.plain.statement(statement)
        operands = ", ".join(map(self.plain.operand, statement.operands))
        name = self.plain.names[statement.targets[0]]
        return (f"const {C_TYPE[self.plain.scalar]} {name} = {self.ratio}({operands});",)

    def flag(self, checks: list[Check], outputs: tuple[Operand, ...]) -> list[str]:
        """The lines that make `flag[k]`: 0 where every check passes and every result is finite."""
        plain = self.plain
        zero, one = ("0.0", "1.0") if plain.scalar == "float64" else ("0.0f", "1.0f")
        results = [plain.names[o.name] for o in dict.fromkeys(outputs) if isinstance(o, Local)]
        rest = " + ".join(rests(results)) or zero
        lines = [f"{C_TYPE[plain.scalar]} rest = {rest};"]
        for check in checks:
            relation = ">=" if check.inclusive else ">"
            # a sum leaves nothing to skip, so the loop stays free of branches
            passes = f"{plain.operand(check.value)} {relation} {plain.operand(check.limit)}"
            lines.append(f"rest += {passes} ? {zero} : {one};")
        return [*lines, "flag[k] = rest;"]
