"""Sums of angles in kernels with twice the digits: which sines and cosines follow from those of their parts.

The sine of a sum is rounded on its own.  Beside that of one of its parts, as on a leg that is nearly stretched, what is
left of both is lost however many digits products and sums have: their angles are apart by less than either is off.
By the addition theorem both turn by the same rest of an angle, as if the input were rounded.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from symgen.ir.kernel import Block, Kernel, Literal, Local, Operand, Statement, Status
from symgen.records import dataclass

# Angles of which a sum is made anew; each is a turn of six operations on pairs.
MOST_PARTS = 12


@dataclass(frozen=True, slots=True)
class AngleSum:
    """How often, and in which direction, each loaded angle and each literal stands in a sum, in their order."""

    parts: tuple[tuple[Operand, int], ...]

    @property
    def count(self) -> int:
        """How many angles are added up."""
        return sum(abs(times) for _, times in self.parts)

    def without(self, part: Operand) -> AngleSum:
        """One time less of an angle."""
        left = ((x, k - self.direction(x) * (x == part)) for x, k in self.parts)
        return AngleSum(tuple((x, k) for x, k in left if k))

    def direction(self, part: Operand) -> int:
        """1 or -1."""
        return 1 if dict(self.parts)[part] > 0 else -1


def sums_of_shared_angles(kernel: Kernel) -> dict[str, AngleSum]:
    """Angles that are sums of loaded ones and literals, some of which other sines of the kernel are made of, too."""
    known: dict[str, Counter[Operand] | None] = {}
    for load in kernel.loads:
        known[load.local] = Counter({Local(load.local): 1})
    angles: dict[str, Counter[Operand]] = {}
    for statement in kernel.statements:
        if statement.operation == "sincos":
            (angle,) = statement.operands
            form = _form(angle, known)
            if isinstance(angle, Local) and form:
                angles[angle.name] = form
        elif statement.operation in ("add", "sub", "neg"):
            known[statement.targets[0]] = _sum(statement, known)
    users = Counter(part for form in angles.values() for part in form)
    return {
        angle: AngleSum(tuple(sorted(form.items(), key=_order)))
        for angle, form in angles.items()
        if 1 < sum(map(abs, form.values())) <= MOST_PARTS and any(users[part] > 1 for part in form)
    }


def _order(part: tuple[Operand, int]) -> tuple[str, Fraction]:
    x, _ = part
    return ("", x.value) if isinstance(x, Literal) else (x.name, Fraction(0))


def _sum(statement: Statement, known: Mapping[str, Counter[Operand] | None]) -> Counter[Operand] | None:
    signs = {"add": (1, 1), "sub": (1, -1), "neg": (-1,)}[statement.operation]
    total: Counter[Operand] = Counter()
    for operand, sign in zip(statement.operands, signs, strict=True):
        form = _form(operand, known)
        if form is None:
            return None
        for part, count in form.items():
            total[part] += sign * count
    return Counter({part: count for part, count in total.items() if count})


def _form(x: Operand, known: Mapping[str, Counter[Operand] | None]) -> Counter[Operand] | None:
    return Counter({x: 1}) if isinstance(x, Literal) else known.get(x.name)


def with_ranges(blocks: list[Block], angles: list[str], taken: set[str]) -> list[Block]:
    """The blocks with the test of the range of angles for further ones, where the kernel has one."""
    for place, block in enumerate(blocks):
        given = next((check for check in block.checks if check.status is Status.ANGLE_RANGE), None)
        if given is None:
            continue
        statements, checks = list(block.statements), list(block.checks)
        for angle in angles:
            size = f"size_of_{angle}"
            while size in taken:
                size += "_"
            taken.add(size)
            statements.append(Statement((size,), "abs", (Local(angle),)))
            checks.insert(0, replace(given, limit=Local(size)))
        return [*blocks[:place], Block(tuple(statements), tuple(checks)), *blocks[place + 1 :]]
    return blocks
