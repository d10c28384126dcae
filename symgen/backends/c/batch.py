"""C99 over many states at once: arrays of components, a loop without branches that compilers turn into vector code.

The loop computes the results of a block of states and one flag for each: every check passed and every result is
finite. The few states whose flag says no go through the kernel for one state, which alone tells statuses apart.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.backends.c.bodies.finite import rests
from symgen.backends.c.bodies.functions import CFunctionView
from symgen.backends.c.bodies.pairs import pair_body
from symgen.backends.c.endings import BATCH
from symgen.backends.c.file import file_view, files
from symgen.backends.c.names import c_members, global_name, guard, names_in_file, status_name
from symgen.backends.c.statements import CStatements, c_literal
from symgen.backends.comments import c_comment_lines
from symgen.backends.locals import Names, all_statements, array_arguments
from symgen.backends.quantities import BATCHED, meaning
from symgen.backends.scalars import C_TYPE, file_stem
from symgen.ir.kernel import Argument, Check, Kernel, Load, Local, Operand, Program, Status
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.ir.split import names_in, names_of_blocks, split, without_first
from symgen.model.model import Model
from symgen.naming import macro_name
from symgen.records import dataclass

# States a block: local arrays of rows of this length; a multiple of every vector length in use.
BLOCK = 64
# The longest vectors hold as many states in float32, and half as many in float64: 512 bits.
VECTOR = 16
_OWN_NAMES = frozenset({"count", "stride", "status", "start", "length", "k", "i", "from", "copy", "result", "LANES"})
_OWN_NAMES |= {"flag", "flags", "bits", "code", "refused", "rest", "y", "MANY", "lanes", "VECTOR"}


_ABOUT = """Kernels of {plain}.h for many states: compile {plain_batch}.c and {plain}.c.

Component i of state k is at [i*stride + k] of each array, stride >= count. A state that has no valid result gets
NaN; the functions return the number of such states and write the status of each state unless `status` is NULL.
A result may take the place of an input (same address, same stride); else results and inputs must not overlap.
Valid results have the bits of the kernels for one state, with -fopenmp (many states on several threads) too.
With -O2 -ffp-contract=fast -DSYMGEN_CONTRACT they have others, in less time where the processor multiplies and adds
in one; `symgen --contract` verifies these."""


@dataclass(frozen=True, slots=True)
class BatchView:
    """One function: comment, prototype without semicolon, and what its template fills in.

    `rows` are the components that the loop reads: `argument[index]` of every state.
    """

    comment: tuple[str, ...]
    prototype: str
    single: str
    arguments: tuple[Argument, ...]
    rows: tuple[Load, ...]
    output: str
    size: int
    fixed: tuple[str, ...]
    body: tuple[str, ...]
    one_by_one: bool


@dataclass(frozen=True, slots=True)
class BatchFileView:
    """Everything the template of the source prints."""

    stem: str
    scalar: str
    lane: str
    zero: str
    one: str
    ok: str
    block: int
    vector: int
    threaded: bool
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
    plain = file_stem(model.c_name, program.scalar)
    stem = file_stem(model.c_name, program.scalar, BATCH)
    pair, ratio, params = (global_name(model.c_name, program.scalar, kind) for kind in ("sincos", "ratio", "params"))
    inline = f"{macro_name(stem)}_INLINE"
    both = [(kernel.name, ending) for kernel in program.kernels for ending in ("", BATCH)]
    own = {global_name(model.c_name, program.scalar, *one) for one in both}
    own |= {pair, ratio, inline, guard(stem), params, *_OWN_NAMES}
    own |= {status_name(model, status) for status in Status}
    own |= {f"{argument.name}_one" for kernel in kernels for argument in kernel.arguments}
    # the members of the parameter struct are those of the other header
    few = replace(program, kernels=kernels)
    names = replace(names_in_file(model, few, own), members=c_members(model, program))
    in_lanes = [kernel for kernel in kernels if not works_with_pairs(kernel)]
    operations = {statement.operation for kernel in in_lanes for statement in all_statements(kernel)}
    own_pair = program.sincos if "sincos" in operations else None
    angle, body = ("", ()) if own_pair is None else pair_body(program.scalar, own_pair, pair)
    functions = tuple(_function(model, program, kernel, names, (pair, ratio)) for kernel in kernels)
    view = BatchFileView(
        stem=stem,
        scalar=C_TYPE[program.scalar],
        lane="int64_t" if program.scalar == "float64" else "int32_t",
        zero=c_literal(program.scalar, Fraction(0)),
        one=c_literal(program.scalar, Fraction(1)),
        ok=status_name(model, Status.OK),
        block=BLOCK,
        vector=VECTOR,
        threaded=bool(in_lanes),
        functions=functions,
        inline=inline,
        pair=pair,
        angle=angle,
        pair_body=body,
        ratio=ratio if "ratio_or_zero" in operations else "",
    )
    about = tuple(_ABOUT.format(plain=plain, plain_batch=stem).splitlines())
    shown = tuple(CFunctionView(one.comment, one.prototype, ()) for one in functions)
    header = file_view(model, few, BATCH, about, shown)
    return files(replace(header, includes=(*header.includes, "<stddef.h>")), view, "c/batch.c.jinja")


def _function(model: Model, program: Program, kernel: Kernel, names: Names, private: tuple[str, str]) -> BatchView:
    scalar, output = C_TYPE[program.scalar], names.outputs[kernel.name]
    arguments = array_arguments(kernel)
    given = ["size_t count", "size_t stride", *(f"const {scalar} *{a.name}" for a in arguments)]
    params = global_name(model.c_name, program.scalar, "params")
    given += [f"const {params} *p", f"{scalar} *{output}", "unsigned char *status"]
    by_pairs = works_with_pairs(kernel)
    flat = Kernel(kernel.name, (), (), (), (), ()) if by_pairs else without_first(kernel)
    parts = split(flat)
    pair, ratio = private
    own_pair = None if program.sincos is None else pair
    printer = _Lanes(program.scalar, names.locals, _used(flat), own_pair, ratio=ratio)
    rows = tuple(load for load in flat.loads if load.argument != "p")
    fixed = [
        f"const {scalar} {names.locals[load.local]} = p->{names.members[load.member]};"
        for load in flat.loads
        if load.argument == "p"
    ]
    fixed += [line for statement in parts.fixed for line in printer.statement(statement)]
    body = [f"const {scalar} {names.locals[load.local]} = from[{k}][k];" for k, load in enumerate(rows)]
    body += [line for block in parts.blocks for statement in block.statements for line in printer.statement(statement)]
    body += printer.flag([check for block in parts.blocks for check in block.checks], flat.outputs)
    body += [f"result[{k}][k] = {printer.operand(operand)};" for k, operand in enumerate(flat.outputs)]
    return BatchView(
        comment=c_comment_lines(f"{meaning(kernel)}; {output} has {len(kernel.outputs)} rows"),
        prototype=f"size_t {global_name(model.c_name, program.scalar, kernel.name, BATCH)}({', '.join(given)})",
        single=global_name(model.c_name, program.scalar, kernel.name),
        arguments=arguments,
        rows=rows,
        output=output,
        size=len(kernel.outputs),
        fixed=tuple(fixed),
        body=tuple(body),
        one_by_one=by_pairs,
    )


def _used(kernel: Kernel) -> frozenset[str]:
    return frozenset(names_of_blocks(kernel.blocks) | names_in(kernel.outputs))


@dataclass(frozen=True, slots=True)
class _Lanes(CStatements):
    """Prints statements without branches, and checks as terms of one flag."""

    ratio: str = ""

    def ratio_or_zero(self, above: str, below: str) -> str:
        """A function without branches."""
        return f"{self.ratio}({above}, {below})"

    def flag(self, checks: list[Check], outputs: tuple[Operand, ...]) -> list[str]:
        """The lines that make `flag[k]`: 0 where every check passes and every result is finite."""
        zero, one = (self.literal(Fraction(number)) for number in (0, 1))
        results = [self.names[o.name] for o in dict.fromkeys(outputs) if isinstance(o, Local)]
        lines = [f"{C_TYPE[self.scalar]} rest = {' + '.join(rests(results)) or zero};"]
        for check in checks:
            # a sum leaves nothing to skip, so the loop stays free of branches
            lines.append(f"rest += {self.passes(check)} ? {zero} : {one};")
        return [*lines, "flag[k] = rest;"]
