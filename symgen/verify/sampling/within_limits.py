"""Motions that inputs between their limits make: of motions at random hardly any may keep these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite

from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.plain_values import values_at

# The share of the way between limits in which inputs are drawn.
BETWEEN_LIMITS = 0.8


def driven_within_limits(reference: Reference, state: State, shares: Sequence[float]) -> State | None:
    """The state with rates on the constraints and the accelerations of inputs, `shares` of them from -1 to 1.

    None without limits, and where inputs do not determine accelerations.
    """
    model = reference.model
    if not model.keeps_limits or model.allocation is None:
        return None
    values = dict(zip((p.name for p in model.parameters), state.parameters, strict=True))
    by_name = dict(zip((item.name for item in model.inputs), shares, strict=True))
    for limit in model.allocation.limits:
        low, high = values[limit.lower], values[limit.upper]
        by_name[limit.input] = (low + high) / 2 + BETWEEN_LIMITS * by_name[limit.input] * (high - low) / 2
    try:
        (rates,) = values_at(reference, state, ["admissible_velocity"]).values()
        state = replace(state, qd=rates, u=tuple(by_name.values()))
        (accelerations,) = values_at(reference, state, ["forward_dynamics"]).values()
    except ReferenceValueError:
        return None
    return replace(state, qdd=accelerations, u=(0.0,) * model.m) if all(map(isfinite, accelerations)) else None
