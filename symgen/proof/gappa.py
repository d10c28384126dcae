"""Scripts for Gappa: a certified bound of what float32 rounding does to the inverse dynamics, over the whole box.

Each statement of the kernel appears twice, rounded and exact; sine and cosine enter with the bound on their absolute
error that is tested for every float32 argument, and with what the rounding of their argument does to them where that is
a sum of angles. Where a denominator may be 0 by intervals there is no bound. A program beside the script measures the
error at random states of the same box, to be read beside the bound.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from symgen.backends.c.names import c_names
from symgen.backends.literals import decimal_text, round_to
from symgen.backends.locals import array_arguments
from symgen.backends.render import render
from symgen.backends.scalars import SUFFIX, file_stem
from symgen.backends.statements import INFIX
from symgen.ir.kernel import Kernel, Literal, Local, Operand, Program, Statement
from symgen.model.model import Model, Range
from symgen.proof.box import box
from symgen.proof.intervals import Interval, enclose

QUANTITY = "inverse_dynamics"
# What a sine or cosine of the portable functions in float32 is taken to be off by.
TRIG_ERROR = Fraction(1, 2**23)
# Random points of the box at which the error is measured beside the bound.
TESTED_POINTS = 1_000_000


@dataclass(frozen=True, slots=True)
class GappaView:
    """Everything the template of a script prints."""

    stem: str
    model: str
    quantity: str
    definitions: tuple[str, ...]
    hypotheses: tuple[str, ...]
    goals: tuple[str, ...]
    entries: tuple[tuple[int, str], ...]


@dataclass(frozen=True, slots=True)
class ErrorView:
    """Everything the template of the program that measures prints; `entries` are places with their bounds."""

    stem: str
    model: str
    suffix: str
    quantity: str
    points: int
    arrays: tuple[tuple[str, int], ...]
    entries: tuple[tuple[str, str, str], ...]
    members: tuple[str, ...]
    size: int


def emit_gappa(model: Model, program: Program) -> dict[str, str]:
    """`proof/<model>_f_inverse_dynamics.gappa` and `..._error.c`, or nothing where the method does not reach."""
    kernel = next((kernel for kernel in program.kernels if kernel.name == QUANTITY), None)
    if program.scalar != "float32" or kernel is None or obstacle(model, kernel):
        return {}
    stem = file_stem(model.c_name, program.scalar)
    view = _view(model, kernel, stem)
    return {
        f"proof/{stem}_{QUANTITY}.gappa": render("proof/bound.gappa.jinja", view),
        f"proof/{stem}_{QUANTITY}_error.c": render("proof/error.c.jinja", _measurement(model, program, kernel)),
    }


def obstacle(model: Model, kernel: Kernel) -> str:
    """Why there is no script; empty where there is one."""
    known = {*INFIX, "neg", "sqrt", "sincos", "abs"}
    if foreign := sorted({s.operation for s in _needed(kernel)} - known):
        return f"it uses {', '.join(foreign)}"
    if not any(isinstance(output, Local) for output in kernel.outputs):
        return "its result is constant"
    enclosure = enclose(kernel, _float_box(model))
    arguments = [s.operands[0] for s in kernel.statements if s.operation == "sincos"]
    errors = _sum_errors(kernel, enclosure.bounds)
    if any(_error_of(argument, errors) is None for argument in arguments):
        return "it takes the sine of more than a sum of angles"
    if enclosure.doubtful:
        return f"intervals do not keep its denominators {', '.join(enclosure.doubtful)} from 0"
    return ""


def _sum_errors(kernel: Kernel, bounds: Mapping[str, Interval]) -> dict[str, Fraction]:
    """How far each sum of inputs is from its exact value at most, by half a unit in the last place of each partial sum.

    Locals that are something else are left out.
    """
    errors = {load.local: Fraction(0) for load in kernel.loads}
    for statement in kernel.statements:
        parts = [_error_of(operand, errors) for operand in statement.operands]
        given = [part for part in parts if part is not None]
        if statement.operation not in ("add", "sub", "neg") or len(given) < len(parts):
            continue
        (target,) = statement.targets
        own = Fraction(0)
        if statement.operation != "neg":
            largest = max(map(abs, bounds[target]))
            own = Fraction(2) ** (math.frexp(largest)[1] - 25)  # largest < 2^e: half a unit is 2^(e-25)
        errors[target] = sum(given, own)
    return errors


def _error_of(operand: Operand, errors: Mapping[str, Fraction]) -> Fraction | None:
    return Fraction(0) if isinstance(operand, Literal) else errors.get(operand.name)


def _measurement(model: Model, program: Program, kernel: Kernel) -> ErrorView:
    ranges = box(model)
    members = c_names(model, program).members
    arrays = array_arguments(kernel)
    entries = [(f"{a.name}[{i}]", ranges[a.name][i]) for a in arrays for i in range(a.length)]
    entries += [(f"p.{members[p.name]}", pair) for p, pair in zip(model.parameters, ranges["p"], strict=True)]
    stem = model.c_name
    return ErrorView(
        stem=stem,
        model=model.c_name,
        suffix=SUFFIX[program.scalar],
        quantity=kernel.name,
        points=TESTED_POINTS,
        arrays=tuple((a.name, a.length) for a in arrays),
        entries=tuple((place, _float_text(low), _float_text(high)) for place, (low, high) in entries),
        members=tuple(members[p.name] for p in model.parameters),
        size=len(kernel.outputs),
    )


def _needed(kernel: Kernel) -> tuple[Statement, ...]:
    """The statements that the outputs depend on."""
    needed = {output.name for output in kernel.outputs if isinstance(output, Local)}
    kept = []
    for statement in reversed(kernel.statements):
        if needed.intersection(statement.targets):
            kept.append(statement)
            if statement.operation != "sincos":
                needed |= {o.name for o in statement.operands if isinstance(o, Local)}
    return tuple(reversed(kept))


def _view(model: Model, kernel: Kernel, stem: str) -> GappaView:
    statements = _needed(kernel)
    used = {o.name for s in statements if s.operation != "sincos" for o in s.operands if isinstance(o, Local)}
    used |= {o.name for o in kernel.outputs if isinstance(o, Local)}
    bounds = enclose(kernel, _float_box(model)).bounds
    errors = _sum_errors(kernel, bounds)
    lines: list[str] = []
    hypotheses: list[str] = []
    for load in kernel.loads:
        if load.local in used:
            lines.append(f"{_rounded(load.local)} = rnd({_free(load.local)});")
            hypotheses.append(_within(_rounded(load.local), bounds[load.local]))
    inputs = {load.local for load in kernel.loads}
    for statement in statements:
        if statement.operation == "sincos":
            error = TRIG_ERROR + (_error_of(statement.operands[0], errors) or 0)
            for target in (name for name in statement.targets if name in used):
                lines.append(f"{_rounded(target)} = rnd({_free(target)});")
                hypotheses.append(_within(_exact(target, inputs), bounds[target]))
                hypotheses.append(f"|{_rounded(target)} - {_exact(target, inputs)}| <= {_power_text(error)}")
            continue
        (target,) = statement.targets
        rounds = statement.operation not in ("neg", "abs")
        text = _expression(statement, [_operand(o, inputs, exact=False) for o in statement.operands])
        lines.append(f"{_rounded(target)} {'rnd' if rounds else ''}= {text};")
        text = _expression(statement, [_operand(o, inputs, exact=True) for o in statement.operands])
        lines.append(f"{_exact(target, inputs)} = {text};")
    entries = tuple(
        (k, o.name) for k, o in enumerate(kernel.outputs) if isinstance(o, Local) and o.name not in inputs
    )
    return GappaView(
        stem=stem,
        model=model.c_name,
        quantity=kernel.name,
        definitions=tuple(lines),
        hypotheses=tuple(dict.fromkeys(hypotheses)),
        goals=tuple(f"|{_rounded(n)} - {_exact(n, inputs)}| in ?" for n in dict.fromkeys(n for _, n in entries)),
        entries=tuple((k, _rounded(name)) for k, name in entries),
    )


def _float_text(bound: Fraction) -> str:
    return decimal_text("float32", bound) + "f"


def _float_box(model: Model) -> dict[str, tuple[Range, ...]]:
    """The box in float32 numbers: a parameter without a range is the float32 number next to its default."""
    return {
        name: tuple((Fraction(round_to("float32", low)), Fraction(round_to("float32", high))) for low, high in ranges)
        for name, ranges in box(model).items()
    }


def _power_text(error: Fraction) -> str:
    """A dyadic fraction as Gappa writes it."""
    return f"{error.numerator}b-{error.denominator.bit_length() - 1}"


def _rounded(name: str) -> str:
    return f"v_{name}"


def _exact(name: str, inputs: Iterable[str]) -> str:
    """The exact value; an input is taken as it is given, in float32."""
    return f"v_{name}" if name in inputs else f"e_{name}"


def _free(name: str) -> str:
    return f"free_{name}"


def _operand(operand: Operand, inputs: set[str], *, exact: bool) -> str:
    if isinstance(operand, Local):
        return _exact(operand.name, inputs) if exact else _rounded(operand.name)
    value = operand.value if exact else Fraction(round_to("float32", operand.value))
    text = str(value.numerator) if value.denominator == 1 else f"({value.numerator} / {value.denominator})"
    return f"({text})" if value < 0 and value.denominator == 1 else text


def _expression(statement: Statement, operands: list[str]) -> str:
    match statement.operation:
        case "neg":
            return f"-{operands[0]}"
        case "abs":
            return f"|{operands[0]}|"
        case "sqrt":
            return f"sqrt({operands[0]})"
        case operation:
            return f"{operands[0]} {INFIX[operation]} {operands[1]}"


def _within(name: str, interval: Interval) -> str:
    """Bounds without rounding: a decimal would exclude the only number of a range that is one point."""
    low, high = (_power_text(Fraction(bound)) for bound in interval)
    return f"{name} in [{low}, {high}]"
