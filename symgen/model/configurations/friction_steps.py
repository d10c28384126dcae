"""How often the loads of rough places are worked out, from the shares of them that friction returns.

Place by place the error of the loads falls as T = (D - L)^-1 U does, of I - K = D - L - U with the shares K: these are
not negative, so that the largest row sum of T^N bounds what N steps leave of the error.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from symgen.records import dataclass

# Shares between configurations are no larger than those at them by more than this.
SHARE_MARGIN = Fraction(5, 4)
# Of a change of reactions, the share that friction may return: from here on a mechanism is taken to lock.
LOCKING_SHARE = Fraction(1, 2)
# What steps leave of the error: less than a rounding.
LEFT_OF_LOADS = 2.0**-54
# Steps that are enough for shares up to the largest: each halves the error.
MOST_FRICTION_STEPS = 54
# A share that rounding leaves of none.
NO_SHARE = 1e-12


@dataclass(frozen=True, slots=True)
class FrictionSteps:
    """The steps that are unrolled, and the largest share kappa that was met where all places slide.

    Of so many `points` a kernel has a status at the `locking` ones as soon as all places slide.
    """

    steps: int
    kappa: float
    points: int
    locking: int

    @property
    def locks(self) -> bool:
        """Whether it is so at all of them, or none was found."""
        return self.locking == self.points

    @property
    def explicit(self) -> bool:
        """Whether no place changes the load of another one."""
        return self.steps == 1


def friction_steps(samples: Sequence[Sequence[Sequence[float]]]) -> FrictionSteps:
    """The steps for the shares K at some configurations, with a margin."""
    steps, largest, locking = 1, 0.0, 0
    for shares in samples:
        kappa = max(map(sum, shares))
        largest, locking = max(largest, kappa), locking + (kappa >= LOCKING_SHARE)
        margin = min(float(SHARE_MARGIN), float(LOCKING_SHARE) / kappa) if kappa else 1.0
        steps = max(steps, steps_for([[margin * x if x > NO_SHARE else 0.0 for x in row] for row in shares]))
    return FrictionSteps(steps, largest, len(samples), locking)


def steps_for(shares: Sequence[Sequence[float]]) -> int:
    """The steps after which less than a rounding is left of the error."""
    errors = [1.0] * len(shares)
    for step in range(MOST_FRICTION_STEPS):
        if max(errors) <= LEFT_OF_LOADS:
            return step
        for i, row in enumerate(shares):
            errors[i] = sum(x * e for j, (x, e) in enumerate(zip(row, errors, strict=True)) if j != i) / (1 - row[i])
    return MOST_FRICTION_STEPS
