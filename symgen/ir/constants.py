"""What depends on no input is a number: worked out once, to more digits than any scalar type holds.

A fixed turn of a frame such as sin(0.5) would else be computed at every call, with the errors of the portable pair.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import isqrt

from symgen.ir.kernel import Block, Check, Kernel, Literal, Local, Operand, Statement, Status
from symgen.ir.split import pruned
from symgen.symbolic.scalar import PI

# Numbers are kept to this many bits; PI is given to 235.
CONSTANT_BITS = 220
_EXACT = {"add": Fraction.__add__, "sub": Fraction.__sub__, "mul": Fraction.__mul__}


def with_constants_evaluated(kernel: Kernel) -> Kernel:
    """The kernel without statements whose operands are numbers: their values stand where they were read."""
    known: dict[str, Literal] = {}
    blocks = tuple(_block(block, known) for block in kernel.blocks)
    return replace(kernel, blocks=blocks, outputs=_read(kernel.outputs, known))


def with_numbers(kernel: Kernel, known: Mapping[str, Literal]) -> Kernel:
    """The kernel with numbers in place of locals, and without what assigns these."""
    if not known:
        return kernel

    def checked(check: Check) -> Check:
        value, limit = _read((check.value, check.limit), known)
        return replace(check, value=value, limit=limit, first=None if check.first is None else rewritten(check.first))

    def rewritten(block: Block) -> Block:
        statements = (replace(one, operands=_read(one.operands, known)) for one in block.statements)
        return Block(tuple(statements), tuple(map(checked, block.checks)))

    blocks = tuple(map(rewritten, kernel.blocks))
    return pruned(replace(kernel, blocks=blocks, outputs=_read(kernel.outputs, known)))


def _block(block: Block, known: dict[str, Literal]) -> Block:
    statements = []
    for statement in block.statements:
        operands = _read(statement.operands, known)
        values = _values(statement, operands)
        if values is None:
            statements.append(replace(statement, operands=operands))
        else:
            known |= zip(statement.targets, map(Literal, values), strict=True)
    checks = (_check(check, known) for check in block.checks)
    return Block(tuple(statements), tuple(check for check in checks if check is not None))


def _check(check: Check, known: dict[str, Literal]) -> Check | None:
    """The check, its cause evaluated too; None where it holds the angle of a pair that is known in its range."""
    size = check.limit
    if check.status is Status.ANGLE_RANGE and isinstance(size, Local) and size.name in known:
        return None
    value, limit = _read((check.value, check.limit), known)
    first = None if check.first is None else _block(check.first, dict(known))
    return replace(check, value=value, limit=limit, first=first)


def _read(operands: Sequence[Operand], known: Mapping[str, Literal]) -> tuple[Operand, ...]:
    return tuple(known.get(o.name, o) if isinstance(o, Local) else o for o in operands)


def _values(statement: Statement, operands: Sequence[Operand]) -> tuple[Fraction, ...] | None:
    """The numbers a statement assigns; None where an operand is none, or where the operation is another function."""
    args = [operand.value for operand in operands if isinstance(operand, Literal)]
    if len(args) < len(operands):
        return None
    operation, first = statement.operation, args[0]
    if operation in _EXACT:
        return (_rounded(_EXACT[operation](*args)),)
    if operation == "div" and args[1]:
        return (_rounded(first / args[1]),)
    if operation == "neg":
        return (-first,)
    if operation == "abs":
        return (abs(first),)
    if operation == "sqrt" and first >= 0:
        return (square_root(first),)
    if operation == "sincos":
        return sine_and_cosine(first)
    return None


def square_root(value: Fraction) -> Fraction:
    """The root of what is not negative, to a relative 2^-CONSTANT_BITS."""
    shift = max(0, CONSTANT_BITS + value.denominator.bit_length() - value.numerator.bit_length() // 2)
    return Fraction(isqrt((value.numerator << 2 * shift) // value.denominator), 1 << shift)


def sine_and_cosine(angle: Fraction) -> tuple[Fraction, Fraction]:
    """Both to 2^-CONSTANT_BITS plus |angle| 2^-232, by Taylor's series of what is left beside quarter turns."""
    quarters = round(angle / (PI / 2))
    one = 1 << CONSTANT_BITS + 20
    rest = angle - quarters * PI / 2
    scaled = rest.numerator * one // rest.denominator
    sums, term, degree = [0, 0], one, 0
    while term:
        sums[degree % 2] += term if degree % 4 < 2 else -term
        degree += 1
        term = term * scaled // (one * degree)
        if term == -1:
            term = 0  # floors of what is negative do not end at 0
    cosine, sine = (Fraction(total, one) for total in sums)
    for _ in range(quarters % 4):
        sine, cosine = cosine, -sine
    return sine, cosine


def _rounded(value: Fraction) -> Fraction:
    """To CONSTANT_BITS significant bits, so that numbers do not grow from one operation to the next."""
    shift = CONSTANT_BITS + value.denominator.bit_length() - value.numerator.bit_length()
    if shift <= 0 or value.denominator.bit_length() <= shift:
        return value
    return Fraction((value.numerator << shift) // value.denominator, 1 << shift)
