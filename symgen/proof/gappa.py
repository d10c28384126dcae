"""Scripts for Gappa: a certified bound of what float32 rounding does to the inverse dynamics, over the whole box.

Each statement of the kernel appears twice, rounded and exact; sine and cosine enter with the bound on their absolute
error that is tested for every float32 argument. Where a denominator may be 0 by intervals there is no bound.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from symgen.emit.literals import round_to
from symgen.emit.render import render
from symgen.ir.kernel import Kernel, Local, Operand, Program, Statement
from symgen.model.model import Model
from symgen.naming import file_stem
from symgen.proof.box import box
from symgen.proof.intervals import Interval, enclose

QUANTITY = "inverse_dynamics"
TRIG_ERROR = "1b-23"
_INFIX = {"add": "+", "sub": "-", "mul": "*", "div": "/"}


@dataclass(frozen=True, slots=True)
class GappaView:
    """Everything the template of a script prints."""

    stem: str
    model: str
    quantity: str
    definitions: tuple[str, ...]
    hypotheses: tuple[str, ...]
    goals: tuple[str, ...]


def emit_gappa(model: Model, program: Program) -> dict[str, str]:
    """`proof/<model>_f_inverse_dynamics.gappa`, or nothing where the method does not reach."""
    kernel = next((kernel for kernel in program.kernels if kernel.name == QUANTITY), None)
    if program.scalar != "float32" or kernel is None or obstacle(model, kernel):
        return {}
    stem = f"{file_stem(model.name)}_f"
    view = _view(model, kernel, stem)
    return {f"proof/{stem}_{QUANTITY}.gappa": render("proof/bound.gappa.jinja", view)}


def obstacle(model: Model, kernel: Kernel) -> str:
    """Why there is no script; empty where there is one."""
    known = {*_INFIX, "neg", "sqrt", "sincos", "abs"}
    if foreign := sorted({s.operation for s in _needed(kernel)} - known):
        return f"it uses {', '.join(foreign)}"
    if not any(isinstance(output, Local) for output in kernel.outputs):
        return "its result is constant"
    enclosure = enclose(kernel, box(model))
    if enclosure.doubtful:
        return f"intervals do not keep its denominators {', '.join(enclosure.doubtful)} from 0"
    return ""


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
    bounds = enclose(kernel, box(model)).bounds
    lines: list[str] = []
    hypotheses: list[str] = []
    for load in kernel.loads:
        if load.local in used:
            lines.append(f"{_rounded(load.local)} = rnd({_free(load.local)});")
            hypotheses.append(_within(_rounded(load.local), bounds[load.local]))
    inputs = {load.local for load in kernel.loads}
    for statement in statements:
        if statement.operation == "sincos":
            for target in (name for name in statement.targets if name in used):
                lines.append(f"{_rounded(target)} = rnd({_free(target)});")
                hypotheses.append(_within(_exact(target, inputs), bounds[target]))
                hypotheses.append(f"|{_rounded(target)} - {_exact(target, inputs)}| <= {TRIG_ERROR}")
            continue
        (target,) = statement.targets
        rounds = statement.operation not in ("neg", "abs")
        text = _expression(statement, [_operand(o, inputs, exact=False) for o in statement.operands])
        lines.append(f"{_rounded(target)} {'rnd' if rounds else ''}= {text};")
        text = _expression(statement, [_operand(o, inputs, exact=True) for o in statement.operands])
        lines.append(f"{_exact(target, inputs)} = {text};")
    results = dict.fromkeys(o.name for o in kernel.outputs if isinstance(o, Local) and o.name not in inputs)
    return GappaView(
        stem=stem,
        model=model.name,
        quantity=kernel.name,
        definitions=tuple(lines),
        hypotheses=tuple(dict.fromkeys(hypotheses)),
        goals=tuple(f"|{_rounded(name)} - {_exact(name, inputs)}| in ?" for name in results),
    )


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
            return f"{operands[0]} {_INFIX[operation]} {operands[1]}"


def _within(name: str, interval: Interval) -> str:
    low, high = interval
    return f"{name} in [{low!r}, {high!r}]"
