"""Kernels that work with twice the digits: every value is a pair of numbers of the type (`ir/pairs/wide_functions.py`).

Beside the result v of a statement stands a rest, so that results are off by a few eps^2 of what is added up on the way.
What is left is what rounding of the inputs does.  Sines and cosines are brought back to the unit circle: 1 - s^2 - c^2
follows from s and c alone.  What is left of their errors turns the angle by less than eps of itself, as rounding of its
argument does; those of a sum of angles are made of those of its parts (`ir/pairs/wide_angles.py`), numbers among them
with all their digits.  What functions of the library round themselves stays.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from symgen.ir.constants import sine_and_cosine, with_numbers
from symgen.ir.interpret import round_literal
from symgen.ir.kernel import Block, Kernel, Literal, Local, Operand, OperationName, Scalar, Statement
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.pairs.wide_angles import AngleSum, sums_of_shared_angles, with_ranges
from symgen.ir.pairs.wide_functions import HALF, ONE, WIDE, Lines
from symgen.ir.split import pruned

ZERO = Literal(Fraction(0))
# Binary digits that a pair of numbers in float32 has more than one.
GAINED = 22
_Pair: TypeAlias = tuple[Operand, Operand]


def widened(kernel: Kernel, scalar: Scalar) -> Kernel:
    """The kernel with pairs of numbers in place of numbers; its checks are those of the values."""
    made, numbers = _paired(kernel, scalar)
    same_kernel(f"twice the digits in {kernel.name}", Lifted(kernel), Lifted(made), squares_roots=True)
    return with_numbers(made, numbers)


def paired(kernel: Kernel, scalar: Scalar) -> Kernel:
    """The same, unproved: to measure with, not to generate."""
    return with_numbers(*_paired(kernel, scalar))


def _paired(kernel: Kernel, scalar: Scalar) -> tuple[Kernel, dict[str, Literal]]:
    """With pairs, and what sines and cosines of numbers are in it."""
    writer = _PairWriter(kernel, scalar)
    blocks = [replace(block, statements=writer.block(block.statements)) for block in kernel.blocks]
    last, outputs = writer.rounded(kernel.outputs)
    blocks[-1] = replace(blocks[-1], statements=(*blocks[-1].statements, *last))
    blocks = with_ranges(blocks, writer.further_angles, writer.taken)
    return pruned(replace(kernel, blocks=tuple(blocks), outputs=outputs)), writer.numbers


class _PairWriter:
    """Statements one by one, each on pairs."""

    def __init__(self, kernel: Kernel, scalar: Scalar) -> None:
        self._scalar: Scalar = scalar
        self.taken = {load.local for load in kernel.loads} | _targets(kernel.blocks)
        self._count = 0
        self._rests: dict[str, Operand] = {}
        self._sums = sums_of_shared_angles(kernel)
        sines = (one for one in kernel.statements if one.operation == "sincos")
        self._own_sines = {one.operands[0]: one for one in sines}
        self._turned: dict[AngleSum, tuple[_Pair, _Pair]] = {}
        self._written: set[str] = set()
        self.further_angles: list[str] = []
        self.numbers: dict[str, Literal] = {}
        self._lines = Lines(self._name)

    def block(self, statements: Sequence[Statement]) -> tuple[Statement, ...]:
        """The statements on pairs."""
        self._lines = Lines(self._name)
        for statement in statements:
            if statement.operation == "sincos":
                self._sines(statement)
            elif statement.operation in WIDE:
                self._wide(statement)
            else:
                self._lines.statements.append(statement)
                self._keep(statement.targets[0], _RULES[statement.operation](self, statement))
        return tuple(self._lines.statements)

    def rounded(self, outputs: Sequence[Operand]) -> tuple[tuple[Statement, ...], tuple[Operand, ...]]:
        """Statements that round outputs to numbers of the type, and what they are then."""
        self._lines = Lines(self._name)
        by_output = {output: self._rounded(output) for output in dict.fromkeys(outputs)}
        return tuple(self._lines.statements), tuple(by_output[output] for output in outputs)

    def _rounded(self, output: Operand) -> Operand:
        if isinstance(output, Literal) or self.rest(output) == ZERO:
            return output
        return self.emit("add", output, self.rest(output))

    def rest(self, x: Operand) -> Operand:
        """What x lacks: 0 for what is loaded, and for literals that stand for themselves."""
        return self._rests.get(x.name, ZERO) if isinstance(x, Local) else ZERO

    def emit(self, operation: OperationName, *operands: Operand) -> Operand:
        """The result of one more plain operation."""
        return self._lines.emit(operation, *operands)

    def wide(self, operation: OperationName, *operands: _Pair) -> _Pair:
        """The result of one more operation on pairs."""
        value, rest = self._name(), self._name()
        self._lines.statements.append(Statement((value, rest), operation, tuple(x for pair in operands for x in pair)))
        return Local(value), Local(rest)

    def _wide(self, statement: Statement) -> None:
        """A sum, product, quotient or root; multiples by powers of two are exact."""
        (target,), operands = statement.targets, statement.operands
        is_product = statement.operation == "mul"
        factors = [x for x in operands if is_product and isinstance(x, Literal) and x.is_power_of_two]
        if factors:
            self._lines.statements.append(statement)
            other = operands[0] if factors[0] is operands[1] else operands[1]
            self._keep(target, self.times(factors[0], self.rest(other)))
            return
        pairs = [self._pair(x, exact=statement.operation in ("add", "sub")) for x in operands]
        rest = self._name()
        given = tuple(x for pair in pairs for x in pair)
        self._lines.statements.append(Statement((target, rest), WIDE[statement.operation], given))
        self._rests[target] = Local(rest)

    def _pair(self, x: Operand, exact: bool) -> _Pair:
        """A literal that is rounded is a pair in exact arithmetic only where it is brought into the form of one."""
        if isinstance(x, Local):
            return x, self.rest(x)
        value = Literal(Fraction(round_literal(x.value, self._scalar)))
        rest = Literal(x.value - value.value)
        return (value, rest) if exact or rest == ZERO else self.wide("wide_add", (value, rest), (ZERO, ZERO))

    def _sines(self, statement: Statement) -> None:
        """Of a sum of angles by those of its parts, where others are made of them too."""
        (angle,) = statement.operands
        if isinstance(angle, Local) and angle.name in self._sums:
            self._turn(self._sums[angle.name], statement.targets)
        elif statement.targets[0] not in self._written:
            self._on_circle(statement)

    def _turn(self, turn: AngleSum, targets: tuple[str, ...] = ()) -> tuple[_Pair, _Pair]:
        """Sine and cosine of a sum of angles, by the addition theorem from those of all but one."""
        if turn in self._turned and not targets:
            return self._turned[turn]
        if turn.count == 1:
            ((part, direction),) = turn.parts
            sine, cosine = self._sines_of(part)
            if direction < 0:
                sine = self.emit("neg", sine[0]), self.emit("neg", sine[1])
            self._turned[turn] = sine, cosine
            return sine, cosine
        parts = [part for part, _ in turn.parts]
        last = next((part for part in parts if turn.without(part) in self._turned), parts[-1])
        (sine, cosine), (s, c) = self._turn(turn.without(last)), self._sines_of(last)
        kinds: tuple[OperationName, OperationName] = ("wide_add", "wide_sub")
        add, sub = kinds if turn.direction(last) > 0 else kinds[::-1]
        first, second = targets or (self._name(), self._name())
        made = self._product(first, add, (sine, c), (cosine, s)), self._product(second, sub, (cosine, c), (sine, s))
        self._turned[turn] = made
        return made

    def _product(
        self, target: str, operation: OperationName, left: tuple[_Pair, _Pair], right: tuple[_Pair, _Pair]
    ) -> _Pair:
        """A sum or difference of two products."""
        products = self.wide("wide_mul", *left), self.wide("wide_mul", *right)
        rest = self._name()
        given = tuple(x for pair in products for x in pair)
        self._lines.statements.append(Statement((target, rest), operation, given))
        self._rests[target] = Local(rest)
        return Local(target), Local(rest)

    def _sines_of(self, angle: Operand) -> tuple[_Pair, _Pair]:
        """Those of a loaded angle or a literal; where the kernel has none of it, or only later on, they come first."""
        own = self._own_sines.get(angle)
        if own is None:
            rounded, rest = self._pair(angle, exact=False)
            if isinstance(rounded, Local):
                self._keep(rounded.name, rest)
            own = self._own_sines[angle] = Statement((self._name(), self._name()), "sincos", (rounded,))
            if isinstance(angle, Local):
                self.further_angles.append(angle.name)
        if own.targets[0] not in self._written:
            self._on_circle(own)
            if isinstance(angle, Literal):
                self._known(own.targets, sine_and_cosine(angle.value))
        sine, cosine = map(Local, own.targets)
        return (sine, self.rest(sine)), (cosine, self.rest(cosine))

    def _on_circle(self, statement: Statement) -> None:
        """Along the radius onto the unit circle, and along the circle by the rest of the angle."""
        self._written.add(statement.targets[0])
        self._lines.statements.append(statement)
        turned = self.rest(statement.operands[0])
        sine, cosine = map(Local, statement.targets)
        squares = [self.wide("wide_mul", (x, ZERO), (x, ZERO)) for x in (sine, cosine)]
        size, rest = self.wide("wide_sub", self.wide("wide_sub", (ONE, ZERO), squares[0]), squares[1])
        inwards = self.emit("mul", HALF, self.emit("add", size, rest))
        for own, other, turn in ((sine, cosine, "add"), (cosine, sine, "sub")):
            lacking = self.emit("mul", own, inwards)
            along = self.times(other, turned)
            if along != ZERO:
                lacking = self.emit("add" if turn == "add" else "sub", lacking, along)
            self._rests[own.name] = lacking

    def _known(self, targets: Sequence[str], values: Sequence[Fraction]) -> None:
        """Values and rests of what is a number: as many digits as `ir/constants.py` gives others of the same angle."""
        for target, value in zip(targets, values, strict=True):
            rounded = Literal(Fraction(round_literal(value, self._scalar)))
            self.numbers[target] = rounded
            rest = self._rests[target]
            assert isinstance(rest, Local)
            self.numbers[rest.name] = Literal(value - rounded.value)

    def times(self, x: Operand, rest: Operand) -> Operand:
        """x e."""
        if rest == ZERO or x == ONE:
            return rest
        return self.emit("mul", x, rest)

    def _keep(self, target: str, rest: Operand) -> None:
        if rest != ZERO:
            self._rests[target] = rest

    def _name(self) -> str:
        self._count += 1
        name = f"w{self._count}"
        while name in self.taken:
            name += "_"
        self.taken.add(name)
        return name


_Rule: TypeAlias = Callable[[_PairWriter, Statement], Operand]


def _neg(w: _PairWriter, s: Statement) -> Operand:
    rest = w.rest(s.operands[0])
    return rest if rest == ZERO else w.emit("neg", rest)


def _sign(w: _PairWriter, x: Operand) -> Operand:
    return w.emit("copysign", ONE, x)


def _abs(w: _PairWriter, s: Statement) -> Operand:
    rest = w.rest(s.operands[0])
    return rest if rest == ZERO else w.times(_sign(w, s.operands[0]), rest)


def _copysign(w: _PairWriter, s: Statement) -> Operand:
    size, sign = s.operands
    rest = w.rest(size)
    return rest if rest == ZERO else w.times(_sign(w, sign), w.times(_sign(w, size), rest))


def _choice(w: _PairWriter, s: Statement) -> Operand:
    """The rest of what is chosen: of the second one where the first is something else."""
    first, second = map(w.rest, s.operands)
    if first == second:
        return first
    apart = w.emit("sub", s.operands[0], Local(s.targets[0]))
    other = w.emit("ratio_or_zero", apart, apart)
    return w.emit("add", first, w.emit("mul", other, w.emit("sub", second, first)))


def _function(slope: Callable[[_PairWriter, Operand, Operand], Operand]) -> _Rule:
    """A function of the library."""

    def rule(w: _PairWriter, s: Statement) -> Operand:
        rest = w.rest(s.operands[0])
        return rest if rest == ZERO else w.times(slope(w, Local(s.targets[0]), s.operands[0]), rest)

    return rule


def _one_and(w: _PairWriter, operation: OperationName, x: Operand) -> Operand:
    return w.emit(operation, ONE, w.emit("mul", x, x))


def _arc(w: _PairWriter, x: Operand) -> Operand:
    return w.emit("ratio_or_zero", ONE, w.emit("sqrt", _one_and(w, "sub", x)))


def _atan2(w: _PairWriter, s: Statement) -> Operand:
    y, x = s.operands
    if w.rest(y) == ZERO and w.rest(x) == ZERO:
        return ZERO
    turned = w.emit("sub", w.emit("mul", x, w.rest(y)), w.emit("mul", y, w.rest(x)))
    return w.emit("ratio_or_zero", turned, w.emit("add", w.emit("mul", x, x), w.emit("mul", y, y)))


def _pow(w: _PairWriter, s: Statement) -> Operand:
    base, exponent = s.operands
    rest = w.rest(base)
    if rest == ZERO:
        return rest
    return w.emit("ratio_or_zero", w.emit("mul", exponent, w.emit("mul", Local(s.targets[0]), rest)), base)


_RULES: dict[OperationName, _Rule] = {
    "neg": _neg,
    "abs": _abs,
    "copysign": _copysign,
    "min": _choice,
    "max": _choice,
    "tan": _function(lambda w, v, _: _one_and(w, "add", v)),
    "asin": _function(lambda w, _, x: _arc(w, x)),
    "acos": _function(lambda w, _, x: w.emit("neg", _arc(w, x))),
    "atan": _function(lambda w, _, x: w.emit("div", ONE, _one_and(w, "add", x))),
    "exp": _function(lambda _w, v, _: v),
    "log": _function(lambda w, _, x: w.emit("div", ONE, x)),
    "sinh": _function(lambda w, v, _: w.emit("sqrt", _one_and(w, "add", v))),
    "cosh": _function(lambda w, _, x: w.emit("sinh", x)),
    "tanh": _function(lambda w, v, _: _one_and(w, "sub", v)),
    "atan2": _atan2,
    "pow": _pow,
}


def _targets(blocks: Sequence[Block]) -> set[str]:
    """Every local that is assigned, where a check fails too."""
    targets: set[str] = set()
    for block in blocks:
        targets |= {target for statement in block.statements for target in statement.targets}
        targets |= _targets([check.first for check in block.checks if check.first is not None])
    return targets
