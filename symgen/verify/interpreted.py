"""A kernel held against what is expected before any file is made of it: no compiler, the bits of C and Python."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

from flint import arb, arb_mat

from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Function, Kernel, Literal, Operand, Scalar
from symgen.verify.certificate import Fault
from symgen.verify.comparison import compare, faults_of
from symgen.verify.compile import Outcome
from symgen.verify.expected import Expected
from symgen.verify.reference import State
from symgen.verify.reference_linear import norm
from symgen.verify.reference_tape import ball, precision
from symgen.verify.tolerance import FACTOR

EXACT_BITS = 256


def measured(
    kernel: Kernel, sincos: Function | None, scalar: Scalar, expected: Expected
) -> tuple[float, Fault | None]:
    """The largest error of a kernel at the states of a verification in units of d + eps |y*|, and what is wrong."""
    interpreter = Interpreter(sincos, scalar)
    samples, values = expected.samples(scalar), expected.values(scalar)
    outcomes = [_outcome(interpreter, kernel, sample.state) for sample in samples]
    record = compare(kernel.name, scalar, [value[kernel.name] for value in values], outcomes)
    return record.largest, next(faults_of(record, outcomes, samples), None)


def wrong_exactly(kernel: Kernel, expected: Expected) -> bool:
    """Whether a kernel is beyond the tolerance in exact arithmetic too: then it computes something else.

    Statuses are left out, and states where it divides by 0.
    """
    with precision(EXACT_BITS):
        for sample, values in zip(expected.samples("float64"), expected.values("float64"), strict=True):
            try:
                entries = exact_outputs(kernel, sample.state)
            except ZeroDivisionError:
                continue
            value = values[kernel.name]
            distance = norm(arb_mat(value.value.nrows(), value.value.ncols(), entries) - value.value)
            if value.in_units(distance) > FACTOR:
                return True
    return False


def exact_outputs(kernel: Kernel, state: State) -> list[Any]:
    """The outputs in balls of the working precision; checks are left out."""
    values: dict[str, Any] = {}

    def operand(which: Operand) -> Any:
        return ball(which.value) if isinstance(which, Literal) else values[which.name]

    for load in kernel.loads:
        values[load.local] = ball(getattr(state, "parameters" if load.argument == "p" else load.argument)[load.index])
    for statement in kernel.statements:
        operands = [operand(which) for which in statement.operands]
        if statement.operation == "sincos":
            values.update(zip(statement.targets, operands[0].sin_cos(), strict=True))
        else:
            values[statement.targets[0]] = EXACT[statement.operation](*operands)
    return [operand(which) for which in kernel.outputs]


EXACT: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "abs": abs,
    "sqrt": arb.sqrt,
    "copysign": lambda a, b: abs(a) if b >= 0 else -abs(a),
    "ratio_or_zero": lambda a, b: arb(0) if b == 0 else a / b,
    "min": lambda a, b: a if a < b else b,
    "max": lambda a, b: a if a > b else b,
    "tan": arb.tan,
    "asin": arb.asin,
    "acos": arb.acos,
    "atan": arb.atan,
    "atan2": arb.atan2,
    "exp": arb.exp,
    "log": arb.log,
    "sinh": arb.sinh,
    "cosh": arb.cosh,
    "tanh": arb.tanh,
    "pow": operator.pow,
}


def _outcome(interpreter: Interpreter, kernel: Kernel, state: State) -> Outcome:
    arguments = {part: tuple(map(float, getattr(state, part))) for part in ("q", "qd", "qdd", "u")}
    status, entries = interpreter.run(kernel, arguments, tuple(map(float, state.parameters)))
    return Outcome(int(status), tuple(entries) or (math.nan,) * max(1, math.prod(kernel.shape)))
