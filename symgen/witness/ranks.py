"""Generic ranks of a model, found numerically at random points of the configuration space V."""

from __future__ import annotations

from dataclasses import dataclass

import casadi
import numpy as np
from numpy.typing import NDArray

from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange
from symgen.witness.translate import default_parameters

Array = NDArray[np.float64]
POINTS = 6
TRIALS = 60
NEWTON_STEPS = 60
RANK_TOLERANCE = 1e-7  # far above what a residual of 1e-13 leaves in dependent rows, far below a regular singular value


@dataclass(frozen=True, slots=True)
class Ranks:
    """Ranks that hold almost everywhere on V: of B, of its geometric rows, and of M̃ = N M (degree of actuation)."""

    constraints: int
    geometric: int
    actuation: int


def generic_ranks(model: Model, lagrange: Lagrange) -> Ranks:
    """The largest ranks met at random admissible configurations, default parameters; ValueError if none is found."""
    system = casadi.Function(
        "system", [lagrange.q, lagrange.p], [lagrange.residual, lagrange.jacobian, lagrange.control]
    )
    parameters = default_parameters(model)

    def evaluate(q: Array) -> tuple[Array, Array, Array]:
        g, B, M = system(q, parameters)
        return g.full().ravel(), B.full(), M.full()

    geometric_rows = lagrange.residual.shape[0]
    found: list[tuple[int, int, int]] = []
    generator = np.random.default_rng(1)
    for trial in range(TRIALS):
        start = _start(model, generator, near_configuration=trial % 2 == 0)
        q = start
        for _ in range(NEWTON_STEPS):
            g, B, M = evaluate(q)
            if not np.all(np.isfinite(B)) or np.max(np.abs(g), initial=0) < 1e-13:
                break
            q = q - np.linalg.lstsq(B[:geometric_rows], g, rcond=RANK_TOLERANCE)[0]
        g, B, M = evaluate(q)
        if np.all(np.isfinite(B)) and np.max(np.abs(g), initial=0) < 1e-12:
            N = _null_projector(B)
            found.append((_rank(B), _rank(B[:geometric_rows]), _rank(N @ M, float(np.linalg.norm(M)))))
        if len(found) == POINTS:
            break
    if not found:
        raise ValueError(f"{model.name}: no admissible configuration found")
    constraints, geometric, actuation = (max(column) for column in zip(*found, strict=True))
    return Ranks(constraints, geometric, actuation)


def _start(model: Model, generator: np.random.Generator, near_configuration: bool) -> Array:
    """Half of the starts lie near the model's `configuration`, the others anywhere in the ranges."""
    low = np.array([float(coordinate.range[0]) for coordinate in model.coordinates])
    high = np.array([float(coordinate.range[1]) for coordinate in model.coordinates])
    anywhere = low + (high - low) * generator.random(model.n)
    if not (near_configuration and model.configuration):
        return np.asarray(anywhere)
    known = {name: float(value) for name, value in model.configuration}
    given = np.array([known.get(coordinate.name, np.nan) for coordinate in model.coordinates])
    near: Array = given + 0.3 * (generator.random(model.n) - 0.5)
    return np.asarray(np.where(np.isnan(given), anywhere, near))


def _rank(matrix: Array, scale: float | None = None) -> int:
    """Numerical rank, relative to the largest singular value or a given scale."""
    if matrix.size == 0:
        return 0
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(values > RANK_TOLERANCE * (values[0] if scale is None else scale)))


def _null_projector(B: Array) -> Array:
    if B.size == 0:
        return np.eye(B.shape[1])
    _, values, Vt = np.linalg.svd(B)
    F = Vt[int(np.sum(values > RANK_TOLERANCE * values[0])) :].T
    projector: Array = F @ F.T
    return projector
