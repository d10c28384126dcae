"""Statements and checks as NumPy over arrays of states; a state keeps the first status it gets."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fractions import Fraction

from symgen.backends.literals import decimal_text
from symgen.backends.python.reserved import WORDS
from symgen.backends.statements import Helper, Statements, helper, signed
from symgen.ir.kernel import Check, Function
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
        return self.halves(targets, angle)

    def check(self, check: Check, context: str) -> tuple[str, ...]:
        """A status for what fails; `context` names the mask of states that this is about (empty: all)."""
        failed = f"~np.asarray({self.passes(check)})"
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
