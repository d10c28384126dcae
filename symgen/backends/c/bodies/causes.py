"""What tells the causes of a failure apart, as a function of its own where values of a kernel would wait for it."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.backends.c.statements import CStatements
from symgen.backends.locals import Names, array_arguments, check_operands
from symgen.backends.scalars import C_TYPE
from symgen.ir.kernel import Check, Kernel, Load, Local, Operand
from symgen.ir.split import names_of_blocks
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class CauseView:
    """A function that returns the status of a failed check: prototype without semicolon, body lines."""

    prototype: str
    body: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Cause:
    """The function `name` for a check that keeps its causes apart.

    It reads `loads` by itself; `given` are the other values of the kernel that it needs: sines and cosines.
    """

    name: str
    check: Check
    loads: tuple[Load, ...]
    given: tuple[Local, ...]

    def call(self, kernel: Kernel, names: Names) -> str:
        """The call from within the kernel."""
        return f"{self.name}({', '.join([*self.pointers(kernel), *(names.locals[o.name] for o in self.given)])})"

    def pointers(self, kernel: Kernel) -> list[str]:
        """The arguments of the kernel that are handed on."""
        read = {load.argument for load in self.loads}
        return [name for name in ("sc", *(a.name for a in array_arguments(kernel)), "p") if name in read]


def causes_of(kernel: Kernel, function: str) -> tuple[Cause, ...]:
    """The causes that a kernel whose function is called `function` keeps apart."""
    checks = [check for block in kernel.blocks for check in block.checks if check.apart]
    return tuple(_cause(kernel, check, name) for check, name in zip(checks, cause_names(kernel, function), strict=True))


def cause_names(kernel: Kernel, function: str) -> list[str]:
    """The names of their functions."""
    count = sum(check.apart for block in kernel.blocks for check in block.checks)
    return [f"{function}_cause{number if number > 1 else ''}" for number in range(1, count + 1)]


def cause_view(cause: Cause, kernel: Kernel, names: Names, printer: CStatements, types: Mapping[str, str]) -> CauseView:
    """The function; `types` declares what it returns (under "") and the arguments that are no arrays."""
    scalar = C_TYPE[printer.scalar]
    declared = dict(types) | {a.name: f"const {scalar} {a.name}[{a.length}]" for a in array_arguments(kernel)}
    arguments = [declared[name] for name in cause.pointers(kernel)]
    arguments += [f"const {scalar} {names.locals[value.name]}" for value in cause.given]
    loads = [f"const {scalar} {names.locals[load.local]} = {place(load, names)};" for load in cause.loads]
    prototype = f"{types['']} {cause.name}({', '.join(arguments)})"
    return CauseView(prototype, (*loads, *printer.failure(cause.check)))


def place(load: Load, names: Names) -> str:
    """Where a value is read."""
    if load.argument == "p":
        return f"p->{names.members[load.member]}"
    return f"sc->{load.member}" if load.argument == "sc" else f"{load.argument}[{load.index}]"


def operands_of(check: Check, causes: tuple[Cause, ...]) -> tuple[Operand, ...]:
    """What the kernel itself needs for a check: the values its cause is called with in place of what it computes."""
    cause = next((cause for cause in causes if cause.check is check), None)
    return tuple(check_operands(check)) if cause is None else (check.value, check.limit, *cause.given)


def _cause(kernel: Kernel, check: Check, name: str) -> Cause:
    assert check.first is not None
    needed = names_of_blocks([check.first])
    loads = tuple(load for load in kernel.loads if load.local in needed)
    known = {target for block in kernel.blocks for statement in block.statements for target in statement.targets}
    return Cause(name, check, loads, tuple(Local(name) for name in sorted(needed & known)))
