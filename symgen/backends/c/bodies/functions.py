"""The functions of one state: what a kernel's statements and checks are as a C function."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

from symgen.backends.c.bodies.causes import Cause, CauseView, cause_view, causes_of, operands_of, place
from symgen.backends.c.bodies.finite import SUM, FiniteTest
from symgen.backends.c.bodies.pairs import GROUP_NAMES, group_lines, leading_group
from symgen.backends.c.bodies.steps import StepTable, table
from symgen.backends.c.names import global_name, status_name
from symgen.backends.c.statements import CStatements
from symgen.backends.c.surroundings import apart_name, both_name, rare_name
from symgen.backends.comments import c_comment_lines
from symgen.backends.locals import Names, array_arguments, used_locals
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.ir.kernel import Check, Kernel, Local, Operand, Program, Statement, Status
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.model.model import Model
from symgen.records import dataclass

# Arrays that a function stores its outputs in, and how many entries each has.
Results: TypeAlias = tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class CFunctionView:
    """One function: comment, prototype without semicolon, body lines, and the functions it needs."""

    comment: tuple[str, ...]
    prototype: str
    body: tuple[str, ...]
    causes: tuple[CauseView, ...] = ()


def kernel_function(
    model: Model,
    program: Program,
    kernel: Kernel,
    names: Names,
    about: str,
    given: Mapping[str, str],
    ending: str = "",
    results: Results = (),
) -> CFunctionView:
    """The function of a kernel; `given` declares what it gets besides arrays: `*p` behind them, and before `*sc`.

    Outputs are stored in one array, or one behind the other in those of `results`.
    """
    scalar, name = C_TYPE[program.scalar], global_name(model.c_name, program.scalar, kernel.name, ending)
    results = results or ((names.outputs[kernel.name], len(kernel.outputs)),)
    arguments = [given[struct] for struct in ("sc",) if struct in given]
    arguments += [f"const {scalar} {argument.name}[{argument.length}]" for argument in array_arguments(kernel)]
    arguments += [given["p"], *(f"{scalar} {result}[{length}]" for result, length in results)]
    return CFunctionView(
        c_comment_lines(about),
        f"{model.c_name}_status {name}({', '.join(arguments)})",
        _body(model, program, kernel, names, name, results),
        _causes(model, program, kernel, names, name, given),
    )


def _causes(
    model: Model, program: Program, kernel: Kernel, names: Names, function: str, given: Mapping[str, str]
) -> tuple[CauseView, ...]:
    """What tells the causes of failures apart beside the body of `function`."""
    causes = causes_of(kernel, function)
    if not causes:
        return ()
    printer = _printer(model, program, kernel, names, ())
    declared = {"": f"static {apart_name(model.c_name, SUFFIX[program.scalar])} {model.c_name}_status", **given}
    return tuple(cause_view(cause, kernel, names, printer, declared) for cause in causes)


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


def _body(
    model: Model, program: Program, kernel: Kernel, names: Names, function: str, results: Results
) -> tuple[str, ...]:
    """The lines of `function`, of one state; the parameters, or what stands for them, are the members of `*p`."""
    if works_with_pairs(kernel):
        return _body_of_steps(model, program, kernel, names, function, results)
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

    for block in kernel.blocks:
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
    return (*lines, *_ending(model, kernel, printer, results))


def _ending(model: Model, kernel: Kernel, printer: CStatements, results: Results) -> list[str]:
    """The test that all results are finite, and what is stored where they are."""
    lines: list[str] = []
    places = [f"{result}[{index}]" for result, length in results for index in range(length)]
    if any(isinstance(entry, Local) for entry in kernel.outputs):
        failed = status_name(model, Status.NOT_FINITE)
        lines += [f"if ({printer.rare}(isnan({SUM}) != 0)) {{", f"    return {failed};", "}"]
    entries = zip(places, kernel.outputs, strict=True)
    lines += [f"{where} = {printer.operand(entry).strip('()')};" for where, entry in entries]
    lines.append(f"return {status_name(model, Status.OK)};")
    return lines


def _body_of_steps(
    model: Model, program: Program, kernel: Kernel, names: Names, function: str, results: Results
) -> tuple[str, ...]:
    """The lines of a function that runs through tables of steps."""
    suffix, scalar = SUFFIX[program.scalar], C_TYPE[program.scalar]
    steps: StepTable = table(kernel, program)
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
    return (*lines, *finite.remaining(), *_ending(model, kernel, printer, results))


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
