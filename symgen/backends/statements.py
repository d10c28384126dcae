"""One walk over statements of the IR for all languages: one IEEE operation a line, the same operation in each."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping, Sequence
from fractions import Fraction

from symgen.ir.kernel import Block, Check, Function, Local, Operand, Statement
from symgen.ir.pairs.wide_functions import is_wide
from symgen.naming import identifiers
from symgen.records import dataclass

INFIX = {"add": "+", "sub": "-", "mul": "*", "div": "/"}
_CHOICES = {"min": "<", "max": ">"}
_OPERATORS = {*INFIX, "neg"}


class Statements(ABC):
    """What a language says of each kind of statement and of checks.

    `names` are those of the locals; of a sine and a cosine that are two functions, what is not `used` is left out.
    """

    __slots__ = ()
    names: Mapping[str, str]
    used: Collection[str]

    @abstractmethod
    def literal(self, value: Fraction) -> str:
        """An exact number, rounded once."""

    @abstractmethod
    def function(self, name: str) -> str:
        """What a function of the IR is called."""

    @abstractmethod
    def ratio_or_zero(self, above: str, below: str) -> str:
        """`above / below`, and 0 where `below` is 0."""

    @abstractmethod
    def choice(self, condition: str, yes: str, no: str) -> str:
        """One of two values."""

    @abstractmethod
    def sincos(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        """The lines that give names to a sine and a cosine."""

    @abstractmethod
    def check(self, check: Check, context: str) -> tuple[str, ...]:
        """The lines of a check; `context` says which states it is about where that is not all."""

    def declare(self, targets: Sequence[str], expression: str) -> str:
        """The line that gives names to results."""
        return f"{', '.join(self.names[target] for target in targets)} = {expression}"

    def of_pairs(self, operation: str) -> str:
        """The file's own function for an operation on pairs of numbers, up to its operands."""
        return f"_{operation}("

    def argument(self, operand: Operand) -> str:
        """An operand of what is no operator."""
        return self.operand(operand)

    def operand(self, operand: Operand) -> str:
        """A local's identifier or a constant."""
        return self.names[operand.name] if isinstance(operand, Local) else self.literal(operand.value)

    def halves(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        """A sine and a cosine as two functions."""
        pairs = ((target, half) for target, half in zip(targets, ("sin", "cos"), strict=True) if target in self.used)
        return tuple(self.declare((target,), f"{self.function(half)}({angle})") for target, half in pairs)

    def passes(self, check: Check) -> str:
        """The condition of a check, which NaN does not meet."""
        return f"{self.argument(check.value)} {'>=' if check.inclusive else '>'} {self.argument(check.limit)}"

    def block(self, block: Block, context: str = "") -> tuple[str, ...]:
        """Statements, then checks."""
        statements = [line for statement in block.statements for line in self.statement(statement)]
        return (*statements, *(line for check in block.checks for line in self.check(check, context)))

    def statement(self, statement: Statement) -> tuple[str, ...]:
        """One statement as lines."""
        spelled = self.operand if statement.operation in _OPERATORS else self.argument
        operands = [spelled(operand) for operand in statement.operands]
        if statement.operation == "sincos":
            return self.sincos(statement.targets, operands[0])
        if is_wide(statement):
            return (self.declare(statement.targets, f"{self.of_pairs(statement.operation)}{', '.join(operands)})"),)
        return (self.declare(statement.targets, self.expression(statement.operation, operands)),)

    def expression(self, operation: str, operands: Sequence[str]) -> str:
        """An operation with one result."""
        if operation in INFIX:
            return f"{operands[0]} {INFIX[operation]} {operands[1]}"
        if operation == "neg":
            return f"-{operands[0]}"
        if operation == "ratio_or_zero":
            return self.ratio_or_zero(*operands)
        if operation in _CHOICES:
            return self.choice(f"{operands[0]} {_CHOICES[operation]} {operands[1]}", *operands)
        return f"{self.function(operation)}({', '.join(operands)})"


@dataclass(frozen=True, slots=True)
class Helper:
    """A function that kernels share, such as the sine and cosine: parameters, lines, and where the results are."""

    parameters: tuple[str, ...]
    body: tuple[str, ...]
    results: tuple[str, ...]


def helper(
    function: Function,
    printer: Callable[[Mapping[str, str]], Statements],
    is_taken: Callable[[str], bool],
    taken: Collection[str],
) -> Helper:
    """The function in a language, its names none of those `taken`; `printer` is made for the names."""
    own = [*function.parameters, *(target for statement in function.statements for target in statement.targets)]
    names = identifiers(own, is_taken, taken)
    spelled = printer(names)
    parameters, results = (tuple(names[one] for one in part) for part in (function.parameters, function.results))
    lines = (line for statement in function.statements for line in spelled.statement(statement))
    return Helper(parameters, tuple(lines), results)


def signed(text: str) -> str:
    """A number as an operand: negative ones in parentheses."""
    return f"({text})" if text.startswith("-") else text
