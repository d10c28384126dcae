"""Whether a kernel is the function that was meant, told apart from digits lost: evaluated in balls at exact states.

Numbers rounded to a scalar type lie beside V.  Where rows depend on each other, or the inputs reach fewer directions
on V than beside it, a quantity is defined on V alone, and two correct methods differ beside it; so there the states are
brought back onto V, exact parameters with them, before anything is compared.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from math import hypot
from typing import Any

from flint import arb

from symgen.ir.kernel import UNIT_ROUNDOFF, Kernel, Literal, Operand, Statement
from symgen.ir.pairs.wide_functions import is_wide, plain_operation
from symgen.model.model import Model
from symgen.model.quantities import MAIN
from symgen.verify.expected import Expected
from symgen.verify.given import entry, parts_of
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.configurations.closing import onto_manifold
from symgen.verify.reference.parameter_values import ParameterValues
from symgen.verify.reference.quantities import ITERATED
from symgen.verify.reference.reference import Reference, ReferenceValueError, State

# Binary digits that functions are compared in.
EXACT_BITS = 256
# What is left of the rows at states that are brought onto V for that.
ON_MANIFOLD = 2.0**-170
# What literals of 60 digits and points on V leave open, in radii of balls: a result may be a sum that cancels.
LEFT_OPEN = 2.0**110
# Of d / eps + |y*|, what the state makes of relative changes; more is left open where loops close up to rounding only.
SAME, SAME_ROUNDED = 2.0**-80, 2.0**-20
# The same, of what a stated number of steps leaves of friction of reactions: less than a rounding, with what that makes
# of a result.
LEFT_BY_STEPS = 2.0**-48
# What friction of reactions enters.
ROUGH = frozenset({*MAIN, "friction_residual"})
# States of a verification that are looked at, beside the worst.
EXACT_STATES = 8


class ExactStates:
    """States of a verification at which kernels are held against the reference, whose values there are kept."""

    def __init__(self, expected: Expected) -> None:
        self._expected = expected
        model = expected.reference.model
        self._varied = ParameterValues(model, [p.name for p in model.parameters if p.range is not None])
        self._states: dict[int, State | None] = {}
        self._values: dict[tuple[str, int], Any] = {}

    def difference(self, kernel: Kernel, worst: int = 0) -> str:
        """Where a kernel is another function than the reference, and by how much; empty where they are the same.

        Looked at are a few states, that of index `worst` among them.  Statuses are left out, and states that tell
        nothing: where the kernel divides by 0, or V is not reached.
        """
        if kernel.name in ITERATED:
            return ""
        expected = self._expected
        same = SAME_ROUNDED if expected.reference.ranks.rounded else SAME
        if kernel.name in ROUGH and steps_leave_something(expected.reference.model):
            same = max(same, LEFT_BY_STEPS)
        samples, values = expected.samples("float64"), expected.values("float64")
        with precision(EXACT_BITS):
            function = ExactFunction(kernel)
            for index in dict.fromkeys((worst, *range(0, len(samples), max(1, len(samples) // EXACT_STATES)))):
                distance = self._distance(function, kernel.name, index)
                unit, size = values[index][kernel.name].unit, values[index][kernel.name].size
                if distance > same * unit / float(UNIT_ROUNDOFF["float64"]):
                    return f"it differs from the reference by {distance:.3g} at state {index}, of {size:.3g}"
        return ""

    def _distance(self, function: ExactFunction, quantity: str, index: int) -> float:
        """The distance from the reference, 0 where that is no more than what literals and points on V leave open."""
        state, value = self._state(index), self._value(quantity, index)
        if state is None or value is None:
            return 0.0
        try:
            entries = function(state)
        except ZeroDivisionError:
            return 0.0
        apart = [entry - right for entry, right in zip(entries, value.entries(), strict=True)]
        distance, noise = hypot(*(float(x.mid()) for x in apart)), hypot(*(float(x.rad()) for x in apart))
        return distance if distance > noise * LEFT_OPEN else 0.0

    def _state(self, index: int) -> State | None:
        if index not in self._states:
            sample = self._expected.samples("float64")[index]
            self._states[index] = exact_state(self._expected.reference, sample.state, self._varied)
        return self._states[index]

    def _value(self, quantity: str, index: int) -> Any:
        """What the reference has there; None where it has nothing."""
        if (quantity, index) not in self._values:
            state, value = self._state(index), None
            if state is not None:
                with suppress(ReferenceValueError):
                    value = self._expected.reference.matrices(state, [quantity], EXACT_BITS)[quantity]
            self._values[quantity, index] = value
        return self._values[quantity, index]


def steps_leave_something(model: Model) -> bool:
    """Whether friction of reactions is worked out in steps, for a motion or for inputs."""
    both = [one for one in (model.friction_steps, model.motion_steps) if one is not None]
    return bool(model.rough) and not all(one.explicit for one in both)


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


class ExactFunction:
    """A kernel without its checks, in balls of the working precision; operands are found by place."""

    def __init__(self, kernel: Kernel) -> None:
        self._loads = kernel.loads
        self._places = {load.local: place for place, load in enumerate(kernel.loads)}
        self._count = len(kernel.loads)
        for statement in kernel.statements:
            for target in statement.targets:
                self._places[target] = self._count
                self._count += 1
        self._numbers: list[Any] = []
        self._steps = [self._step(statement) for statement in kernel.statements]
        self._outputs = [self._place(which) for which in kernel.outputs]

    def __call__(self, state: State) -> list[Any]:
        """The outputs at a state."""
        given = {name: list(map(ball, values)) for name, values in parts_of(state).items()}
        values: list[Any] = [entry(given, load) for load in self._loads]
        # numbers stand at the end, at negative places
        values += [None] * (self._count - len(values)) + self._numbers[::-1]
        for function, operands, targets in self._steps:
            result = function(*[values[place] for place in operands])
            if len(targets) == 1:
                values[targets[0]] = result
            else:
                values[targets[0]], values[targets[1]] = result
        return [values[place] for place in self._outputs]

    def _step(self, statement: Statement) -> tuple[Callable[..., Any], list[int], list[int]]:
        operands = [self._place(which) for which in statement.operands]
        targets = [self._places[target] for target in statement.targets]
        if is_wide(statement):
            return _of_pairs(EXACT[plain_operation(statement.operation)]), operands, targets
        return EXACT[statement.operation], operands, targets

    def _place(self, which: Operand) -> int:
        if not isinstance(which, Literal):
            return self._places[which.name]
        self._numbers.append(ball(which.value))
        return -len(self._numbers)


def _of_pairs(function: Callable[..., Any]) -> Callable[..., tuple[Any, Any]]:
    """A function of numbers that are pairs: of their sums, with nothing left for the second number of the result."""
    return lambda *parts: (function(*map(operator.add, parts[::2], parts[1::2])), arb(0))


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
    "sincos": arb.sin_cos,
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
