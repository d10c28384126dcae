"""The section about microcontrollers: what `symgen target` measured."""

from __future__ import annotations

from symgen.report.context import Context
from symgen.report.document import Block, InlineCode, Section, Table
from symgen.report.prose import paragraph, say
from symgen.report.targets import FAST, TargetCore, TargetRow

INTRO = (
    "The generated C was compiled for microcontrollers and run under emulation at regular and singular states. "
    "Instructions are those of one call with status 0, from its first to its return (fewest to most), at -O2 or, for "
    "large kernels without a unit for their type, at -Os; they are no cycles. Bytes are those at -Os: the code of the "
    "kernel, the growth of an image that links it, the deepest stack. No kernel has static data."
)


def targets(context: Context) -> tuple[Section, ...]:
    """A table for each core, or nothing where nothing was measured."""
    if not context.input.targets:
        return ()
    blocks: list[Block] = [paragraph("{}", INTRO)]
    for core in context.input.targets:
        text = f"{core.name}: {core.same_bits} builds (compiler, level, scalar type) gave the same bits as the host."
        blocks += [paragraph("{}", text), _table(core)]
    return (Section(say("Microcontrollers"), tuple(blocks)),)


def _table(core: TargetCore) -> Table:
    headings = ("Kernel", "Type", "Instructions", "Code", "Linked", "Stack")
    rows = tuple(
        (
            (InlineCode(row.kernel),),
            *(say("{}", text) for text in (row.scalar, _range(row), str(row.code), str(row.linked), str(row.stack))),
        )
        for row in core.rows
    )
    return Table(tuple(say("{}", heading) for heading in headings), rows, (1, 0, 0, 0, 0, 0))


def _range(row: TargetRow) -> str:
    text = str(row.most) if row.fewest == row.most else f"{row.fewest}–{row.most}"
    return text if row.level == FAST else f"{text} ({row.level})"
