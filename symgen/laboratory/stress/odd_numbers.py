"""Numbers no state should hold: no kernel may answer them with status 0 and a result that is not finite."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, nan

from symgen.generation.runnable import SCALARS, RunnableKernels, rounded_state
from symgen.ir.kernel import Scalar, Status
from symgen.verify.given import source
from symgen.verify.reference.reference import State

ODD: dict[Scalar, tuple[float, ...]] = {
    "float64": (nan, inf, -inf, 1e308, -1e308, 1e160, 5e-324, 1e-310, 0.0, -0.0),
    "float32": (nan, inf, -inf, 3e38, -3e38, 1e25, 1e-45, 1e-40, 0.0, -0.0),
}


@dataclass(frozen=True, slots=True)
class OddNumbers:
    """How many calls of one kernel were made, and how many came back with status 0."""

    quantity: str
    scalar: Scalar
    calls: int
    answered: int


def odd_numbers(
    kernels: RunnableKernels, names: Sequence[str], states: Sequence[State]
) -> tuple[tuple[OddNumbers, ...], tuple[str, ...]]:
    """Every argument of every kernel set to each odd number in turn."""
    counts: list[OddNumbers] = []
    failures: list[str] = []
    for scalar in SCALARS:
        for name in names:
            calls = answered = 0
            for given in states:
                state = rounded_state(given, scalar)
                for load in kernels.kernel(name, scalar).loads:
                    for odd in ODD[scalar]:
                        part, place = source(load, len(state.q))
                        part = "parameters" if part == "p" else part
                        values = list(getattr(state, part))
                        values[place] = odd
                        changed = {part: tuple(values)}
                        outcome = kernels.run(name, replace(state, **changed), scalar)
                        calls += 1
                        answered += outcome.status == Status.OK
                        if outcome.status == Status.OK and not all(map(isfinite, outcome.entries)):
                            failures.append(f"{name}, {scalar}, {load.local} = {odd}: not finite with status 0")
                        if math.isnan(odd) and load.argument != "p" and outcome.status == Status.OK:
                            failures.append(f"{name}, {scalar}, {load.local} = nan: status 0")
            counts.append(OddNumbers(name, scalar, calls, answered))
    return tuple(counts), tuple(failures)
