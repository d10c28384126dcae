"""Where the digits of a kernel go: what rounding of each statement does to its result, in units of the tolerance."""

from __future__ import annotations

import math
import random
from collections import defaultdict
from collections.abc import Iterable

from symgen.ir.adjoint import adjoints
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import UNIT_ROUNDOFF, Function, Kernel, Literal, Scalar
from symgen.verify.expected import Expected
from symgen.verify.states import Sample
from symgen.verify.tolerance import Expectation

# Units, a quarter of what is allowed: the root of the sum of squares of all shares that are left as they are.
LEFT = 4.0
# States looked at, those with the largest errors, and combinations of outputs with random signs, which stand for all.
STATES = 16
COMBINATIONS = 2


def losing(
    kernel: Kernel,
    sincos: Function | None,
    scalar: Scalar,
    expected: Expected,
    searched: Iterable[tuple[Sample, Expectation]] = (),
) -> frozenset[str]:
    """Targets of the statements that lose digits at the states of a verification, and at those that were searched for.

    Those with the smallest shares are not among them, which give no more than `LEFT` together.
    """
    generator = random.Random(0)
    eps = float(UNIT_ROUNDOFF[scalar])
    largest: defaultdict[str, float] = defaultdict(float)
    drawn = zip(expected.samples(scalar), (one[kernel.name] for one in expected.values(scalar)), strict=True)
    for unit, values in _worst(kernel, Interpreter(sincos, scalar), (*drawn, *searched)):
        for _ in range(COMBINATIONS):
            slopes = adjoints(kernel, values, [generator.choice((-1.0, 1.0)) for _ in kernel.outputs])
            for target, slope in slopes.items():
                largest[target] = max(largest[target], abs(slope * values[target]) * eps / unit)
    total = 0.0
    loaded = {load.local for load in kernel.loads}
    by_share = sorted((target for target in largest if target not in loaded), key=lambda target: largest[target])
    for place, target in enumerate(by_share):
        total += largest[target] ** 2
        if not total <= LEFT**2:
            return frozenset(by_share[place:])
    return frozenset()


def _worst(
    kernel: Kernel, interpreter: Interpreter, expected: Iterable[tuple[Sample, Expectation]]
) -> list[tuple[float, dict[str, float]]]:
    """The unit of error and the values of all locals at the states where a kernel is furthest off."""
    found: list[tuple[float, int, float, dict[str, float]]] = []
    for sample, one in expected:
        state = sample.state
        arguments = {part: tuple(map(float, getattr(state, part))) for part in ("q", "qd", "qdd", "u")}
        values = interpreter.values(kernel, arguments, tuple(map(float, state.parameters)))
        entries = [float(x.value) if isinstance(x, Literal) else values[x.name] for x in kernel.outputs]
        error = one.in_units(one.distance(entries))
        if one.unit and math.isfinite(error):
            found.append((error, len(found), one.unit, values))
    return [(unit, values) for _, _, unit, values in sorted(found, reverse=True)[:STATES]]
