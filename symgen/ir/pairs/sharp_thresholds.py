"""Thresholds of float32 kernels that work with pairs: as low as the digits of these allow."""

from __future__ import annotations

from collections.abc import Container, Iterator
from dataclasses import replace

from symgen.ir.kernel import Block, Check, Kernel, Literal, Local, Operand, Status

# Binary digits by which thresholds in eps are lower, of the 22 that pairs gain: below, squares are so small that their
# rests are no numbers.
LOWERED = 12
# Binary digits that a float64 has more than a float32: thresholds in eps of the two types differ by powers of it.
BETWEEN_TYPES = 29


def with_sharp_thresholds(single: Kernel, double: Kernel) -> Kernel:
    """A float32 kernel with thresholds of status as its pairs allow, where it differs from that in float64 by these.

    They are multiples of eps or its square, eps that of a type; angles stay in the range of the sine.  A pair has the
    exponents of its type: thresholds do not follow its digits all the way.  Those of closing rows stay: errors of sines
    turn an iterate by eps of itself, each time anew, so that steps get no shorter than that.
    """
    sharp = _Thresholds({name for block in single.blocks for name in _tested(block, Status.NOT_CLOSED)})
    if _shape(single) != _shape(double):
        return single
    blocks = [sharp.block(one, other) for one, other in zip(single.blocks, double.blocks, strict=True)]
    return replace(single, blocks=tuple(blocks))


def _shape(kernel: Kernel) -> list[object]:
    shape: list[object] = []

    def add(block: Block) -> None:
        shape.extend((one.targets, one.operation, len(one.operands)) for one in block.statements)
        for check in block.checks:
            shape.append((check.status, check.inclusive, check.first is None))
            if check.first is not None:
                add(check.first)

    for block in kernel.blocks:
        add(block)
    return shape


def _tested(block: Block, status: Status) -> Iterator[str]:
    """The names of what is compared for a status."""
    for check in block.checks:
        if check.status is status:
            yield from (one.name for one in (check.value, check.limit) if isinstance(one, Local))
        if check.first is not None:
            yield from _tested(check.first, status)


class _Thresholds:
    """Literals of two types side by side; statements that make what is in `kept` stay as they are."""

    def __init__(self, kept: Container[str]) -> None:
        self._kept = kept

    def block(self, single: Block, double: Block) -> Block:
        """The block with sharp literals."""
        lines = zip(single.statements, double.statements, strict=True)
        statements = [
            a
            if any(target in self._kept for target in a.targets)
            else replace(a, operands=tuple(map(self._literal, a.operands, b.operands)))
            for a, b in lines
        ]
        checks = [self._check(a, b) for a, b in zip(single.checks, double.checks, strict=True)]
        return Block(tuple(statements), tuple(checks))

    def _check(self, single: Check, double: Check) -> Check:
        first = single.first
        if first is not None and double.first is not None:
            first = self.block(first, double.first)
        if single.status in (Status.ANGLE_RANGE, Status.NOT_CLOSED):
            return replace(single, first=first)
        value, limit = (self._literal(a, b) for a, b in ((single.value, double.value), (single.limit, double.limit)))
        return replace(single, value=value, limit=limit, first=first)

    @staticmethod
    def _literal(single: Operand, double: Operand) -> Operand:
        if not (isinstance(single, Literal) and isinstance(double, Literal)) or not single.value or not double.value:
            return single
        ratio = single.value / double.value
        bits = ratio.numerator.bit_length() - 1
        times, rest = divmod(bits, BETWEEN_TYPES)
        if rest or ratio != 2**bits:
            return single
        return Literal(single.value / 2 ** (times * LOWERED))
