"""Statements and checks as NumPy over arrays of states; a state keeps the first status it gets."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction

from symgen.backends.literals import decimal_text
from symgen.backends.python.reserved import WORDS
from symgen.backends.statements import Helper, Statements, helper, signed
from symgen.ir.kernel import Block, Check, Function
from symgen.records import dataclass

_FUNCTIONS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "pow": "power"}


def numpy_literal(value: Fraction) -> str:
    """A Python float; negative ones in parentheses."""
    return signed(decimal_text("float64", value))


@dataclass(frozen=True, slots=True)
class NumpyStatements(Statements):
    """Prints statements and checks; `sincos_name` names the module's pair, None calls NumPy's for what is `used`."""

    names: Mapping[str, str]
    used: Collection[str]
    sincos_name: str | None = None

    def literal(self, value: Fraction) -> str:
        """A float."""
        return numpy_literal(value)

    def function(self, name: str) -> str:
        """A universal function."""
        return f"np.{_FUNCTIONS.get(name, name)}"

    def declare(self, targets: Sequence[str], expression: str) -> str:
        """An assignment."""
        return f"{', '.join(self.names[target] for target in targets)} = {expression}"

    def ratio_or_zero(self, above: str, below: str) -> str:
        """A function of the module."""
        return f"_ratio_or_zero({above}, {below})"

    def choice(self, condition: str, yes: str, no: str) -> str:
        """One of two values, by state."""
        return f"np.where({condition}, {yes}, {no})"

    def sincos(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        """A call, or two."""
        if self.sincos_name is not None:
            return (self.declare(targets, f"{self.sincos_name}({angle})"),)
        halves = ((t, half) for t, half in zip(targets, ("sin", "cos"), strict=True) if t in self.used)
        return tuple(self.declare((target,), f"{self.function(half)}({angle})") for target, half in halves)

    def block(self, block: Block, context: str = "") -> tuple[str, ...]:
        """Statements, then checks; `context` names the mask of states that this block is about (empty: all)."""
        statements = [line for statement in block.statements for line in self.statement(statement)]
        checks = [line for check in block.checks for line in self._check(check, context)]
        return (*statements, *checks)

    def _check(self, check: Check, context: str) -> tuple[str, ...]:
        relation = ">=" if check.inclusive else ">"
        failed = f"~np.asarray({self.operand(check.value)} {relation} {self.operand(check.limit)})"
        if context:
            failed = f"{context} & {failed}"
        if check.first is None:
            return (f"status = _first(status, {failed}, {int(check.status)})",)
        mask = f"{context or '_failed'}_"  # a leading underscore is no name of the user's
        return (
            f"{mask} = {failed}",
            f"if np.any({mask} & (status == 0)):",
            *(f"    {line}" for line in self.block(check.first, mask)),
            f"    status = _first(status, {mask}, {int(check.status)})",
        )


def numpy_helper(function: Function) -> Helper:
    """A function that kernels share."""
    return helper(function, lambda names: NumpyStatements(names, frozenset(names)), WORDS.is_taken, {"np"})
