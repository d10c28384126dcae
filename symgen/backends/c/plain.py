"""C99 for microcontrollers: one header and one source file for each scalar type, usable alone or together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.backends.about import STATUS_MEANING, count_lines, renaming_lines, shape_text, symbol_lines, unit_text
from symgen.backends.c.causes import Cause, CauseView, cause_names, cause_view, causes_of, operands_of, place
from symgen.backends.c.lanes import each_macro, each_name, lane_loops, loop_lines, results_of
from symgen.backends.c.pairs import GROUP_NAMES, PairsView, group_lines, leading_group, pair_names, pairs_view
from symgen.backends.c.steps import StepsView, Table, steps_view, table
from symgen.backends.c.surroundings import (
    LibraryPair,
    apart_macro,
    apart_name,
    both_name,
    library_pair,
    rare_macro,
    rare_name,
    surrounding_names,
)
from symgen.backends.comments import c_comment, c_comment_lines, indent_of
from symgen.backends.defaults import default_values
from symgen.backends.finite import SUM, FiniteTest
from symgen.backends.literals import c_literal
from symgen.backends.locals import Names, all_statements, array_arguments, names_of, used_locals
from symgen.backends.quantities import meaning
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.backends.statements import CStatements
from symgen.ir.kernel import Check, Kernel, Local, Operand, Program, Statement, Status
from symgen.ir.wide_functions import with_bodies, works_with_pairs
from symgen.model.model import Model
from symgen.naming import macro_name
from symgen.records import dataclass

_WITHOUT_LIBRARY = frozenset({"add", "sub", "mul", "div", "neg", "ratio_or_zero", "min", "max"})


@dataclass(frozen=True, slots=True)
class MemberView:
    """One member of the parameter struct and its default."""

    name: str
    comment: str
    default: str


@dataclass(frozen=True, slots=True)
class FunctionView:
    """One function: comment, prototype without semicolon, body lines, and the functions it needs."""

    comment: tuple[str, ...]
    prototype: str
    body: tuple[str, ...]
    causes: tuple[CauseView, ...]


@dataclass(frozen=True, slots=True)
class CView:
    """Everything the C templates print."""

    stem: str
    guard: str
    status_guard: str
    status_type: str
    parameters_type: str
    default_function: str
    scalar: str
    about: tuple[str, ...]
    statuses: tuple[tuple[str, int, str], ...]
    members: tuple[MemberView, ...]
    functions: tuple[FunctionView, ...]
    pairs: PairsView | None
    both: LibraryPair | None
    steps: StepsView | None
    rare: str
    each: str
    apart: str
    includes_math: bool


def emit_c(model: Model, program: Program) -> dict[str, str]:
    """Header and source of the program's scalar type: `c/<model>.h`, `.c` (float64) or `c/<model>_f.h`, `_f.c`."""
    view = _view(model, program)
    return {
        f"c/{view.stem}.h": render("c/header.h.jinja", view),
        f"c/{view.stem}.c": render("c/source.c.jinja", view),
    }


def status_name(model: Model, status: Status) -> str:
    """The enumerator of a status."""
    return f"{macro_name(model.c_name)}_{status.name}"


def c_members(model: Model, program: Program) -> dict[str, str]:
    """The members of the parameter struct, by parameter: what other files that use the header call them."""
    return names_of(model, replace(program, kernels=()), _own_names(model, program)).members


def c_names(model: Model, program: Program) -> Names:
    """Every name of the program's C."""
    return names_of(model, program, _own_names(model, program))


def _own_names(model: Model, program: Program) -> set[str]:
    prefix, suffix = model.c_name, SUFFIX[program.scalar]
    stem = model.c_name + suffix
    own = {f"{prefix}_{name}{suffix}" for name in ("params", "default_params")}
    own |= pair_names(prefix, suffix) | surrounding_names(prefix, suffix)
    own |= {f"{prefix}_status", f"{macro_name(stem)}_H", f"{macro_name(prefix)}_STATUS_DEFINED"}
    own |= {status_name(model, status) for status in Status}
    for kernel in program.kernels:
        function = f"{prefix}_{kernel.name}{suffix}"
        own |= {function, *cause_names(kernel, function)}
    return own


def _view(model: Model, program: Program) -> CView:
    prefix, suffix = model.c_name, SUFFIX[program.scalar]
    stem = model.c_name + suffix
    status_type, parameters_type = f"{prefix}_status", f"{prefix}_params{suffix}"
    default_function = f"{prefix}_default_params{suffix}"
    guard, status_guard = f"{macro_name(stem)}_H", f"{macro_name(prefix)}_STATUS_DEFINED"
    names = c_names(model, program)
    functions = tuple(_kernel(model, program, kernel, names, parameters_type) for kernel in program.kernels)
    return CView(
        stem=stem,
        guard=guard,
        status_guard=status_guard,
        status_type=status_type,
        parameters_type=parameters_type,
        default_function=default_function,
        scalar=C_TYPE[program.scalar],
        about=_about(model, program, names),
        statuses=tuple((status_name(model, status), int(status), STATUS_MEANING[status]) for status in Status),
        members=_members(model, program, names),
        functions=functions,
        pairs=pairs_view(prefix, suffix, program),
        both=library_pair(prefix, program),
        steps=steps_view(prefix, suffix, program),
        rare=rare_macro(prefix, program),
        each=each_macro(prefix, program),
        apart=apart_macro(prefix, program),
        includes_math=uses_library(program),
    )


def _about(model: Model, program: Program, names: Names) -> tuple[str, ...]:
    kind = "double precision" if program.scalar == "float64" else "single precision"
    lines = list(c_comment_lines(f"{model.name}: {model.description or 'constrained mechanical system'} ({kind})"))
    if model.source:
        lines += c_comment_lines(f"Source: {model.source}")
    for group in (symbol_lines(model), renaming_lines(names), count_lines(program)):
        lines.append("")
        lines += [wrapped for line in group for wrapped in _comment_line(line)]
    return tuple(lines)


def _comment_line(line: str) -> tuple[str, ...]:
    """A prepared line, escaped; tables keep their columns, long lines are wrapped."""
    indent = indent_of(line)
    if indent:
        return tuple(indent + wrapped for wrapped in c_comment_lines(line, "    "))
    return (line,)


def _members(model: Model, program: Program, names: Names) -> tuple[MemberView, ...]:
    values = default_values(model)
    members = []
    for parameter in model.parameters:
        default = c_literal(program.scalar, values[parameter.name]).strip("()")
        about = " ".join(part for part in (unit_text(parameter.unit), parameter.description) if part)
        comment = c_comment(f"{about}; default {default}" if about else f"default {default}")
        members.append(MemberView(names.members[parameter.name], comment, default))
    zero = c_literal(program.scalar, Fraction(0))
    return tuple(members) or (MemberView("unused", "this model has no parameters", zero),)


def _kernel(model: Model, program: Program, kernel: Kernel, names: Names, parameters_type: str) -> FunctionView:
    scalar, output = C_TYPE[program.scalar], names.outputs[kernel.name]
    size = len(kernel.outputs)
    arguments = [f"const {scalar} {argument.name}[{argument.length}]" for argument in array_arguments(kernel)]
    arguments += [f"const {parameters_type} *p", f"{scalar} {output}[{size}]"]
    function = f"{model.c_name}_{kernel.name}{SUFFIX[program.scalar]}"
    comment = c_comment_lines(f"{meaning(kernel)}; {shape_text(kernel)}")
    return FunctionView(
        comment,
        f"{model.c_name}_status {function}({', '.join(arguments)})",
        kernel_body(model, program, kernel, names, function),
        kernel_causes(model, program, kernel, names, function, {"p": f"const {parameters_type} *p"}),
    )


def kernel_causes(
    model: Model, program: Program, kernel: Kernel, names: Names, function: str, types: Mapping[str, str]
) -> tuple[CauseView, ...]:
    """What tells the causes of failures apart beside the body of `function`; `types` declares what is no array."""
    printer = _printer(model, program, kernel, names, ())
    declared = {"": f"static {apart_name(model.c_name, SUFFIX[program.scalar])} {model.c_name}_status", **types}
    return tuple(cause_view(cause, kernel, names, printer, declared) for cause in causes_of(kernel, function))


def _printer(model: Model, program: Program, kernel: Kernel, names: Names, causes: tuple[Cause, ...]) -> CStatements:
    suffix = SUFFIX[program.scalar]

    def call(check: Check) -> str:
        return next(cause.call(kernel, names) for cause in causes if cause.check is check)

    return CStatements(
        program.scalar,
        names.locals,
        used_locals(kernel),
        None if program.sincos is None else f"{model.c_name}_sincos{suffix}",
        lambda status: status_name(model, status),
        both_name(model.c_name, suffix),
        rare_name(model.c_name, suffix),
        call if causes else None,
    )


def kernel_body(model: Model, program: Program, kernel: Kernel, names: Names, function: str) -> tuple[str, ...]:
    """The lines of `function`, of one state; the parameters, or what stands for them, are the members of `*p`."""
    if works_with_pairs(kernel):
        return _body_of_steps(model, program, kernel, names, function)
    suffix = SUFFIX[program.scalar]
    causes = causes_of(kernel, function)
    printer = _printer(model, program, kernel, names, causes)
    used, group = printer.used, () if program.sincos is None else leading_group(kernel)
    loads = [load for load in kernel.loads if load.local in used]
    loaded = {load.argument for load in loads}
    scalar = C_TYPE[program.scalar]
    finite = FiniteTest(scalar, (names.locals[o.name] for o in kernel.outputs if isinstance(o, Local)))
    lines = [f"(void){name};" for name in (*(a.name for a in array_arguments(kernel)), "p") if name not in loaded]
    waiting: dict[str, str] = {}
    for load in loads:
        waiting[load.local] = f"const {scalar} {names.locals[load.local]} = {place(load, names)};"

    def due(operands: Iterable[Operand]) -> list[str]:
        # read where first needed: fewer values are alive across the calls of the sine and cosine
        return [waiting.pop(o.name) for o in operands if isinstance(o, Local) and o.name in waiting]

    loops, behind = lane_loops(kernel, program.scalar), -1
    for number, block in enumerate(kernel.blocks):
        if number <= behind:
            continue
        if (loop := loops.get(number)) is not None:
            lines += due(operand for row in loop.given for operand in row)
            lines += loop_lines(loop, printer, each_name(model.c_name, suffix))
            waiting |= results_of(loop, program.scalar, names.locals)
            behind = loop.last
            continue
        for statement in block.statements:
            if statement.operation == "sincos" and statement in group:
                if statement is group[0]:
                    lines += due(operand for pair in group for operand in pair.operands)
                    angles = [printer.operand(pair.operands[0]) for pair in group]
                    lines += group_lines(program.scalar, f"{model.c_name}_sincos_group{suffix}", angles)
                    waiting |= _read_back(group, scalar, names)
                continue
            if statement.operation == "sincos":
                # all angles before the first call of the library: what they are read from is not needed after it
                lines += due(o for s in block.statements if s.operation == "sincos" for o in s.operands)
            lines += [*due(statement.operands), *printer.statement(statement)]
            lines += [line for target in statement.targets for line in finite.factor(names.locals[target])]
        for check in block.checks:
            lines += [*due(operands_of(check, causes)), *printer.check(check)]
    lines += due(kernel.outputs)
    lines += finite.remaining()
    return (*lines, *_ending(model, kernel, printer, names))


def _ending(model: Model, kernel: Kernel, printer: CStatements, names: Names) -> list[str]:
    """The test that all results are finite, and what is stored where they are."""
    lines: list[str] = []
    output = names.outputs[kernel.name]
    if any(isinstance(entry, Local) for entry in kernel.outputs):
        failed = status_name(model, Status.NOT_FINITE)
        lines += [f"if ({printer.rare}(isnan({SUM}) != 0)) {{", f"    return {failed};", "}"]
    lines += [
        f"{output}[{index}] = {printer.operand(operand).strip('()')};" for index, operand in enumerate(kernel.outputs)
    ]
    lines.append(f"return {status_name(model, Status.OK)};")
    return lines


def _body_of_steps(model: Model, program: Program, kernel: Kernel, names: Names, function: str) -> tuple[str, ...]:
    """The lines of a function that runs through tables of steps."""
    suffix, scalar = SUFFIX[program.scalar], C_TYPE[program.scalar]
    steps: Table = table(kernel, program)
    causes = causes_of(kernel, function)
    placed = replace(names, locals={**names.locals, **steps.spelled})
    printer = _printer(model, program, kernel, placed, causes)
    loaded = {load.argument for load in kernel.loads}
    lines = [f"(void){name};" for name in (*(a.name for a in array_arguments(kernel)), "p") if name not in loaded]
    lines += steps.lines(f"{model.c_name}_step{suffix}")
    lines += [f"{steps.spelled[load.local]} = {place(load, names)};" for load in kernel.loads]
    for block, part in zip(kernel.blocks, steps.parts, strict=True):
        if part:
            lines.append(f"{model.c_name}_steps{suffix}(step, {part.start}, {part.stop}, v);")
        for check in block.checks:
            # what only a failure computes has names of its own
            inside = {target: names.locals[target] for target in _targets_on_failure(check)}
            lines += replace(printer, names={**placed.locals, **inside}).check(check)
    finite = FiniteTest(scalar, (placed.locals[o.name] for o in kernel.outputs if isinstance(o, Local)))
    return (*lines, *finite.remaining(), *_ending(model, kernel, printer, names))


def _targets_on_failure(check: Check) -> set[str]:
    first = check.first
    if first is None or check.apart:
        return set()
    own = {target for statement in first.statements for target in statement.targets}
    return own.union(*map(_targets_on_failure, first.checks))


def _read_back(group: Sequence[Statement], scalar: str, names: Names) -> dict[str, str]:
    """The declarations of the sines and cosines of a group, by local."""
    _, *halves = GROUP_NAMES
    return {
        target: f"const {scalar} {names.locals[target]} = {half}[{place}];"
        for place, statement in enumerate(group)
        for target, half in zip(statement.targets, halves, strict=True)
    }


def uses_library(program: Program) -> bool:
    """Whether a file with these kernels needs math.h: for a function, or to test whether results are finite."""
    if any(isinstance(output, Local) for kernel in program.kernels for output in kernel.outputs):
        return True
    own = () if program.sincos is None else program.sincos.statements
    free = _WITHOUT_LIBRARY if program.sincos is None else _WITHOUT_LIBRARY | {"sincos"}
    statements = [*own, *(statement for kernel in program.kernels for statement in all_statements(kernel))]
    return any(statement.operation not in free for statement in with_bodies(statements))
