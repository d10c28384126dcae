"""Redundant inputs in CasADi as the model's allocation says: least weighted norm, internal force, limits."""

from __future__ import annotations

from collections.abc import Sequence

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
    least = preferred + inverse @ (s.balance - s.control @ preferred)
    if not allocation.directed:
        return least
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
