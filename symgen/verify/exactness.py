"""Whether a kernel is the function that was meant, told apart from digits lost: evaluated in balls at exact states.

Numbers rounded to a scalar type lie beside V.  Where rows depend on each other, or the inputs reach fewer directions
on V than beside it, a quantity is defined on V alone, and two correct forms differ beside it; so there the states are
brought back onto V, exact parameters with them, before anything is compared.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import replace
from math import hypot
from typing import Any

from flint import arb

from symgen.ir.kernel import UNIT_ROUNDOFF, Kernel, Literal, Operand
from symgen.ir.wide_functions import is_wide, plain_operation
from symgen.verify.expected import Expected
from symgen.verify.reference.closing import onto_manifold
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.reference.system import ParameterValues
from symgen.verify.reference.tape import ball, precision

EXACT_BITS = 256
ON_MANIFOLD = 2.0**-170
# What literals of 60 digits and points on V leave open, in radii of balls: a result may be a sum that cancels.
LEFT_OPEN = 2.0**110
# Of d / eps + |y*|, what the state makes of relative changes; more is left open where loops close up to rounding only.
SAME, SAME_ROUNDED = 2.0**-80, 2.0**-20
STATES = 8


def difference(kernel: Kernel, expected: Expected, worst: int = 0) -> str:
    """Where a kernel is another function than the reference, and by how much; empty where they are the same.

    Looked at are a few states, that of index `worst` among them.  Statuses are left out, and states that tell nothing:
    where the kernel divides by 0, or V is not reached.
    """
    reference = expected.reference
    varied = ParameterValues(reference.model, [p.name for p in reference.model.parameters if p.range is not None])
    same = SAME_ROUNDED if reference.ranks.rounded else SAME
    samples, values = expected.samples("float64"), expected.values("float64")
    with precision(EXACT_BITS):
        for index in dict.fromkeys((worst, *range(0, len(samples), max(1, len(samples) // STATES)))):
            state = exact_state(reference, samples[index].state, varied)
            distance = 0.0 if state is None else _distance(kernel, reference, state)
            unit, size = values[index][kernel.name].unit, values[index][kernel.name].size
            if distance > same * unit / float(UNIT_ROUNDOFF["float64"]):
                return f"it differs from the reference by {distance:.3g} at state {index}, of {size:.3g}"
    return ""


def exact_state(reference: Reference, state: State, varied: ParameterValues) -> State | None:
    """The state, on V where quantities are defined there alone; None where V is not reached from it.

    `varied` makes all parameters of those that have a range.
    """
    model, ranks = reference.model, reference.ranks
    if ranks.constraints == model.r and ranks.actuation == min(model.m, model.n - ranks.constraints):
        return state
    chosen = dict(zip((p.name for p in model.parameters), state.parameters, strict=True))
    parameters = varied({p.name: chosen[p.name] for p in model.parameters if p.range is not None})
    literals = reference.literals()
    q = onto_manifold(reference.system, state.q, parameters, literals, ON_MANIFOLD, ranks.rounded)
    return None if q is None else replace(state, q=tuple(q), parameters=tuple(parameters))


def _distance(kernel: Kernel, reference: Reference, state: State) -> float:
    """The distance from the reference, 0 where that is no more than what literals and points on V leave open."""
    try:
        value = reference.matrices(state, [kernel.name], EXACT_BITS)[kernel.name]
        entries = exact_outputs(kernel, state)
    except (ReferenceValueError, ZeroDivisionError):
        return 0.0
    apart = [entry - right for entry, right in zip(entries, value.entries(), strict=True)]
    distance, noise = hypot(*(float(x.mid()) for x in apart)), hypot(*(float(x.rad()) for x in apart))
    return distance if distance > noise * LEFT_OPEN else 0.0


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
        elif is_wide(statement):
            sums = map(operator.add, operands[::2], operands[1::2])
            values[statement.targets[0]] = EXACT[plain_operation(statement.operation)](*sums)
            values[statement.targets[1]] = arb(0)
        else:
            values[statement.targets[0]] = EXACT[statement.operation](*operands)
    return [operand(which) for which in kernel.outputs]


def _ratio_or_zero(a: Any, b: Any) -> Any:
    """a / b, and 0 for b = 0; what is either of two numbers by last digits, as x / x at x = 0, is all between them."""
    if b == 0:
        return arb(0)
    return arb(0.5, 0.5) if a is b and b.contains(0) else a / b


def _copysign(a: Any, b: Any) -> Any:
    """Raises ZeroDivisionError where a division by what may be 0 has left no sign."""
    if not b.is_finite():
        raise ZeroDivisionError
    return abs(a) if b >= 0 else -abs(a)


EXACT: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
    "abs": abs,
    "sqrt": arb.sqrt,
    "copysign": _copysign,
    "ratio_or_zero": _ratio_or_zero,
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
