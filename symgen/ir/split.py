"""A kernel cut in two: what depends on parameters only, and what every state needs anew."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from symgen.ir.kernel import Block, Check, Kernel, Literal, Local, Operand, Statement
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Split:
    """`fixed` statements use parameters and each other only; `blocks` are the kernel's without them.

    Checks stay in their blocks, those of fixed values too: a state gets its status at the same place as before.
    """

    fixed: tuple[Statement, ...]
    blocks: tuple[Block, ...]


def split(kernel: Kernel) -> Split:
    """The statements on the way of a regular state, cut in two; what only a failed check runs stays where it is."""
    known = {load.local for load in kernel.loads if load.argument == "p"}
    fixed: list[Statement] = []
    blocks = []
    for block in kernel.blocks:
        kept = []
        for statement in block.statements:
            if all(isinstance(o, Literal) or o.name in known for o in statement.operands):
                fixed.append(statement)
                known.update(statement.targets)
            else:
                kept.append(statement)
        blocks.append(replace(block, statements=tuple(kept)))
    return Split(tuple(fixed), tuple(blocks))


def without_first(kernel: Kernel) -> Kernel:
    """The kernel whose checks only pass or fail: what tells one failure from another goes, with all it alone needs."""
    blocks = [replace(block, checks=tuple(_plain(c) for c in block.checks)) for block in kernel.blocks]
    return pruned(replace(kernel, blocks=tuple(blocks)))


def pruned(kernel: Kernel) -> Kernel:
    """The kernel without statements and loads that nothing needs."""
    used = names_in(kernel.outputs)
    blocks = [_kept(block, used) for block in reversed(kernel.blocks)]
    loads = tuple(load for load in kernel.loads if load.local in used)
    return replace(kernel, loads=loads, blocks=tuple(reversed(blocks)))


def _kept(block: Block, used: set[str]) -> Block:
    """The block without statements that nothing after them needs; what it needs itself is added to `used`."""
    checks = []
    for check in reversed(block.checks):
        used |= names_in((check.value, check.limit))
        checks.append(check if check.first is None else replace(check, first=_kept(check.first, used)))
    statements = []
    for statement in reversed(block.statements):
        if not used.isdisjoint(statement.targets):
            used |= names_in(statement.operands)
            statements.append(statement)
    return Block(tuple(reversed(statements)), tuple(reversed(checks)))


def _plain(check: Check) -> Check:
    return replace(check, first=None, apart=False)


def names_in(operands: Iterable[Operand]) -> set[str]:
    """The locals among operands."""
    return {operand.name for operand in operands if isinstance(operand, Local)}


def names_of_blocks(blocks: Sequence[Block]) -> set[str]:
    """Every local that blocks refer to, what runs only when a check fails included."""
    names: set[str] = set()
    for block in blocks:
        for statement in block.statements:
            names |= names_in(statement.operands)
        for check in block.checks:
            names |= names_of_check(check)
    return names


def names_of_check(check: Check) -> set[str]:
    """Every local that a check refers to, what it evaluates on failure included."""
    names = names_in((check.value, check.limit))
    return names if check.first is None else names | names_of_blocks([check.first])
