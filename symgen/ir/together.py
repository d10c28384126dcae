"""Several kernels in one, which works out once what they have in common.

Statements that do the same to the same values are one, so that each result has the bits it has alone.  A status other
than 0 is the first that any of the kernels would report, in their order, and no result is stored then.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

from symgen.ir.kernel import (
    Argument,
    Block,
    Check,
    Kernel,
    Literal,
    Load,
    Local,
    Operand,
    OperationName,
    Program,
    Statement,
)
from symgen.records import dataclass

# Operations whose operands may change places: IEEE rounds both orders the same.
_COMMUTATIVE: frozenset[OperationName] = frozenset({"add", "mul"})

_Key: TypeAlias = tuple[OperationName, tuple[tuple[str, object], ...]]
_Test: TypeAlias = tuple[Operand, Operand, bool]


@dataclass(frozen=True, slots=True)
class Together:
    """A kernel that has the outputs of `parts`, one behind the other, in their order."""

    kernel: Kernel
    parts: tuple[Kernel, ...]


def together(kernels: Sequence[Kernel]) -> Together:
    """One kernel for several of one program; arguments stand in the order in which the kernels first have them."""
    writer = _Writer()
    blocks = tuple(block for kernel in kernels for block in writer.blocks(kernel))
    outputs = tuple(entry for kernel in kernels for entry in writer.outputs[kernel.name])
    name = "_".join(kernel.name for kernel in kernels)
    loads = tuple(writer.loads.values())
    return Together(Kernel(name, _arguments(kernels), loads, blocks, outputs, (len(outputs),)), tuple(kernels))


def together_of(groups: Sequence[Sequence[str]], program: Program) -> tuple[Together, ...]:
    """Those of groups of names of which a program has every kernel."""
    known = {kernel.name: kernel for kernel in program.kernels}
    return tuple(together([known[name] for name in group]) for group in groups if known.keys() >= {*group})


def _arguments(kernels: Sequence[Kernel]) -> tuple[Argument, ...]:
    """The arguments of all, each where it stands first."""
    by_name = {argument.name: argument for kernel in kernels for argument in kernel.arguments}
    return tuple(by_name.values())


class _Writer:
    """What is written so far: values by what they are made of, so that none is made twice."""

    def __init__(self) -> None:
        self.loads: dict[tuple[str, int, str], Load] = {}
        self.outputs: dict[str, tuple[Operand, ...]] = {}
        self._taken: set[str] = set()
        self._known: dict[_Key, tuple[str, ...]] = {}
        self._passed: set[_Test] = set()

    def blocks(self, kernel: Kernel) -> list[Block]:
        """The blocks of one more kernel, without what is there already; notes its outputs."""
        image = {load.local: self._load(load) for load in kernel.loads}
        blocks = []
        for block in kernel.blocks:
            statements = tuple(self._new(block.statements, image))
            checks = (self._check(check, image) for check in block.checks)
            new = tuple(check for check in checks if self._is_new(check))
            blocks.append(Block(statements, new))
        self.outputs[kernel.name] = tuple(_moved(entry, image) for entry in kernel.outputs)
        return [block for block in blocks if block.statements or block.checks]

    def _load(self, load: Load) -> str:
        key = load.argument, load.index, load.member
        if key not in self.loads:
            self.loads[key] = replace(load, local=self._name(load.local))
        return self.loads[key].local

    def _new(self, statements: Sequence[Statement], image: dict[str, str]) -> list[Statement]:
        """The statements that make what no earlier one does; `image` is told where results of all of them are."""
        made = []
        for statement in statements:
            operands = tuple(_moved(operand, image) for operand in statement.operands)
            key = statement.operation, _places(statement.operation, operands)
            targets = self._known.get(key)
            if targets is None:
                targets = self._known[key] = tuple(map(self._name, statement.targets))
                made.append(Statement(targets, statement.operation, operands))
            image.update(zip(statement.targets, targets, strict=True))
        return made

    def _check(self, check: Check, image: dict[str, str]) -> Check:
        first = None if check.first is None else self._on_failure(check.first, image)
        return replace(check, value=_moved(check.value, image), limit=_moved(check.limit, image), first=first)

    def _on_failure(self, block: Block, outside: dict[str, str]) -> Block:
        """A block that runs only where a check fails: nothing else may rest on what it makes."""
        image = dict(outside)
        statements = []
        for statement in block.statements:
            operands = tuple(_moved(operand, image) for operand in statement.operands)
            targets = tuple(map(self._name, statement.targets))
            image.update(zip(statement.targets, targets, strict=True))
            statements.append(Statement(targets, statement.operation, operands))
        return Block(tuple(statements), tuple(self._check(check, image) for check in block.checks))

    def _is_new(self, check: Check) -> bool:
        """Whether a check can still fail: the same one was not passed before."""
        test = check.value, check.limit, check.inclusive
        new = test not in self._passed
        self._passed.add(test)
        return new

    def _name(self, wanted: str) -> str:
        """A name that no other value has."""
        name, number = wanted, 2
        while name in self._taken:
            name, number = f"{wanted}_{number}", number + 1
        self._taken.add(name)
        return name


def _moved(operand: Operand, image: dict[str, str]) -> Operand:
    return operand if isinstance(operand, Literal) else Local(image[operand.name])


def _places(operation: OperationName, operands: Sequence[Operand]) -> tuple[tuple[str, object], ...]:
    """What tells operands apart, in one order where theirs does not count."""
    places = [
        ("number", operand.value) if isinstance(operand, Literal) else ("local", operand.name) for operand in operands
    ]
    return tuple(sorted(places, key=repr) if operation in _COMMUTATIVE else places)
