"""Statements and checks on arrays of a namespace `xp`; a state keeps the first status it gets, and nothing branches."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fractions import Fraction

from symgen.backends.array_api.reserved import WORDS
from symgen.backends.literals import in_range
from symgen.backends.statements import Helper, Statements, helper, signed
from symgen.ir.kernel import Check, Function, Literal, Operand, Scalar
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class ArrayStatements(Statements):
    """Prints statements and checks; of a sine and a cosine what is `used`."""

    scalar: Scalar
    names: Mapping[str, str]
    used: Collection[str]

    def literal(self, value: Fraction) -> str:
        """A Python float, which takes the type of the array beside it."""
        return signed(repr(in_range(self.scalar, value)))

    def argument(self, operand: Operand) -> str:
        """An array: functions take nothing else."""
        spelled = self.operand(operand)
        return f"_real(xp, {spelled.strip('()')})" if isinstance(operand, Literal) else spelled

    def of_pairs(self, operation: str) -> str:
        """A function of the module, with the namespace."""
        return f"_{operation}(xp, "

    def function(self, name: str) -> str:
        """A function of the namespace."""
        return f"xp.{name}"

    def ratio_or_zero(self, above: str, below: str) -> str:
        """A function of the module."""
        return f"_ratio_or_zero(xp, {above}, {below})"

    def choice(self, condition: str, yes: str, no: str) -> str:
        """One of two values, by state."""
        return f"xp.where({condition}, {yes}, {no})"

    def sincos(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        """The namespace's: a pair that rounds its angle to quadrants has no derivative that tools could find."""
        return self.halves(targets, angle)

    def check(self, check: Check, context: str) -> tuple[str, ...]:
        """A status for what fails; `context` names the mask of states that this is about (empty: all)."""
        failed = f"~({self.passes(check)})"
        failed = f"{context} & {failed}" if context else failed
        if check.first is None:
            return (f"status = _first(xp, status, {failed}, {int(check.status)})",)
        mask = f"{context or '_failed'}_"  # a leading underscore is no name of the user's
        return (
            f"{mask} = {failed}",
            *self.block(check.first, mask),
            f"status = _first(xp, status, {mask}, {int(check.status)})",
        )


def array_helper(scalar: Scalar, function: Function) -> Helper:
    """A function that kernels share."""
    return helper(function, lambda names: ArrayStatements(scalar, names, frozenset(names)), WORDS.is_taken, {"xp"})
