"""Kernels that carry along what rounding takes of their results, to first order.

Each operation stays as it is.  Beside its result v stands an e, so that v + e is what exact operations give, but for
terms of eps^2: what the rounded sum (Knuth), product (Dekker, Veltkamp), quotient and root lack, and what the errors of
the operands do to the result (Langlois, Automatic linear correction of rounding errors, BIT 41, 2001; Ogita, Rump,
Oishi, SIAM J. Sci. Comput. 26, 2005).  The outputs are v + e.  What is left is what rounding of the inputs does.

Sines and cosines are brought back to the unit circle: 1 - s^2 - c^2 follows from s and c alone.  What is left of their
errors turns the angle by less than eps of itself, as rounding of its argument does.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from symgen.ir.interpret import round_literal
from symgen.ir.kernel import Block, Check, Kernel, Literal, Local, Operand, OperationName, Scalar, Statement
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.split import names_in, names_of_check

# A number times 2^s + 1, s half of the digits of a significand, is cut into two numbers of s digits.
SPLITTER: dict[Scalar, int] = {"float64": 2**27 + 1, "float32": 2**12 + 1}
ONE, TWO, HALF = Literal(Fraction(1)), Literal(Fraction(2)), Literal(Fraction(1, 2))
_Error: TypeAlias = Operand | None  # None: 0


def compensated(kernel: Kernel, scalar: Scalar, chosen: Collection[str]) -> Kernel:
    """The kernel that carries the rounding errors of the statements with `chosen` targets.

    The checks are those of the kernel, on the values that were rounded.
    """
    writer = _Writer(kernel, scalar, chosen)
    blocks = [replace(block, statements=writer.block(block.statements)) for block in kernel.blocks]
    last, outputs = writer.corrected(kernel.outputs)
    blocks[-1] = replace(blocks[-1], statements=(*blocks[-1].statements, *last))
    blocks_needed, own_pairs = _needed(blocks, outputs), frozenset(writer.turned)
    made = replace(kernel, blocks=blocks_needed, outputs=outputs, alike=(), own_pairs=own_pairs)
    same_kernel(f"carrying rounding errors of {kernel.name}", Lifted(kernel), Lifted(made), squares_roots=True)
    return made


def mark(kernel: Kernel, chosen: Collection[str]) -> str:
    """Targets of a kernel as a number with a bit for each in their order, the first one lowest; in hexadecimals."""
    return f"{sum(1 << place for place, target in enumerate(_in_order(kernel)) if target in chosen):x}"


def marked(kernel: Kernel, bits: str) -> frozenset[str]:
    """The targets of a `mark`."""
    number = int(bits, 16)
    return frozenset(target for place, target in enumerate(_in_order(kernel)) if number >> place & 1)


def _in_order(kernel: Kernel) -> list[str]:
    return [target for statement in kernel.statements for target in statement.targets]


class _Writer:
    """Statements one by one, each followed by those for its error."""

    def __init__(self, kernel: Kernel, scalar: Scalar, chosen: Collection[str]) -> None:
        self.scalar: Scalar = scalar
        self._chosen = frozenset(chosen)
        self._splitter = Literal(Fraction(SPLITTER[scalar]))
        self._statements: list[Statement] = []
        self._errors: dict[str, Operand] = {}
        self._halves: dict[Operand, tuple[Operand, Operand]] = {}
        self._taken = {load.local for load in kernel.loads} | _targets(kernel.blocks)
        self._count = 0
        self.turned: set[str] = set()

    def block(self, statements: Sequence[Statement]) -> tuple[Statement, ...]:
        """The statements, with those for their errors."""
        self._statements = []
        for statement in statements:
            self._statements.append(statement)
            if statement.operation == "sincos":
                self._pair(statement)
            else:
                self._one(statement)
        return tuple(self._statements)

    def corrected(self, outputs: Sequence[Operand]) -> tuple[tuple[Statement, ...], tuple[Operand, ...]]:
        """Statements that add their errors to the outputs, and what they are then."""
        self._statements = []
        found: dict[Operand, Operand] = {}
        for output in outputs:
            error = self._error(output)
            if output not in found:
                found[output] = output if error is None else self.emit("add", output, error)
        return tuple(self._statements), tuple(found[output] for output in outputs)

    def _one(self, statement: Statement) -> None:
        (target,) = statement.targets
        own = target in self._chosen
        errors = [self._error(operand) for operand in statement.operands]
        rule = _RULES.get(statement.operation)
        if rule is None or not (own or any(errors)):
            return  # min and max choose: their operands stay as they are
        error = rule(self, Local(target), statement.operands, errors, own)
        if error is not None:
            self._errors[target] = error

    def _pair(self, statement: Statement) -> None:
        """Along the radius onto the unit circle, and along the circle by the error of the angle."""
        sine, cosine = map(Local, statement.targets)
        turned = self._error(statement.operands[0])
        if turned is not None:
            self.turned |= names_in(statement.operands)
        inwards: _Error = None
        if not self._chosen.isdisjoint(statement.targets):
            squares = [self.emit("mul", x, x) for x in (sine, cosine)]
            left = [self.emit("sub", HALF, square) for square in squares]
            rests = [self.of_difference(x, HALF, square) for x, square in zip(left, squares, strict=True)]
            lost = [self.of_product(square, x, x) for x, square in zip((sine, cosine), squares, strict=True)]
            rest = self.emit("sub", self.emit("add", *rests), self.emit("add", *lost))
            inwards = self.emit("mul", HALF, self.emit("add", self.emit("add", *left), rest))
        along = self.sum(self.times(sine, inwards), self.times(cosine, turned))
        across = self.difference(self.times(cosine, inwards), self.times(sine, turned))
        for target, error in ((sine, along), (cosine, across)):
            if error is not None:
                self._errors[target.name] = error

    def _error(self, operand: Operand) -> _Error:
        return self._errors.get(operand.name) if isinstance(operand, Local) else None

    def emit(self, operation: OperationName, *operands: Operand) -> Operand:
        """The result of one more operation."""
        self._count += 1
        name = f"e{self._count}"
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        self._statements.append(Statement((name,), operation, operands))
        return Local(name)

    def sum(self, *errors: _Error) -> _Error:
        """Of those that are there."""
        total: _Error = None
        for error in errors:
            total = error if total is None else total if error is None else self.emit("add", total, error)
        return total

    def difference(self, a: _Error, b: _Error) -> _Error:
        """a - b."""
        if b is None:
            return a
        return self.emit("neg", b) if a is None else self.emit("sub", a, b)

    def times(self, x: Operand, error: _Error) -> _Error:
        """x e."""
        if error is None or x == ONE:
            return error
        return self.emit("mul", x, error)

    def of_sum(self, total: Operand, a: Operand, b: Operand) -> Operand:
        """What the rounded a + b lacks (Knuth)."""
        second = self.emit("sub", total, a)
        first = self.emit("sub", total, second)
        return self.emit("add", self.emit("sub", a, first), self.emit("sub", b, second))

    def of_difference(self, total: Operand, a: Operand, b: Operand) -> Operand:
        """What the rounded a - b lacks."""
        second = self.emit("sub", total, a)
        first = self.emit("sub", total, second)
        return self.emit("sub", self.emit("sub", a, first), self.emit("add", b, second))

    def of_product(self, product: Operand, a: Operand, b: Operand) -> Operand:
        """What the rounded a b lacks (Dekker)."""
        (a_high, a_low), (b_high, b_low) = self._cut(a), self._cut(b)
        rest = self.emit("sub", self.emit("mul", a_high, b_high), product)
        if a == b:
            rest = self.emit("add", rest, self.emit("mul", TWO, self.emit("mul", a_high, a_low)))
        else:
            rest = self.emit("add", rest, self.emit("mul", a_high, b_low))
            rest = self.emit("add", rest, self.emit("mul", a_low, b_high))
        return self.emit("add", rest, self.emit("mul", a_low, b_low))

    def _cut(self, x: Operand) -> tuple[Operand, Operand]:
        """Two numbers with half of the digits each, whose sum is x (Veltkamp), and a literal's as it was meant."""
        if x not in self._halves:
            if isinstance(x, Literal):
                self._halves[x] = _cut_number(x.value, self.scalar)
            else:
                scaled = self.emit("mul", self._splitter, x)
                high = self.emit("sub", scaled, self.emit("sub", scaled, x))
                self._halves[x] = high, self.emit("sub", x, high)
        return self._halves[x]


def _cut_number(value: Fraction, scalar: Scalar) -> tuple[Operand, Operand]:
    number = Fraction(round_literal(value, scalar))
    scaled = Fraction(round_literal(number * SPLITTER[scalar], scalar))
    high = Fraction(round_literal(scaled - Fraction(round_literal(scaled - number, scalar)), scalar))
    return Literal(high), Literal(value - high)


_Rule: TypeAlias = Callable[[_Writer, Operand, Sequence[Operand], Sequence[_Error], bool], _Error]


def _add(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:
    return w.sum(w.of_sum(v, *x) if own else None, *e)


def _sub(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:
    return w.difference(w.sum(w.of_difference(v, *x) if own else None, e[0]), e[1])


def _mul(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:
    exact = any(isinstance(factor, Literal) and _is_power_of_two(factor.value) for factor in x)
    lost = w.of_product(v, *x) if own and not exact else None
    return w.sum(lost, w.times(x[1], e[0]), w.times(x[0], e[1]))


def _quotient(operation: OperationName) -> _Rule:
    def rule(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:
        rest: _Error = None
        if own:
            # a - v b is a number of the type
            product = w.emit("mul", v, x[1])
            rest = w.emit("sub", w.emit("sub", x[0], product), w.of_product(product, v, x[1]))
        rest = w.difference(w.sum(rest, e[0]), w.times(v, e[1]))
        return None if rest is None else w.emit(operation, rest, x[1])

    return rule


def _neg(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:  # noqa: ARG001
    return w.difference(None, e[0])


def _sign(w: _Writer, x: Operand) -> Operand:
    return w.emit("copysign", ONE, x)


def _abs(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:  # noqa: ARG001
    return None if e[0] is None else w.times(_sign(w, x[0]), e[0])


def _copysign(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:  # noqa: ARG001
    return None if e[0] is None else w.times(_sign(w, x[1]), w.times(_sign(w, x[0]), e[0]))


def _sqrt(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:
    rest = e[0]
    if own:
        square = w.emit("mul", v, v)
        rest = w.sum(w.emit("sub", w.emit("sub", x[0], square), w.of_product(square, v, v)), rest)
    return None if rest is None else w.emit("ratio_or_zero", w.emit("mul", HALF, rest), v)


def _function(slope: Callable[[_Writer, Operand, Operand], Operand]) -> _Rule:
    """A function of the library: what it rounds itself stays."""

    def rule(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:  # noqa: ARG001
        return None if e[0] is None else w.times(slope(w, v, x[0]), e[0])

    return rule


def _one_and(w: _Writer, operation: OperationName, x: Operand) -> Operand:
    return w.emit(operation, ONE, w.emit("mul", x, x))


def _arc(w: _Writer, x: Operand) -> Operand:
    return w.emit("ratio_or_zero", ONE, w.emit("sqrt", _one_and(w, "sub", x)))


def _of_sinh(w: _Writer, v: Operand, x: Operand) -> Operand:  # noqa: ARG001
    return w.emit("sqrt", _one_and(w, "add", v))


def _atan2(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:  # noqa: ARG001
    turned = w.difference(w.times(x[1], e[0]), w.times(x[0], e[1]))
    square = w.emit("add", w.emit("mul", x[0], x[0]), w.emit("mul", x[1], x[1]))
    return None if turned is None else w.emit("ratio_or_zero", turned, square)


def _pow(w: _Writer, v: Operand, x: Sequence[Operand], e: Sequence[_Error], own: bool) -> _Error:  # noqa: ARG001
    return None if e[0] is None else w.emit("ratio_or_zero", w.emit("mul", x[1], w.emit("mul", v, e[0])), x[0])


_RULES: dict[OperationName, _Rule] = {
    "add": _add,
    "sub": _sub,
    "mul": _mul,
    "div": _quotient("div"),
    "ratio_or_zero": _quotient("ratio_or_zero"),
    "neg": _neg,
    "abs": _abs,
    "copysign": _copysign,
    "sqrt": _sqrt,
    "tan": _function(lambda w, v, _: _one_and(w, "add", v)),
    "asin": _function(lambda w, _, x: _arc(w, x)),
    "acos": _function(lambda w, _, x: w.emit("neg", _arc(w, x))),
    "atan": _function(lambda w, _, x: w.emit("div", ONE, _one_and(w, "add", x))),
    "exp": _function(lambda _w, v, _: v),
    "log": _function(lambda w, _, x: w.emit("div", ONE, x)),
    "sinh": _function(_of_sinh),
    "cosh": _function(lambda w, _, x: w.emit("sinh", x)),
    "tanh": _function(lambda w, v, _: _one_and(w, "sub", v)),
    "atan2": _atan2,
    "pow": _pow,
}


def _is_power_of_two(value: Fraction) -> bool:
    a, b = abs(value.numerator), value.denominator
    return a > 0 and a & (a - 1) == 0 and b & (b - 1) == 0


def _targets(blocks: Sequence[Block]) -> set[str]:
    """Every local that is assigned, where a check fails too."""
    found: set[str] = set()
    for block in blocks:
        found |= {target for statement in block.statements for target in statement.targets}
        found |= _targets([check.first for check in block.checks if check.first is not None])
    return found


def _needed(blocks: Sequence[Block], outputs: Sequence[Operand]) -> tuple[Block, ...]:
    """The blocks without statements of which nothing makes use."""
    used = names_in(outputs)
    kept: list[Block] = []
    for block in reversed(blocks):
        checks: Sequence[Check] = block.checks
        for check in checks:
            used |= names_of_check(check)
        statements: list[Statement] = []
        for statement in reversed(block.statements):
            if not used.isdisjoint(statement.targets):
                used |= names_in(statement.operands)
                statements.append(statement)
        kept.append(replace(block, statements=tuple(reversed(statements))))
    return tuple(reversed(kept))
