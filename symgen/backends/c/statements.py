"""Statements and checks as C99, which is C++11 too."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.backends.c.reserved import is_taken
from symgen.backends.literals import decimal_text
from symgen.backends.scalars import C_TYPE
from symgen.backends.statements import Helper, Statements, helper, signed
from symgen.ir.kernel import Check, Function, Scalar, Status
from symgen.records import dataclass

_FUNCTIONS = {"abs": "fabs"}


def c_literal(scalar: Scalar, value: Fraction) -> str:
    """A C constant of the scalar type; negative ones in parentheses."""
    return signed(decimal_text(scalar, value) + ("f" if scalar == "float32" else ""))


@dataclass(frozen=True, slots=True)
class CStatements(Statements):
    """Prints statements and checks.

    `sincos_name` names the file's own sine/cosine function, None calls the library's, both halves through the function
    `both` where there is one; `status` maps a status to its enumerator; `rare` is the macro around failing checks;
    locals outside `used` are not printed where a statement has two targets; `cause` is the call that tells what a
    check fails of which keeps that apart.
    """

    scalar: Scalar
    names: Mapping[str, str]
    used: Collection[str]
    sincos_name: str | None = None
    status: Callable[[Status], str] = str
    both: str | None = None
    rare: str = ""
    cause: Callable[[Check], str] | None = None

    def literal(self, value: Fraction) -> str:
        """A constant of the scalar type."""
        return c_literal(self.scalar, value)

    def function(self, name: str) -> str:
        """The math.h function of the scalar type."""
        return _FUNCTIONS.get(name, name) + ("f" if self.scalar == "float32" else "")

    def declare(self, targets: Sequence[str], expression: str) -> str:
        """A constant."""
        return f"const {C_TYPE[self.scalar]} {self.names[targets[0]]} = {expression};"

    def ratio_or_zero(self, above: str, below: str) -> str:
        """A quotient whose divisor is 0 on no side: clang takes divisions out of branches."""
        zero, one = (self.literal(Fraction(number)) for number in (0, 1))
        regular = f"{below} != {zero}"
        return f"(({regular}) ? {above} : {zero}) / (({regular}) ? {below} : {one})"

    def choice(self, condition: str, yes: str, no: str) -> str:
        """One of two values."""
        return f"({condition}) ? {yes} : {no}"

    def sincos(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        """A call, or two."""
        function = self.sincos_name
        if function is None and all(target in self.used for target in targets):
            function = self.both
        if function is None:
            return self.halves(targets, angle)
        sine, cosine = (self.names[target] for target in targets)
        # Taking the address is a use, so a half that nothing reads gives no warning.
        kind = C_TYPE[self.scalar]
        return (f"{kind} {sine};", f"{kind} {cosine};", f"{function}({angle}, &{sine}, &{cosine});")

    def check(self, check: Check, context: str = "") -> tuple[str, ...]:
        """The early return of a failed check; what tells one failure from another is off the regular way as a whole."""
        del context  # one state at a time
        failed = f"!({self.passes(check)})"
        opened = f"if ({self.rare}({failed})) {{" if self.rare else f"if ({failed}) {{"
        if check.apart and self.cause is not None:
            return (opened, f"    return {self.cause(check)};", "}")
        return (opened, *(f"    {line}" for line in self.failure(check)), "}")

    def failure(self, check: Check) -> tuple[str, ...]:
        """What stands where a check has failed, up to the return of its status."""
        first = () if check.first is None else replace(self, rare="").block(check.first)
        return (*first, f"return {self.status(check.status)};")


def c_helper(scalar: Scalar, function: Function, taken: Collection[str]) -> Helper:
    """A function that kernels share, in C."""
    return helper(function, lambda names: CStatements(scalar, names, frozenset(names)), is_taken, taken)
