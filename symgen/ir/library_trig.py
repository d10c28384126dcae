"""A program whose sines and cosines are the C library's: every angle is in range, and bits are those of the library."""

from __future__ import annotations

from dataclasses import replace

from symgen.ir.kernel import Block, Kernel, Local, Program, Status
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.split import names_in, names_of_blocks


def with_library_trig(program: Program) -> Program:
    """The same kernels without the portable pair and without the tests of its range."""
    return replace(program, sincos=None, kernels=tuple(map(_without_range_tests, program.kernels)))


def _without_range_tests(kernel: Kernel) -> Kernel:
    sizes = {name for block in kernel.blocks for name in _sizes(block)}
    blocks = tuple(map(_without_checks, kernel.blocks))
    unused = sizes - names_of_blocks(blocks) - names_in(kernel.outputs)
    changed = replace(kernel, blocks=tuple(_without_statements(block, unused) for block in blocks))
    same_kernel(f"leaving out range tests of {kernel.name}", Lifted(kernel), Lifted(changed))
    return changed


def _sizes(block: Block) -> set[str]:
    """The magnitudes that only range tests may look at."""
    names = {c.value.name if isinstance(c.value, Local) else "" for c in block.checks if _is_range(c.status)}
    names |= {c.limit.name for c in block.checks if _is_range(c.status) and isinstance(c.limit, Local)}
    return names.union(*(_sizes(c.first) for c in block.checks if c.first is not None))


def _without_checks(block: Block) -> Block:
    kept = (check for check in block.checks if not _is_range(check.status))
    checks = (c if c.first is None else replace(c, first=_without_checks(c.first)) for c in kept)
    return replace(block, checks=tuple(checks))


def _without_statements(block: Block, unused: set[str]) -> Block:
    statements = (statement for statement in block.statements if not unused.issuperset(statement.targets))
    checks = (c if c.first is None else replace(c, first=_without_statements(c.first, unused)) for c in block.checks)
    return Block(tuple(statements), tuple(checks))


def _is_range(status: Status) -> bool:
    return status is Status.ANGLE_RANGE
