"""Generic ranks of a model, found numerically at random points of the configuration space V."""

from __future__ import annotations

from itertools import islice

import casadi
import numpy as np

from symgen.model.configurations.assembly import ConfigurationRanks
from symgen.model.model import Model
from symgen.witness.configurations import WITNESS_RANK_TOLERANCE, Array, configurations
from symgen.witness.lagrange import Lagrange
from symgen.witness.translate import default_parameters

# Random points of V at which ranks are looked at.
GENERIC_POINTS = 6
# Starts for as many, at most.
TRIALS = 60


def generic_ranks(model: Model, lagrange: Lagrange) -> ConfigurationRanks:
    """The largest ranks met at random admissible configurations, default parameters; ValueError if there is none."""
    matrices = casadi.Function("matrices", [lagrange.q, lagrange.p], [lagrange.jacobian, lagrange.control])
    parameters = default_parameters(model)
    geometric_rows = lagrange.residual.shape[0]
    sampled: list[tuple[int, int, int]] = []
    for q in islice(configurations(model, lagrange, parameters, seed=1, trials=TRIALS), GENERIC_POINTS):
        B, M = (part.full() for part in matrices(q, parameters))
        if np.all(np.isfinite(B)) and np.all(np.isfinite(M)):
            seen = _null_projector(B) @ M
            sampled.append((_rank(B), _rank(B[:geometric_rows]), _rank(seen, float(np.linalg.norm(M)))))
    if not sampled:
        raise ValueError(f"{model.name}: no admissible configuration found")
    constraints, geometric, actuation = (max(column) for column in zip(*sampled, strict=True))
    return ConfigurationRanks(constraints, geometric, actuation)


def _rank(matrix: Array, scale: float | None = None) -> int:
    """Numerical rank, relative to the largest singular value or a given scale."""
    if matrix.size == 0:
        return 0
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(values > WITNESS_RANK_TOLERANCE * (values[0] if scale is None else scale)))


def _null_projector(B: Array) -> Array:
    if B.size == 0:
        return np.eye(B.shape[1])
    _, values, Vt = np.linalg.svd(B)
    F = Vt[int(np.sum(values > WITNESS_RANK_TOLERANCE * values[0])) :].T
    projector: Array = F @ F.T
    return projector
