"""Redundant inputs in CasADi as the model's allocation says: least weighted norm, internal force, limits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, combinations, product

import casadi

from symgen.model.model import Allocation, Model
from symgen.witness.lagrange import Lagrange
from symgen.witness.linear import pseudoinverse


def allocated(model: Model, allocation: Allocation, s: Lagrange, projector: casadi.SX, rank: int) -> casadi.SX:
    """u (m) from the unscaled pseudoinverse of the columns M_j/√w_j, the internal force and the limits' intervals."""
    names = [item.name for item in model.inputs]
    value = {parameter.name: s.p[i] for i, parameter in enumerate(model.parameters)}
    weights = _by_input(names, allocation.weights, value, 1)
    preferred = _by_input(names, allocation.preferred, value, 0)
    shrink = casadi.diag(1 / casadi.sqrt(weights))
    inverse = shrink @ pseudoinverse(projector @ s.control @ shrink, rank)
    balance = _scaled(model, allocation, s, projector, rank) if allocation.scale else s.balance
    least = preferred + inverse @ (balance - s.control @ preferred)
    if not allocation.directed or rank == len(names):
        return least
    if model.keeps_limits:
        unmoving = (casadi.SX.eye(len(names)) - inverse @ projector @ s.control) @ shrink @ shrink
        limits = [(names.index(one.input), value[one.lower], value[one.upper]) for one in allocation.limits]
        return _nearest_within(least, unmoving, limits, len(names) - rank)
    z = _internal_force(s, weights)
    share = casadi.SX(0) if allocation.preload is None else value[allocation.preload]
    start, end = casadi.SX(-casadi.inf), casadi.SX(casadi.inf)
    for limit in allocation.limits:
        k = names.index(limit.input)
        ends = [(value[bound] - least[k]) / z[k] for bound in (limit.lower, limit.upper)]
        takes_part = z[k] != 0
        start = casadi.fmax(start, casadi.if_else(takes_part, casadi.fmin(*ends), -casadi.inf))
        end = casadi.fmin(end, casadi.if_else(takes_part, casadi.fmax(*ends), casadi.inf))
    below, above = casadi.fmin(start, end), casadi.fmax(start, end)
    return least + casadi.fmax(below, casadi.fmin(above, share)) * z


def utilisation(model: Model, allocation: Allocation, s: Lagrange, projector: casadi.SX, rank: int) -> casadi.SX:
    """The largest |M_J, τ − M c| / Σ_i |M_J, M_i| h_i of all J of δ − 1 inputs, |X| the volume √det XᵀN X beside B."""
    middles, halves = _middles(model, allocation, s), _halves(model, allocation, s)
    load, largest = s.balance - s.control @ middles, casadi.SX(0)

    def volume(columns: casadi.SX) -> casadi.SX:
        return casadi.sqrt(casadi.fmax(casadi.det(columns.T @ projector @ columns), 0))

    for chosen in combinations(range(model.m), rank - 1):
        beside = s.control[:, list(chosen)]
        reach = casadi.SX(0)
        for i in range(model.m):
            if i not in chosen:
                reach += volume(casadi.horzcat(s.control[:, i], beside)) * halves[i]
        largest = casadi.fmax(largest, volume(casadi.horzcat(load, beside)) / reach)
    return largest


def _scaled(model: Model, allocation: Allocation, s: Lagrange, projector: casadi.SX, rank: int) -> casadi.SX:
    """M c + (τ − M c) / ρ where more than 1 is needed."""
    supplied = s.control @ _middles(model, allocation, s)
    share = casadi.fmax(utilisation(model, allocation, s, projector, rank), 1)
    return supplied + (s.balance - supplied) / share


def _middles(model: Model, allocation: Allocation, s: Lagrange) -> casadi.SX:
    return casadi.vertcat(*((lower + upper) / 2 for lower, upper in _ends(model, allocation, s)))


def _halves(model: Model, allocation: Allocation, s: Lagrange) -> casadi.SX:
    return casadi.vertcat(*((upper - lower) / 2 for lower, upper in _ends(model, allocation, s)))


def _ends(model: Model, allocation: Allocation, s: Lagrange) -> list[tuple[casadi.SX, casadi.SX]]:
    value = {parameter.name: s.p[i] for i, parameter in enumerate(model.parameters)}
    ends = {limit.input: (value[limit.lower], value[limit.upper]) for limit in allocation.limits}
    return [ends[item.name] for item in model.inputs]


def _nearest_within(
    least: casadi.SX, unmoving: casadi.SX, limits: Sequence[tuple[int, casadi.SX, casadi.SX]], directions: int
) -> casadi.SX:
    """Of the nearest inputs with some at their limits those that keep all of these: NaN where there are none."""
    best, distance = casadi.SX.nan(least.shape[0]), casadi.SX(casadi.inf)
    for held in chain.from_iterable(combinations(limits, count) for count in range(directions + 1)):
        places = [k for k, *_ in held]
        for sides in product((1, 2), repeat=len(held)):
            missing = casadi.vertcat(*(limit[side] for limit, side in zip(held, sides, strict=True))) - least[places]
            factors = casadi.solve(unmoving[places, places], missing) if held else missing
            inputs = least + unmoving[:, places] @ factors
            # what stands at its limit is not to miss it by a rounding
            others = [limit for limit in limits if limit not in held]
            kept = [casadi.logic_and(lower <= inputs[k], inputs[k] <= upper) for k, lower, upper in others]
            square = casadi.dot(missing, factors) if held else casadi.SX(0)
            nearer = casadi.logic_and(casadi.logic_all(casadi.vertcat(1, *kept)), square < distance)
            best, distance = casadi.if_else(nearer, inputs, best), casadi.if_else(nearer, square, distance)
    return best


def _internal_force(s: Lagrange, weights: casadi.SX) -> casadi.SX:
    """z (m), z_k = ±det[M without column k, Bᵀ] with alternating signs, of weighted norm 1."""
    m = s.control.shape[1]
    minors = []
    for k in range(m):
        others = [j for j in range(m) if j != k]
        minors.append((-1) ** k * casadi.det(casadi.horzcat(s.control[:, others], s.jacobian.T)))
    z: casadi.SX = casadi.vertcat(*minors)
    size: casadi.SX = casadi.sqrt(casadi.dot(weights, z**2))
    return z / size


def _by_input(
    names: Sequence[str], given: Sequence[tuple[str, str]], value: dict[str, casadi.SX], absent: int
) -> casadi.SX:
    chosen = {name: value[parameter] for name, parameter in given}
    return casadi.vertcat(*(chosen.get(name, casadi.SX(absent)) for name in names))
