"""Random single changes of straight-line programs, and what a kernel means in exact (ball) arithmetic."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from symgen.ir.kernel import Kernel, Literal, Local, Operand, Program, Statement
from symgen.verify.exactness import EXACT
from symgen.verify.reference.arithmetic.tape import ball

FLIPPED = {"add": "sub", "sub": "add"}
SWAPPED = ("sub", "div", "atan2", "ratio_or_zero")
NEUTRAL = {"add": Literal(Fraction(0)), "sub": Literal(Fraction(0)), "mul": Literal(Fraction(1))}


@dataclass(frozen=True)
class Mutant:
    """A kernel with one statement changed."""

    original: Kernel
    kernel: Kernel
    change: str


def mutations(program: Program, count: int, seed: int) -> tuple[Mutant, ...]:
    """`count` random single changes, statements of all kernels drawn alike."""
    generator = random.Random(seed)
    places = [
        (kernel, b, s)
        for kernel in program.kernels
        for b, block in enumerate(kernel.blocks)
        for s in range(len(block.statements))
    ]
    mutants: list[Mutant] = []
    while len(mutants) < count:
        kernel, b, s = generator.choice(places)
        statement = kernel.blocks[b].statements[s]
        earlier = [load.local for load in kernel.loads]
        earlier += [t for block in kernel.blocks[:b] for st in block.statements for t in st.targets]
        earlier += [t for st in kernel.blocks[b].statements[:s] for t in st.targets]
        options = list(_changes(statement, earlier, generator))
        if options:
            change, changed = generator.choice(options)
            mutants.append(
                Mutant(kernel, _with_statement(kernel, b, s, changed), f"{kernel.name}: {change}: {statement}")
            )
    return tuple(mutants)


def _changes(statement: Statement, earlier: Sequence[str], generator: random.Random) -> Iterator[tuple[str, Statement]]:
    operands = statement.operands
    if statement.operation in FLIPPED:
        yield "sign", replace(statement, operation=FLIPPED[statement.operation])
    if statement.operation == "neg":
        yield "sign", replace(statement, operation="add", operands=(operands[0], Literal(Fraction(0))))
    if statement.operation == "sincos":
        yield "sine for cosine", replace(statement, targets=statement.targets[::-1])
    if statement.operation in SWAPPED and operands[0] != operands[1]:
        yield "operands swapped", replace(statement, operands=operands[::-1])
    if statement.operation in NEUTRAL:
        for place in range(2):
            kept: list[Operand] = list(operands)
            kept[place] = NEUTRAL[statement.operation]
            yield "dropped term", replace(statement, operands=tuple(kept))
    if operands and earlier:
        place = generator.randrange(len(operands))
        other = Local(generator.choice(list(earlier)))
        if other != operands[place]:
            changed = tuple(other if i == place else operand for i, operand in enumerate(operands))
            yield "other operand", replace(statement, operands=changed)


def _with_statement(kernel: Kernel, block: int, place: int, statement: Statement) -> Kernel:
    old = kernel.blocks[block]
    statements = (*old.statements[:place], statement, *old.statements[place + 1 :])
    blocks = (*kernel.blocks[:block], replace(old, statements=statements), *kernel.blocks[block + 1 :])
    return replace(kernel, blocks=blocks)


def exact_outputs(kernel: Kernel, arguments: Mapping[str, Sequence[float]], parameters: Sequence[float]) -> list[Any]:
    """The outputs in balls of the working precision; checks are left out."""
    values: dict[str, Any] = {}

    def operand(which: Operand) -> Any:
        return ball(which.value) if isinstance(which, Literal) else values[which.name]

    for load in kernel.loads:
        source = parameters if load.argument == "p" else arguments[load.argument]
        values[load.local] = ball(source[load.index])
    for statement in kernel.statements:
        operands = [operand(which) for which in statement.operands]
        if statement.operation == "sincos":
            sine, cosine = operands[0].sin_cos()
            values.update(zip(statement.targets, (sine, cosine), strict=True))
        else:
            values[statement.targets[0]] = EXACT[statement.operation](*operands)
    return [operand(which) for which in kernel.outputs]
