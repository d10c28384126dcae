"""Redundant inputs by definition: weighted least norm, a share of the internal force, limits by their intervals.

The direction of the internal force comes from m determinants of [M without a column, B'], the least norm from the
Moore-Penrose inverse of M~ W^(-1/2), the limits from the end points of the intervals that each one leaves; along more
directions see `limits`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb, arb_mat

from symgen.model.model import Allocation
from symgen.verify.reference.arithmetic.linear import column, columns_of, determinant, pseudoinverse, solve
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.inputs.limits import nearest_within, unmoving_inputs
from symgen.verify.reference.inputs.limits import utilisation as share_of_limits


def allocated(e: Evaluation, allocation: Allocation) -> Any:
    """u (m x 1): of all inputs with N M u = N tau those that the allocation asks for."""
    model = e.system.model
    names, value = _named(e)
    load = _scaled(e, allocation) if allocation.scale else e.load
    if e.system.m == e.ranks.actuation:
        return e.control_inverse * load
    weights = _by_input(names, allocation.weights, value, arb(1))
    preferred = column(_by_input(names, allocation.preferred, value, arb(0)))
    inverse = _weighted_inverse(e, weights)
    least = preferred + inverse * (e.projector * (load - e.at.control * preferred))
    if not allocation.directed:
        return least
    if model.keeps_limits:
        unmoving = unmoving_inputs(inverse, e.projected_control, weights)
        return nearest_within(least, unmoving, _limits(e, allocation), e.system.m - e.ranks.actuation, weights)
    direction = internal_force(e, weights)
    share = arb(0) if allocation.preload is None else value[allocation.preload]
    starts, ends = [], []
    for limit in allocation.limits:
        k = names.index(limit.input)
        u, z = least[k, 0], direction[k, 0]
        if not z.contains(0):
            first, second = (value[limit.lower] - u) / z, (value[limit.upper] - u) / z
            starts.append(first.min(second))
            ends.append(first.max(second))
    if starts:
        share = _middle(_fold(starts, "max"), _fold(ends, "min"), share)
    return least + direction * share


def utilisation(e: Evaluation, allocation: Allocation) -> Any:
    """The share of their limits that the inputs need at least (1 x 1)."""
    by_input = {k: (lower, upper) for k, lower, upper in _limits(e, allocation)}
    limits = [(k, *by_input[k]) for k in range(e.system.m)]
    unmoving = unmoving_inputs(e.control_inverse, e.projected_control, [arb(1)] * e.system.m)
    return share_of_limits(e.inputs, unmoving, limits, e.system.m - e.ranks.actuation)


def _scaled(e: Evaluation, allocation: Allocation) -> Any:
    """The largest share of the load, beside what middles of limits supply, that inputs within these supply."""
    by_input = {k: (lower + upper) / 2 for k, lower, upper in _limits(e, allocation)}
    supplied = e.at.control * column([by_input[k] for k in range(e.system.m)])
    share = utilisation(e, allocation)[0, 0].max(arb(1))
    return supplied + (e.load - supplied) * (1 / share)


def _named(e: Evaluation) -> tuple[list[str], dict[str, Any]]:
    """The names of the inputs, and the values of the parameters."""
    model = e.system.model
    value = dict(zip((parameter.name for parameter in model.parameters), e.parameters, strict=True))
    return [item.name for item in model.inputs], value


def _limits(e: Evaluation, allocation: Allocation) -> list[tuple[int, Any, Any]]:
    names, value = _named(e)
    return [(names.index(one.input), value[one.lower], value[one.upper]) for one in allocation.limits]


def internal_force(e: Evaluation, weights: Sequence[Any]) -> Any:
    """z (m x 1): z_k = (-1)^(k-1) det[M without column k, B'] over the root of sum_k w_k z_k^2, for m = delta + 1."""
    m, transposed = e.system.m, e.at.constraints.transpose().tolist()
    entries = []
    for k in range(m):
        kept = columns_of(e.at.control, [j for j in range(m) if j != k]).tolist()
        square = arb_mat(e.system.n, e.system.n, [x for a, b in zip(kept, transposed, strict=True) for x in (*a, *b)])
        entries.append((-1) ** k * determinant(square))
    size = sum((w * z * z for w, z in zip(weights, entries, strict=True)), arb(0)).sqrt()
    return column([z / size for z in entries])


def _by_input(names: Sequence[str], given: Sequence[tuple[str, str]], value: dict[str, Any], absent: Any) -> list[Any]:
    chosen = {name: value[parameter] for name, parameter in given}
    return [chosen.get(name, absent) for name in names]


def _weighted_inverse(e: Evaluation, weights: Sequence[Any]) -> Any:
    """W^(-1/2) (M~ W^(-1/2))+, m x n."""
    m, n = e.system.m, e.system.n
    roots = [w.rsqrt() for w in weights]
    scaling = arb_mat(m, m, [roots[i] if i == j else arb(0) for i in range(m) for j in range(m)])
    scaled = e.projected_control * scaling
    if e.ranks.actuation == n - e.ranks.constraints:  # range(N M) = ker B: (X X' + P) is regular
        return scaling * solve(scaled * scaled.transpose() + e.projector_off, scaled).transpose()
    return scaling * pseudoinverse(scaled, e.ranks.actuation)


def _fold(values: Sequence[Any], choose: str) -> Any:
    extreme = values[0]
    for value in values[1:]:
        extreme = getattr(extreme, choose)(value)
    return extreme


def _middle(a: Any, b: Any, c: Any) -> Any:
    """The middle one of three."""
    return a.min(b).max(a.max(b).min(c))
