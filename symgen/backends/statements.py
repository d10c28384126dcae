"""IR statements as source lines: one IEEE operation a line, the same operation in C and in NumPy."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

from symgen.backends.literals import c_literal, numpy_literal
from symgen.backends.scalars import C_TYPE
from symgen.ir.kernel import Block, Check, Function, Literal, Local, Operand, Scalar, Statement, Status
from symgen.ir.wide_functions import is_wide
from symgen.naming import c_identifiers
from symgen.records import dataclass

_INFIX = {"add": "+", "sub": "-", "mul": "*", "div": "/"}
_CHOICES = {"min": "<", "max": ">"}
_C_FUNCTIONS = {"abs": "fabs"}
_NUMPY_FUNCTIONS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "pow": "power"}


@dataclass(frozen=True, slots=True)
class CStatements:
    """Prints statements and checks as C99, which is C++11 too.

    `sincos` names the file's own sine/cosine function, None calls the library's, both halves through the function
    `both` where there is one; `status` maps a status to its enumerator; `rare` is the macro around failing checks;
    locals outside `used` are not printed where a statement has two targets; `cause` is the call that tells what a
    check fails of which keeps that apart.
    """

    scalar: Scalar
    names: Mapping[str, str]
    used: Collection[str]
    sincos: str | None = None
    status: Callable[[Status], str] = str
    both: str | None = None
    rare: str = ""
    cause: Callable[[Check], str] | None = None

    def operand(self, operand: Operand) -> str:
        """A local's identifier or a constant."""
        return self.names[operand.name] if isinstance(operand, Local) else c_literal(self.scalar, operand.value)

    def function(self, name: str) -> str:
        """The math.h function of the scalar type."""
        return _C_FUNCTIONS.get(name, name) + ("f" if self.scalar == "float32" else "")

    def statement(self, statement: Statement) -> tuple[str, ...]:
        """One statement as lines."""
        operands = [self.operand(operand) for operand in statement.operands]
        if statement.operation == "sincos":
            return self._sincos(statement.targets, operands[0])
        return (self._declare(statement.targets[0], self.expression(statement.operation, operands)),)

    def block(self, block: Block) -> tuple[str, ...]:
        """Statements, then checks."""
        statements = [line for statement in block.statements for line in self.statement(statement)]
        checks = [line for check in block.checks for line in self.check(check)]
        return (*statements, *checks)

    def _declare(self, target: str, expression: str) -> str:
        return f"const {C_TYPE[self.scalar]} {self.names[target]} = {expression};"

    def expression(self, operation: str, operands: Sequence[str]) -> str:
        """An operation with one result."""
        if operation in _INFIX:
            return f"{operands[0]} {_INFIX[operation]} {operands[1]}"
        if operation == "neg":
            return f"-{operands[0]}"
        if operation == "ratio_or_zero":
            zero = "0.0f" if self.scalar == "float32" else "0.0"
            one = "1.0f" if self.scalar == "float32" else "1.0"
            # clang takes divisions out of branches, so no divisor may be 0 on either side
            regular = f"{operands[1]} != {zero}"
            return f"(({regular}) ? {operands[0]} : {zero}) / (({regular}) ? {operands[1]} : {one})"
        if operation in _CHOICES:
            return f"({operands[0]} {_CHOICES[operation]} {operands[1]}) ? {operands[0]} : {operands[1]}"
        return f"{self.function(operation)}({', '.join(operands)})"

    def _sincos(self, targets: tuple[str, ...], angle: str) -> tuple[str, ...]:
        function = self.sincos
        if function is None and all(target in self.used for target in targets):
            function = self.both
        if function is None:
            pairs = zip(targets, ("sin", "cos"), strict=True)
            return tuple(self._declare(t, f"{self.function(name)}({angle})") for t, name in pairs if t in self.used)
        sine, cosine = (self.names[target] for target in targets)
        # Taking the address is a use, so a half that nothing reads gives no warning.
        kind = C_TYPE[self.scalar]
        return (f"{kind} {sine};", f"{kind} {cosine};", f"{function}({angle}, &{sine}, &{cosine});")

    def check(self, check: Check) -> tuple[str, ...]:
        """The early return of a failed check as lines."""
        relation = ">=" if check.inclusive else ">"
        # what tells one failure from another is off the regular way as a whole
        failed = f"!({self.operand(check.value)} {relation} {self.operand(check.limit)})"
        opened = f"if ({self.rare}({failed})) {{" if self.rare else f"if ({failed}) {{"
        if check.apart and self.cause is not None:
            return (opened, f"    return {self.cause(check)};", "}")
        return (opened, *(f"    {line}" for line in self.failure(check)), "}")

    def failure(self, check: Check) -> tuple[str, ...]:
        """What stands where a check has failed, up to the return of its status."""
        first = () if check.first is None else replace(self, rare="").block(check.first)
        return (*first, f"return {self.status(check.status)};")


@dataclass(frozen=True, slots=True)
class NumpyStatements:
    """Prints statements and checks as NumPy over arrays of states; a state keeps the first status it gets."""

    names: Mapping[str, str]
    used: Collection[str]
    sincos: str | None = None

    def operand(self, operand: Operand) -> str:
        """A local's identifier or a constant."""
        match operand:
            case Local(name):
                return self.names[name]
            case Literal(value):
                return numpy_literal(value)

    def statement(self, statement: Statement) -> tuple[str, ...]:
        """One statement as lines."""
        operands = [self.operand(operand) for operand in statement.operands]
        targets = [self.names[target] for target in statement.targets]
        if is_wide(statement):
            return (f"{', '.join(targets)} = _{statement.operation}({', '.join(operands)})",)
        if statement.operation != "sincos":
            return (f"{targets[0]} = {self._expression(statement.operation, operands)}",)
        if self.sincos is not None:
            return (f"{', '.join(targets)} = {self.sincos}({operands[0]})",)
        pairs = zip(statement.targets, ("sin", "cos"), strict=True)
        return tuple(f"{self.names[t]} = np.{name}({operands[0]})" for t, name in pairs if t in self.used)

    def block(self, block: Block, context: str = "") -> tuple[str, ...]:
        """Statements, then checks; `context` names the mask of states that this block is about (empty: all)."""
        statements = [line for statement in block.statements for line in self.statement(statement)]
        checks = [line for check in block.checks for line in self._check(check, context)]
        return (*statements, *checks)

    def _expression(self, operation: str, operands: list[str]) -> str:
        if operation in _INFIX:
            return f"{operands[0]} {_INFIX[operation]} {operands[1]}"
        if operation == "neg":
            return f"-{operands[0]}"
        if operation == "ratio_or_zero":
            return f"_ratio_or_zero({operands[0]}, {operands[1]})"
        if operation in _CHOICES:
            return f"np.where({operands[0]} {_CHOICES[operation]} {operands[1]}, {operands[0]}, {operands[1]})"
        return f"np.{_NUMPY_FUNCTIONS.get(operation, operation)}({', '.join(operands)})"

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


def c_body(scalar: Scalar, function: Function, taken: Collection[str]) -> tuple[Mapping[str, str], tuple[str, ...]]:
    """The names in a helper's body in C, none of them `taken`, and its lines."""
    names = _names(function, taken)
    printer = CStatements(scalar, names, frozenset(names))
    return names, tuple(line for statement in function.statements for line in printer.statement(statement))


def numpy_body(function: Function) -> tuple[Mapping[str, str], tuple[str, ...]]:
    """The same in NumPy."""
    names = _names(function, {"np"})
    printer = NumpyStatements(names, frozenset(names))
    return names, tuple(line for statement in function.statements for line in printer.statement(statement))


def _names(function: Function, taken: Collection[str]) -> dict[str, str]:
    own = [*function.parameters, *(target for statement in function.statements for target in statement.targets)]
    return c_identifiers(own, taken)
