"""Kernels that take the sines and cosines of coordinates from the caller, who has them from an encoder or a table.

Sines and cosines of sums of coordinates follow by addition; every other pair stays as it is, and so does that of a sum
whose rounding error the kernel carries along.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Operand, OperationName, Statement, Status
from symgen.ir.last_kernels import LastKernels
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.ir.split import pruned
from symgen.records import dataclass

# Coordinates in a sum, counted with their multiples, up to which addition is cheaper than another pair.
LONGEST_SUM = 4
Sum = dict[str, int]
Pair = tuple[Operand, Operand]


@dataclass(frozen=True, slots=True)
class GivenTrig:
    """A kernel whose loads from `sc` are sines and cosines: `sin_<coordinate>`, `cos_<coordinate>`.

    `coordinates` are the loads of the coordinates they belong to, in the order of q.
    """

    kernel: Kernel
    coordinates: tuple[Load, ...]


def given_trig(kernel: Kernel) -> GivenTrig | None:
    """The kernel with sines and cosines as an argument; None where it has none of a sum of coordinates.

    Beside operations on pairs of numbers a few sines are little, and given ones lack the digits.
    """
    return _GIVEN.of(kernel, lambda: _given_trig(kernel))


def _given_trig(kernel: Kernel) -> GivenTrig | None:
    if works_with_pairs(kernel):
        return None
    coordinates = {load.local: load for load in kernel.loads if load.argument == "q"}
    sums = _sums(kernel, coordinates)
    if not sums:
        return None
    used = {name for parts in sums.values() for name in parts}
    given = sorted((coordinates[name] for name in used), key=lambda load: load.index)
    taken = {load.local for load in kernel.loads}
    taken |= {target for block in kernel.blocks for s in block.all_statements() for target in s.targets}
    rewriter = _Rewriter(sums, _Fresh(taken), given)
    blocks = tuple(rewriter.block(block) for block in kernel.blocks)
    changed = replace(kernel, loads=(*kernel.loads, *rewriter.loads), blocks=blocks)
    changed = replace(changed, outputs=tuple(map(rewriter.operand, kernel.outputs)))
    made = pruned(changed)
    same_kernel(f"sines and cosines given to {kernel.name}", Lifted(kernel), Lifted(made))
    return GivenTrig(made, tuple(given))


# One kernel serves several files.
_GIVEN = LastKernels[GivenTrig | None](16)


def _sums(kernel: Kernel, coordinates: Mapping[str, Load]) -> dict[Operand, Sum]:
    """The arguments of pairs that are short sums of coordinates: how often each coordinate enters."""
    made = {
        statement.targets[0]: statement
        for block in kernel.blocks
        for statement in block.all_statements()
        if len(statement.targets) == 1
    }

    def parts(operand: Operand) -> Sum | None:
        if isinstance(operand, Literal):
            return None
        if operand.name in coordinates:
            return {operand.name: 1}
        statement = made.get(operand.name)
        match statement:
            case Statement(_, "neg", (a,)):
                return _combined(parts(a), -1, {}, 0)
            case Statement(_, ("add" | "sub") as operation, (a, b)):
                return _combined(parts(a), 1, parts(b), 1 if operation == "add" else -1)
            case Statement(_, "mul", (Literal(value), a)) | Statement(_, "mul", (a, Literal(value))):
                return _combined(parts(a), int(value), {}, 0) if value.denominator == 1 else None
        return None

    arguments = [s.operands[0] for block in kernel.blocks for s in block.all_statements() if s.operation == "sincos"]
    sums = {a: parts(a) for a in arguments}
    return {a: p for a, p in sums.items() if p and sum(map(abs, p.values())) <= LONGEST_SUM}


def _combined(a: Sum | None, times_a: int, b: Sum | None, times_b: int) -> Sum | None:
    if a is None or b is None:
        return None
    names = dict.fromkeys((*a, *b))
    total = {name: times_a * a.get(name, 0) + times_b * b.get(name, 0) for name in names}
    return {name: times for name, times in total.items() if times}


class _Fresh:
    """New names beside those in use."""

    def __init__(self, taken: set[str]) -> None:
        self._taken = taken

    def __call__(self, wanted: str) -> str:
        while wanted in self._taken:
            wanted += "_"
        self._taken.add(wanted)
        return wanted


class _Rewriter:
    """Replaces pairs by what addition makes of the given sines and cosines."""

    def __init__(self, sums: Mapping[Operand, Sum], fresh: _Fresh, given: list[Load]) -> None:
        self._sums = sums
        self._fresh = fresh
        self._known: dict[tuple[tuple[str, int], ...], Pair] = {}
        self._renamed: dict[str, Operand] = {}
        self._sizes: set[str] = set()
        self.loads: list[Load] = []
        self._single: dict[str, Pair] = {}
        for place, load in enumerate(given):
            names = [fresh(f"{half}_{load.local}") for half in ("sin", "cos")]
            self.loads += [
                Load(name, "sc", 2 * place + k, f"{half}_{load.local}")
                for k, (name, half) in enumerate(zip(names, ("sin", "cos"), strict=True))
            ]
            self._single[load.local] = Local(names[0]), Local(names[1])

    def operand(self, operand: Operand) -> Operand:
        """What stands for an operand now."""
        return self._renamed.get(operand.name, operand) if isinstance(operand, Local) else operand

    def block(self, block: Block) -> Block:
        """The block without pairs of sums and without the tests of their range."""
        statements: list[Statement] = []
        for statement in block.statements:
            argument = statement.operands[0]
            if statement.operation == "abs" and argument in self._sums:
                self._sizes.add(statement.targets[0])
            if statement.operation == "sincos" and argument in self._sums:
                pair = self._pair(self._sums[argument], statements)
                self._renamed |= dict(zip(statement.targets, pair, strict=True))
            else:
                operands = tuple(map(self.operand, statement.operands))
                same = operands == statement.operands
                statements.append(statement if same else Statement(statement.targets, statement.operation, operands))
        return Block(tuple(statements), tuple(self._check(c) for c in block.checks if not self._is_range_test(c)))

    def _is_range_test(self, check: Check) -> bool:
        return check.status is Status.ANGLE_RANGE and isinstance(check.limit, Local) and check.limit.name in self._sizes

    def _check(self, check: Check) -> Check:
        if check.first is None:
            first = None
        else:
            # what a failure computes is not there on the way of a regular state
            saved = dict(self._known), dict(self._renamed)
            first = self.block(check.first)
            self._known, self._renamed = saved
        return replace(check, value=self.operand(check.value), limit=self.operand(check.limit), first=first)

    def _pair(self, parts: Sum, statements: list[Statement]) -> Pair:
        """Sine and cosine of a sum, one coordinate after the other; statements already there serve again."""
        terms = [(name, 1 if times > 0 else -1) for name, times in parts.items() for _ in range(abs(times))]
        done: list[tuple[str, int]] = []
        pair: Pair | None = None
        for name, sign in terms:
            done.append((name, sign))
            key = tuple(done)
            if key not in self._known:
                self._known[key] = self._added(pair, self._single[name], sign, statements)
            pair = self._known[key]
        assert pair is not None
        return pair

    def _added(self, pair: Pair | None, other: Pair, sign: int, statements: list[Statement]) -> Pair:
        def emit(operation: OperationName, *operands: Operand) -> Local:
            target = self._fresh(f"sum{len(statements)}")
            statements.append(Statement((target,), operation, operands))
            return Local(target)

        (s, c) = other
        if pair is None:
            return (s, c) if sign > 0 else (emit("neg", s), c)
        (sine, cosine) = pair
        plus: OperationName = "add" if sign > 0 else "sub"
        minus: OperationName = "sub" if sign > 0 else "add"
        return (
            emit(plus, emit("mul", sine, c), emit("mul", cosine, s)),
            emit(minus, emit("mul", cosine, c), emit("mul", sine, s)),
        )
