"""The proof folder: drivers, scripts, and a page that says how to run them and what they cannot show."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from symgen.backends.locals import array_arguments
from symgen.backends.scalars import file_stem
from symgen.backends.statements import INFIX
from symgen.ir.kernel import Kernel, Literal, Operand, Program
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.model.model import Model
from symgen.proof.eva import MOST_RUNS, emit_eva
from symgen.proof.fuzz import emit_fuzz
from symgen.proof.gappa import QUANTITY, emit_gappa, obstacle
from symgen.proof.quadrants import overflowing_angles
from symgen.proof.reach import reach

# Characters of a value in terms of the inputs; a longer one is shown by its name.
_LONGEST = 160


def emit_proofs(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """`proof/...` for one or both scalar types; the fuzz target compares the two and needs both."""
    if not any(program.kernels for program in programs):
        return {}
    files: dict[str, str] = {}
    for program in programs:
        files |= emit_eva(model, program)
        files |= emit_gappa(model, program)
    if len(programs) > 1:
        both = set.intersection(*({kernel.name for kernel in program.kernels} for program in programs))
        files |= emit_fuzz(model, [_only(program, both) for program in programs])
    page = "\n".join(_page(model, programs, sorted(files))) + "\n"
    return {**files, "proof/README.md": page}


def _only(program: Program, names: Collection[str]) -> Program:
    return replace(program, kernels=tuple(kernel for kernel in program.kernels if kernel.name in names))


def _page(model: Model, programs: Sequence[Program], files: Sequence[str]) -> Iterator[str]:
    single = file_stem(model.c_name, "float32")
    yield f"# Proofs about {model.name}"
    yield ""
    yield "All of them speak of the C as it is, over the ranges of the model file, with the portable sine and cosine."
    yield "How to run each file stands at its top:"
    yield ""
    yield from (f"- `{path.removeprefix('proof/')}`" for path in files)
    yield ""
    yield f"Frama-C Eva takes one kernel a run: `-main eva_<quantity>` with `{single}_eva.c` and the like."
    yield "0 alarms mean: no division by 0, no infinity, no NaN, no wrong access, status 0 in the whole box."
    yield ""
    yield "## Denominators that intervals cannot keep from 0"
    yield ""
    yield "Every value is bounded by the bounds of its operands, which forgets how they depend on each other: for these"
    yield "kernels expect alarms. The kernels test these denominators, or the factors of them, at run time."
    yield ""
    program = programs[-1]
    rows = [row for kernel in program.kernels for row in _doubtful(model, kernel)]
    if rows:
        yield "| kernel | denominators |"
        yield "|---|---|"
        yield from rows
    else:
        yield "None."
    yield ""
    rows = [row for kernel in program.kernels for row in _overflowing(model, program, kernel)]
    if rows:
        yield "## Angles that make intervals overflow"
        yield ""
        yield "Coordinates that decide about a denominator are cut where the reduction of the sine changes quadrant, as"
        yield f"long as that makes at most {MOST_RUNS} runs. Sine and cosine of these angles, which pass several"
        yield "quadrants, have bounds in the hundreds, and products of them exceed every float: expect alarms about"
        yield "values that are not finite. A `range:` within one quadrant ends that."
        yield ""
        yield "| kernel | angles |"
        yield "|---|---|"
        yield from rows
        yield ""
    wide = [f"`{k.name}` in {one.scalar}" for one in programs for k in one.kernels if works_with_pairs(k)]
    if wide:
        yield "## Twice the digits"
        yield ""
        yield f"Pairs of numbers: {', '.join(wide)}."
        yield "What is left of a sum or a product is small because both were computed from the same operands, which"
        yield "intervals forget: expect alarms throughout."
        yield ""
    kernel = next((kernel for kernel in program.kernels if kernel.name == QUANTITY), None)
    if program.scalar == "float32" and kernel is not None and (why := obstacle(model, kernel)):
        yield "## Rounding"
        yield ""
        yield f"There is no script for Gappa: {why}."
        yield ""


def _doubtful(model: Model, kernel: Kernel) -> Iterator[str]:
    yield from _row(kernel, reach(model, kernel).doubtful)


def _overflowing(model: Model, program: Program, kernel: Kernel) -> Iterator[str]:
    yield from _row(kernel, overflowing_angles(model, program, kernel))


def _row(kernel: Kernel, names: Sequence[str]) -> Iterator[str]:
    if names:
        texts = _texts(kernel)
        spelled = "<br>".join(f"`{_text(texts, name)}`" for name in names)
        yield f"| {kernel.name}({', '.join(argument.name for argument in array_arguments(kernel))}) | {spelled} |"


def _texts(kernel: Kernel) -> dict[str, str]:
    """Every value of a kernel in terms of the inputs, one after the other: no chain of values is too long."""
    known: dict[str, str] = {}

    def spell(operand: Operand) -> str:
        return str(operand.value) if isinstance(operand, Literal) else known.get(operand.name, operand.name)

    for statement in kernel.statements:
        parts = [spell(operand) for operand in statement.operands]
        for target in statement.targets:
            if statement.operation == "sincos":
                text = f"{'sin' if statement.targets[0] == target else 'cos'}({parts[0]})"
            elif statement.operation in INFIX:
                text = f"({parts[0]} {INFIX[statement.operation]} {parts[1]})"
            elif statement.operation == "neg":
                text = f"-{parts[0]}"
            else:
                text = f"{statement.operation}({', '.join(parts)})"
            known[target] = _cut(text)
    return known


def _text(texts: Mapping[str, str], name: str) -> str:
    """A value in terms of the inputs, or its name in the C where that would be long."""
    spelled = texts.get(name, name)
    return name if len(spelled) > _LONGEST else spelled[1:-1] if spelled.startswith("(") else spelled


def _cut(text: str) -> str:
    """A text that stays too long however often it is used: a graph spelled as a tree grows without bound."""
    return text if len(text) <= _LONGEST else "…" * (_LONGEST + 1)
