"""Work that depends on parameters only, done once: its results as values that kernels read instead of parameters."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from symgen.ir.kernel import Kernel, Literal, Load, Local, Program, Statement
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.ir.split import Split, names_in, names_of_blocks, split
from symgen.records import dataclass

# A prepared kernel is made where it saves at least this share of the operations of a call.
WORTHWHILE = Fraction(1, 10)
# What a local stands for: a parameter, or one of the targets of an operation on such.
_Meaning: TypeAlias = tuple[object, ...]


@dataclass(frozen=True, slots=True)
class Prepared:
    """`values` of one set of parameters, computed by `statements` from `loads`; `kernels` load them as argument `p`.

    The index of such a load is the place in `values`.
    """

    loads: tuple[Load, ...]
    statements: tuple[Statement, ...]
    values: tuple[Local, ...]
    kernels: tuple[Kernel, ...]


def prepare(program: Program, names: Collection[str]) -> Prepared | None:
    """The kernels among `names` that are worth it, with what they share computed once; None without any.

    The operations left are performed on the same numbers in the same order: results have the same bits.
    """
    chosen = [(kernel, split(kernel)) for kernel in program.kernels if kernel.name in names]
    chosen = [(kernel, parts) for kernel, parts in chosen if _worthwhile(kernel, parts)]
    if not chosen:
        return None
    shared = _Shared({load.local for kernel, _ in chosen for load in kernel.loads if load.argument == "p"})
    kernels = tuple(shared.kernel(kernel, parts) for kernel, parts in chosen)
    prepared = Prepared(tuple(shared.loads.values()), tuple(shared.statements), tuple(shared.values), kernels)
    for (given, _), kernel in zip(chosen, kernels, strict=True):
        whole = Lifted(kernel, prepared.loads, prepared.statements, prepared.values)
        same_kernel(f"preparing parameters of {kernel.name}", Lifted(given), whole)
    return prepared


def _worthwhile(kernel: Kernel, parts: Split) -> bool:
    if works_with_pairs(kernel):  # what parameters alone take is little beside these
        return False
    return bool(parts.fixed) and len(parts.fixed) >= WORTHWHILE * len(kernel.statements)


class _Shared:
    """Statements of several kernels, each once; their names are new, because each kernel counts its own."""

    def __init__(self, taken: Collection[str]) -> None:
        self._taken = taken
        self._count = 0
        self.loads: dict[str, Load] = {}
        self.statements: list[Statement] = []
        self.values: dict[Local, int] = {}
        self._known: dict[_Meaning, tuple[str, ...]] = {}

    def kernel(self, kernel: Kernel, parts: Split) -> Kernel:
        """The kernel without its fixed statements."""
        local = {load.local: load.local for load in kernel.loads if load.argument == "p"}
        parameters = {load.local: load for load in kernel.loads if load.argument == "p"}
        for statement in parts.fixed:
            self._add(statement, local, parameters)
        needed = names_of_blocks(parts.blocks) | names_in(kernel.outputs)
        loads = [load for load in kernel.loads if load.argument != "p"]
        for name in (name for name in local if name in needed):
            if name in parameters:
                self.loads[name] = parameters[name]
            place = self.values.setdefault(Local(local[name]), len(self.values))
            loads.append(Load(name, "p", place, f"value[{place}]"))
        return replace(kernel, loads=tuple(loads), blocks=parts.blocks)

    def _add(self, statement: Statement, local: dict[str, str], parameters: dict[str, Load]) -> None:
        for operand in statement.operands:
            if isinstance(operand, Local) and operand.name in parameters:
                self.loads[operand.name] = parameters[operand.name]
        operands = tuple(o if isinstance(o, Literal) else Local(local[o.name]) for o in statement.operands)
        meaning = statement.operation, operands
        if meaning not in self._known:
            targets = self._known[meaning] = tuple(self._name() for _ in statement.targets)
            self.statements.append(replace(statement, targets=targets, operands=operands))
        local.update(zip(statement.targets, self._known[meaning], strict=True))

    def _name(self) -> str:
        while True:
            self._count += 1
            if (name := f"v{self._count}") not in self._taken:
                return name
