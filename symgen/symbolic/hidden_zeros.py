"""Scalars that are 0 everywhere though nothing in them shows it.

Fingerprints know no roots of numbers: of a unit vector along [2, 3, 0] they do not see that it has the length 1, nor
that a turn about it leaves it where it is.  What is made of that and should vanish is rounding error in a kernel, a
wrong number where the whole result is 0.  Double precision finds what may be 0, exact values decide.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.symbolic.evaluate import Evaluator, inner_point
from symgen.symbolic.exact import ExactValues, holding_roots
from symgen.symbolic.identity import POINTS_OF_SIGNS
from symgen.symbolic.scalar import Scalar

# What rounding may leave of a 0 among numbers about 1; more than that is worth no exact value.
ROUNDING_OF_ZEROS = 1e-6


def without_hidden_zeros(scalars: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """The scalars, 0 in place of those that are 0 at every point."""
    unknown = [scalar for scalar in dict.fromkeys(scalars) if scalar.constant is None]
    values = zip(unknown, _floats(unknown), strict=True)
    hidden = [scalar for scalar, value in values if abs(value) <= ROUNDING_OF_ZEROS]
    if not hidden:
        return tuple(scalars)
    zeros = set(_zeros(hidden, 0))
    holding = holding_roots(zeros)
    rooted = [scalar for scalar in zeros if scalar in holding]
    zeros -= {*rooted}
    for seed in range(1, 1 + POINTS_OF_SIGNS):
        rooted = _zeros(rooted, seed)
    zeros |= {*rooted}
    return tuple(scalar.graph.zero if scalar in zeros else scalar for scalar in scalars)


def _zeros(scalars: Sequence[Scalar], seed: int) -> list[Scalar]:
    """Those that are 0 at the point of a seed."""
    values = ExactValues(seed, signs=False)(scalars)
    return [scalar for scalar, value in zip(scalars, values, strict=True) if value == 0]


def _floats(scalars: Sequence[Scalar]) -> Sequence[float]:
    """Values at a point at random; NaN where they have none."""
    return Evaluator(scalars)(inner_point(scalars)) if scalars else ()
