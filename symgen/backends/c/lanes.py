"""Blocks of the same statements on other operands in C: a loop over them, which compilers turn into vector code.

The operands of all blocks lie in one array and the results in another, so that a loop of constant count as long as a
vector runs over the statements of one block.  Every lane performs the operations of its block: the bits are the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from symgen.backends.c.pairs import LANES
from symgen.backends.c.statements import CStatements
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.ir.kernel import Block, Kernel, Local, Operand, Program, Scalar, Statement
from symgen.ir.split import names_in, names_of_blocks
from symgen.naming import macro_name
from symgen.records import dataclass

_LANE, _GIVEN, _RESULTS = "lane", "given", "found"


@dataclass(frozen=True, slots=True)
class LaneLoop:
    """Blocks `first` to `last` as one loop: what every lane is given and what others need of its results.

    `statements` are those of one lane; its operands from outside are locals named by their place in `given`.
    """

    number: int
    last: int
    statements: tuple[Statement, ...]
    given: tuple[tuple[Operand, ...], ...]
    results: tuple[tuple[str, ...], ...]


def lane_loops(kernel: Kernel, scalar: Scalar) -> dict[int, LaneLoop]:
    """The loops of a kernel by the number of their first block: where there are as many blocks as lanes."""
    loops: dict[int, LaneLoop] = {}
    for numbers in kernel.alike:
        if len(numbers) == LANES[scalar]:
            loops[numbers[0]] = _loop(kernel, numbers, len(loops) + 1)
    return loops


def each_macro(name: str, program: Program) -> str:
    """The macro before loops over lanes; empty where there are none."""
    has = any(len(numbers) == LANES[program.scalar] for kernel in program.kernels for numbers in kernel.alike)
    return each_name(name, SUFFIX[program.scalar]) if has else ""


def each_name(name: str, suffix: str) -> str:
    """The macro before loops over lanes, of a file whose names begin with `name`."""
    return macro_name(name) + f"_each{suffix}".upper()


def lane_names(program: Program) -> set[str]:
    """Names that the loops of the kernels need inside of functions."""
    most = max((len(kernel.alike) for kernel in program.kernels), default=0)
    return {f"{name}_{k}" for name in (_GIVEN, _RESULTS) for k in range(1, most + 1)} | ({_LANE} if most else set())


def loop_lines(loop: LaneLoop, printer: CStatements, macro: str) -> tuple[str, ...]:
    """The arrays and the loop."""
    kind, lanes = C_TYPE[printer.scalar], len(loop.given[0])
    given, found = f"{_GIVEN}_{loop.number}", f"{_RESULTS}_{loop.number}"
    own = {place(k): f"{given}[{k}][{_LANE}]" for k in range(len(loop.given))}
    inner = replace(printer, names={**printer.names, **own})
    rows = (", ".join(map(printer.operand, row)) for row in loop.given)
    results = (f"{found}[{k}][{_LANE}] = {printer.names[row[0]]};" for k, row in enumerate(loop.results))
    body = (*(line for statement in loop.statements for line in inner.statement(statement)), *results)
    return (
        f"const {kind} {given}[{len(loop.given)}][{lanes}] = {{",
        *(f"    {{{row}}}," for row in rows),
        "};",
        f"{kind} {found}[{len(loop.results)}][{lanes}];",
        macro,
        f"for (int {_LANE} = 0; {_LANE} < {lanes}; ++{_LANE}) {{",
        *(f"    {line}" for line in body),
        "}",
    )


def results_of(loop: LaneLoop, scalar: Scalar, names: Mapping[str, str]) -> dict[str, str]:
    """The declarations of what others need of the results, by local."""
    return {
        target: f"const {C_TYPE[scalar]} {names[target]} = {_RESULTS}_{loop.number}[{k}][{lane}];"
        for k, row in enumerate(loop.results)
        for lane, target in enumerate(row)
    }


def place(number: int) -> str:
    """The local that stands for a row of what is given; no name of a kernel has a blank."""
    return f"given {number}"


def _loop(kernel: Kernel, numbers: Sequence[int], number: int) -> LaneLoop:
    blocks = [kernel.blocks[k] for k in numbers]
    rows = {row: k for k, row in enumerate(_ordered(kernel, dict.fromkeys(_from_outside(blocks))))}
    inside = {target for statement in blocks[0].statements for target in statement.targets}

    def operand(row: tuple[Operand, ...]) -> Operand:
        first = row[0]
        if isinstance(first, Local) and first.name in inside:
            return first
        return Local(place(rows[row])) if row in rows else first

    statements = tuple(
        replace(lanes[0], operands=tuple(map(operand, zip(*(one.operands for one in lanes), strict=True))))
        for lanes in zip(*(block.statements for block in blocks), strict=True)
    )
    others = [block for k, block in enumerate(kernel.blocks) if k not in numbers]
    needed = names_of_blocks(others) | names_in(kernel.outputs)
    found = tuple(
        tuple(one.targets[0] for one in lanes)
        for lanes in zip(*(block.statements for block in blocks), strict=True)
        if any(one.targets[0] in needed for one in lanes)
    )
    return LaneLoop(number, numbers[-1], statements, tuple(rows), found)


def _ordered(kernel: Kernel, rows: Iterable[tuple[Operand, ...]]) -> list[tuple[Operand, ...]]:
    """Parameters, which lie in memory, before what has just been computed; in both what is needed last comes first.

    Found by trying: of nine orders gcc moves least about in this one.
    """
    read = {load.local for load in kernel.loads if load.argument == "p"}
    latest_first = [*rows][::-1]
    parameters = [row for row in latest_first if names_in(row) <= read]
    return [*parameters, *(row for row in latest_first if row not in parameters)]


def _from_outside(blocks: Sequence[Block]) -> list[tuple[Operand, ...]]:
    """What no lane computes, in the order of use, an operand for each lane; numbers that all share stay in place."""
    inside = {target for statement in blocks[0].statements for target in statement.targets}
    found = []
    for lanes in zip(*(block.statements for block in blocks), strict=True):
        for row in zip(*(one.operands for one in lanes), strict=True):
            shared = len(set(row)) == 1 and not isinstance(row[0], Local)
            if not shared and not (isinstance(row[0], Local) and row[0].name in inside):
                found.append(row)
    return found
