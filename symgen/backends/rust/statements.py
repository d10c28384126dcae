"""Statements and checks as Rust."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction

from symgen.backends.literals import decimal_text
from symgen.backends.rust.reserved import WORDS
from symgen.backends.statements import Helper, Statements, helper, signed
from symgen.ir.kernel import Check, Function, Operand, Scalar, Status
from symgen.records import dataclass


def status_name(status: Status) -> str:
    """The variant of a status."""
    return status.name.title().replace("_", "")


@dataclass(frozen=True, slots=True)
class RustStatements(Statements):
    """Prints statements and checks; of two targets the one that is not `used` gets no name.

    `own_pair` says that the crate has its own sine and cosine; without one they are the standard library's.  What is
    `declared` before has no `let`.
    """

    scalar: Scalar
    names: Mapping[str, str]
    used: Collection[str]
    own_pair: bool = True
    declared: bool = False

    def literal(self, value: Fraction) -> str:
        """A constant, whose type follows from what stands beside it."""
        return signed(decimal_text(self.scalar, value))

    def argument(self, operand: Operand) -> str:
        """Without parentheses, which the compiler complains about where they are not needed."""
        return self.operand(operand).strip("()")

    def declare(self, targets: Sequence[str], expression: str) -> str:
        """A binding, or two."""
        names = ", ".join(self.names[target] if target in self.used else "_" for target in targets)
        return f"{'' if self.declared else 'let '}{names if len(targets) == 1 else f'({names})'} = {expression};"

    def of_pairs(self, operation: str) -> str:
        """A function of the module."""
        return f"{operation}("

    def function(self, name: str) -> str:
        """A function of the module."""
        return name

    def ratio_or_zero(self, above: str, below: str) -> str:
        """A function of the module."""
        return f"ratio_or_zero({above}, {below})"

    def choice(self, condition: str, yes: str, no: str) -> str:
        """One of two values."""
        return f"if {condition} {{ {yes} }} else {{ {no} }}"

    def sincos(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        """A call, or two."""
        if self.own_pair:
            return (self.declare(targets, f"sincos({angle})"),)
        return self.halves(targets, angle)

    def check(self, check: Check, context: str = "") -> tuple[str, ...]:
        """The early return of a failed check."""
        del context  # one state at a time
        first = () if check.first is None else self.block(check.first)
        failed = f"return Err(Status::{status_name(check.status)});"
        return (f"if !({self.passes(check)}) {{", *(f"    {line}" for line in (*first, failed)), "}")


def rust_helper(scalar: Scalar, function: Function) -> Helper:
    """A function that kernels share."""
    return helper(function, lambda names: RustStatements(scalar, names, frozenset(names)), WORDS.is_taken, ())
