"""Arithmetic with pairs of numbers, as straight lines of plain operations: the bodies of the operations `wide_*`.

A pair stands for the sum of a value and of a rest, which is at most half a unit in the last place of the value.  A sum
is off by a few eps^2 of its larger operand, everything else by a few eps^2 of the result (Dekker, A floating-point
technique for extending the available precision, Numer. Math. 18, 1971; Joldes, Muller and Popescu, Tight and rigorous
error bounds for basic building blocks of double-word arithmetic, ACM TOMS 44, 2017).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import lru_cache
from operator import attrgetter

from symgen.ir.kernel import Function, Kernel, Literal, Local, Operand, OperationName, Scalar, Statement

ONE, TWO, HALF = (Literal(Fraction(x)) for x in ("1", "2", "1/2"))
# A number times 2^s + 1, s half of the digits of a significand, is cut into two numbers of s digits.
SPLITTER: dict[Scalar, Literal] = {"float64": Literal(Fraction(2**27 + 1)), "float32": Literal(Fraction(2**12 + 1))}


class Lines:
    """Statements one after the other."""

    def __init__(self, name: Callable[[], str]) -> None:
        self._name = name
        self.statements: list[Statement] = []

    def emit(self, operation: OperationName, *operands: Operand) -> Local:
        """The result of one more operation."""
        target = self._name()
        self.statements.append(Statement((target,), operation, operands))
        return Local(target)


class _PairLines(Lines):
    def __init__(self, scalar: Scalar) -> None:
        names = (f"x{place}" for place in range(100))
        super().__init__(lambda: next(names))
        self._splitter = SPLITTER[scalar]

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
        a_high, a_low = self._cut(a)
        b_high, b_low = (a_high, a_low) if a == b else self._cut(b)
        rest = self.emit("sub", self.emit("mul", a_high, b_high), product)
        rest = self.emit("add", rest, self.emit("mul", a_high, b_low))
        rest = self.emit("add", rest, self.emit("mul", a_low, b_high))
        return self.emit("add", rest, self.emit("mul", a_low, b_low))

    def _cut(self, x: Operand) -> tuple[Operand, Operand]:
        """Two numbers with half of the digits each, whose sum is x (Veltkamp)."""
        scaled = self.emit("mul", self._splitter, x)
        high = self.emit("sub", scaled, self.emit("sub", scaled, x))
        return high, self.emit("sub", x, high)

    def pair(self, value: Operand, rest: Operand) -> tuple[str, str]:
        """Their sum as a pair; the value is the larger one (Dekker)."""
        total = self.emit("add", value, rest)
        return total.name, self.emit("sub", rest, self.emit("sub", total, value)).name


A, A_REST, B, B_REST = (Local(name) for name in ("a", "a_rest", "b", "b_rest"))


def _sum(w: _PairLines) -> tuple[Operand, Operand]:
    total = w.emit("add", A, B)
    return total, w.emit("add", w.of_sum(total, A, B), w.emit("add", A_REST, B_REST))


def _difference(w: _PairLines) -> tuple[Operand, Operand]:
    total = w.emit("sub", A, B)
    return total, w.emit("add", w.of_difference(total, A, B), w.emit("sub", A_REST, B_REST))


def _product(w: _PairLines) -> tuple[Operand, Operand]:
    product = w.emit("mul", A, B)
    across = w.emit("add", w.emit("mul", A, B_REST), w.emit("mul", A_REST, B))
    return product, w.emit("add", w.of_product(product, A, B), across)


def _quotient(division: OperationName) -> Callable[[_PairLines], tuple[Operand, Operand]]:
    def body(w: _PairLines) -> tuple[Operand, Operand]:
        quotient = w.emit(division, A, B)
        product = w.emit("mul", quotient, B)
        # a - q b is a number of the type
        left = w.emit("sub", w.emit("sub", A, product), w.of_product(product, quotient, B))
        left = w.emit("add", left, w.emit("sub", A_REST, w.emit("mul", quotient, B_REST)))
        return quotient, w.emit(division, left, B)

    return body


def _root(w: _PairLines) -> tuple[Operand, Operand]:
    root = w.emit("sqrt", A)
    square = w.emit("mul", root, root)
    left = w.emit("sub", w.emit("sub", A, square), w.of_product(square, root, root))
    return root, w.emit("ratio_or_zero", w.emit("add", left, A_REST), w.emit("mul", TWO, root))


_BODIES: dict[OperationName, Callable[[_PairLines], tuple[Operand, Operand]]] = {
    "wide_add": _sum,
    "wide_sub": _difference,
    "wide_mul": _product,
    "wide_div": _quotient("div"),
    "wide_ratio_or_zero": _quotient("ratio_or_zero"),
    "wide_sqrt": _root,
}
# By the operation that each does on pairs.
WIDE: dict[OperationName, OperationName] = {
    "add": "wide_add",
    "sub": "wide_sub",
    "mul": "wide_mul",
    "div": "wide_div",
    "ratio_or_zero": "wide_ratio_or_zero",
    "sqrt": "wide_sqrt",
}

_PLAIN: dict[OperationName, OperationName] = {wide: plain for plain, wide in WIDE.items()}


@lru_cache
def wide_function(operation: OperationName, scalar: Scalar = "float64") -> Function:
    """(value, rest) = operation(a, a_rest, b, b_rest)."""
    body = _PairLines(scalar)
    results = body.pair(*_BODIES[operation](body))
    parameters = ("a", "a_rest") if operation == "wide_sqrt" else ("a", "a_rest", "b", "b_rest")
    return Function(operation, parameters, tuple(body.statements), results)


def is_wide_operation(operation: OperationName) -> bool:
    """Whether an operation takes pairs of numbers."""
    return operation in _BODIES


def is_wide(statement: Statement) -> bool:
    """Whether a statement takes pairs of numbers."""
    return statement.operation in _BODIES


_operation = attrgetter("operation")


def works_with_pairs(kernel: Kernel) -> bool:
    """Whether a kernel works with twice the digits."""
    # asked again and again, of thousands of statements: without a line of Python for each of them
    return not all(_BODIES.keys().isdisjoint(map(_operation, block.statements)) for block in kernel.blocks)


def wide_operations(statements: Iterable[Statement]) -> tuple[OperationName, ...]:
    """The operations on pairs among statements, in a fixed order."""
    used = {statement.operation for statement in statements}
    return tuple(operation for operation in _BODIES if operation in used)


def plain_operation(operation: OperationName) -> OperationName:
    """What an operation on pairs does to their sums, in exact arithmetic; the rest of the result is 0 there."""
    return _PLAIN[operation]


def with_bodies(statements: Iterable[Statement]) -> Iterator[Statement]:
    """The statements, and those that operations on pairs among them consist of, once each."""
    kept = tuple(statements)
    yield from (statement for statement in kept if not is_wide(statement))
    for operation in wide_operations(kept):
        yield from wide_function(operation).statements
