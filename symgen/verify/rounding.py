"""Where the digits of a kernel go: what rounding of each statement does to its result, in units of the tolerance."""

from __future__ import annotations

import random
from collections import defaultdict

from symgen.ir.adjoint import adjoints
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import UNIT_ROUNDOFF, Function, Kernel, Scalar
from symgen.verify.expected import Expected

# Units, a quarter of what is allowed: the root of the sum of squares of all shares that are left as they are.
LEFT = 4.0
# Combinations of outputs with random signs that stand for the norm of all.
COMBINATIONS = 4


def losing(kernel: Kernel, sincos: Function | None, scalar: Scalar, expected: Expected) -> frozenset[str]:
    """Targets of the statements that lose digits at the states of a verification.

    Those with the smallest shares are not among them, which give no more than `LEFT` together.
    """
    interpreter, generator = Interpreter(sincos, scalar), random.Random(0)
    eps = float(UNIT_ROUNDOFF[scalar])
    largest: defaultdict[str, float] = defaultdict(float)
    for sample, expectations in zip(expected.samples(scalar), expected.values(scalar), strict=True):
        state, unit = sample.state, expectations[kernel.name].unit
        if not unit:
            continue
        arguments = {part: tuple(map(float, getattr(state, part))) for part in ("q", "qd", "qdd", "u")}
        values = interpreter.values(kernel, arguments, tuple(map(float, state.parameters)))
        for _ in range(COMBINATIONS):
            slopes = adjoints(kernel, values, [generator.choice((-1.0, 1.0)) for _ in kernel.outputs])
            for statement in kernel.statements:
                for target in statement.targets:
                    share = abs(slopes.get(target, 0.0) * values[target]) * eps / unit
                    largest[target] = max(largest[target], share)
    total = 0.0
    by_share = sorted(largest, key=lambda target: largest[target])
    for place, target in enumerate(by_share):
        total += largest[target] ** 2
        if not total <= LEFT**2:
            return frozenset(by_share[place:])
    return frozenset()
