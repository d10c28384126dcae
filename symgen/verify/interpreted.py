"""A kernel held against what is expected before any file is made of it: no compiler, the bits of C and Python."""

from __future__ import annotations

import math

from symgen.activity import each
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Function, Kernel, Scalar
from symgen.verify.certificate import ErrorRecord, Fault
from symgen.verify.comparison import compare, faults_of
from symgen.verify.compile import Outcome
from symgen.verify.expected import Expected
from symgen.verify.reference import State


def measured(
    kernel: Kernel, sincos: Function | None, scalar: Scalar, expected: Expected
) -> tuple[ErrorRecord, Fault | None]:
    """The errors of a kernel at the states of a verification in units of d + eps |y*|, and what is wrong."""
    interpreter = Interpreter(sincos, scalar)
    samples, values = expected.samples(scalar), expected.values(scalar)
    outcomes = [outcome(interpreter, kernel, sample.state) for sample in each(f"trying it in {scalar}", samples)]
    record = compare(kernel.name, scalar, [value[kernel.name] for value in values], outcomes)
    return record, next(faults_of(record, outcomes, samples), None)


def outcome(interpreter: Interpreter, kernel: Kernel, state: State) -> Outcome:
    """What a kernel gives at a state of its scalar type: NaN where it refuses."""
    arguments = {part: tuple(map(float, getattr(state, part))) for part in ("q", "qd", "qdd", "u")}
    status, entries = interpreter.run(kernel, arguments, tuple(map(float, state.parameters)))
    return Outcome(int(status), tuple(entries) or (math.nan,) * max(1, math.prod(kernel.shape)))
