"""Gradients of recorded results backwards through the tape: of few results by many inputs this takes least.

Taylor polynomials carry a coefficient for each coordinate through every operation, so that the rows of a loop of n
links take n^2 operations; backwards each row takes a few times what its value takes.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.verify.reference.arithmetic.tape import Register, Tape, needed_for, operands

# Operations backwards for one of the value, at most about.
BACKWARDS = 4


def shorter_gradients(
    tape: Tape, results: Sequence[Register], known: Sequence[Register], count: int
) -> list[list[Register]] | None:
    """The gradients of results by the first `count` inputs; None where those that are `known` take less."""
    values = sum(len(needed_for(tape, [result])) for result in results)
    if (1 + BACKWARDS) * values >= len(needed_for(tape, known)):
        return None
    return [gradient(tape, result, range(count)) for result in results]


def gradient(tape: Tape, result: Register, inputs: range) -> list[Register]:
    """The derivatives of one result by these inputs."""
    slopes: dict[Register, Register] = {result: tape.one}
    derivatives = [tape.zero] * len(inputs)
    cone = sorted(needed_for(tape, [result]))
    moving: set[Register] = set()
    for register in cone:
        operation, left, _ = tape.records[register]
        if left in inputs if operation == "input" else not moving.isdisjoint(operands(tape.records[register])):
            moving.add(register)
    for register in reversed(cone):
        slope = slopes.get(register, tape.zero)
        operation, left, _ = tape.records[register]
        if slope == tape.zero or register not in moving:
            continue
        if operation == "input":
            derivatives[left - inputs.start] = slope
            continue
        for operand, change in _changes(tape, register):
            if operand not in moving:
                continue
            share = tape.binary("mul", slope, change)
            before = slopes.get(operand)
            slopes[operand] = share if before is None else tape.binary("add", before, share)
    return derivatives


def _changes(tape: Tape, register: Register) -> list[tuple[Register, Register]]:
    """The operands of an operation, each with the derivative by it."""
    operation = tape.records[register][0]
    a, *others = operands(tape.records[register])
    b = others[0] if others else tape.zero
    one, minus = tape.one, tape.constant(Fraction(-1))

    def div(x: Register, y: Register) -> Register:
        return tape.binary("div", x, y)

    def mul(x: Register, y: Register) -> Register:
        return tape.binary("mul", x, y)

    def neg(x: Register) -> Register:
        return tape.unary("neg", x)

    def one_and(x: Register, sign: str = "add") -> Register:
        return tape.binary(sign, one, mul(x, x))

    match operation:
        case "add":
            return [(a, one), (b, one)]
        case "sub":
            return [(a, one), (b, minus)]
        case "mul":
            return [(a, b), (b, a)]
        case "div":
            return [(a, div(one, b)), (b, neg(div(register, b)))]
        case "neg":
            return [(a, minus)]
        case "pow":  # exponents are constants
            return [(a, div(mul(b, register), a))]
        case "atan2":
            square = tape.binary("add", mul(a, a), mul(b, b))
            return [(a, div(b, square)), (b, neg(div(a, square)))]
        case "sin":
            return [(a, tape.unary("cos", a))]
        case "cos":
            return [(a, neg(tape.unary("sin", a)))]
        case "tan":
            return [(a, one_and(register))]
        case "asin":
            return [(a, div(one, tape.unary("sqrt", one_and(a, "sub"))))]
        case "acos":
            return [(a, neg(div(one, tape.unary("sqrt", one_and(a, "sub")))))]
        case "atan":
            return [(a, div(one, one_and(a)))]
        case "sqrt":
            return [(a, div(tape.constant(Fraction(1, 2)), register))]
        case "exp":
            return [(a, register)]
        case "log":
            return [(a, div(one, a))]
        case "sinh":
            return [(a, tape.unary("cosh", a))]
        case "cosh":
            return [(a, tape.unary("sinh", a))]
        case "tanh":
            return [(a, one_and(register, "sub"))]
    raise SymgenBug(f"reference: no derivative of {operation} backwards")
