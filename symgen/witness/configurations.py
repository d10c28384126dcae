"""Random admissible configurations of a model, in double precision."""

from __future__ import annotations

from collections.abc import Iterator

import casadi
import numpy as np
from numpy.typing import NDArray

from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange

Array = NDArray[np.float64]
# Newton steps towards the constraints.
WITNESS_NEWTON_STEPS = 60
# What is left of the constraints of a configuration.
RESIDUAL = 1e-12
# Of the largest singular value: far above what a residual of 1e-13 leaves in dependent rows, far below a regular
# singular value.
WITNESS_RANK_TOLERANCE = 1e-7
# How far starts lie around `configuration`, in the units of the coordinates.
SPREAD = 0.3


def configurations(model: Model, lagrange: Lagrange, parameters: casadi.DM, seed: int, trials: int) -> Iterator[Array]:
    """Points q (n) of V reached by Gauss-Newton steps, at most `trials` of them.

    Every second start lies near the model's `configuration`, the others anywhere in the ranges.
    """
    rows = lagrange.residual.shape[0]
    system = casadi.Function("system", [lagrange.q, lagrange.p], [lagrange.residual, lagrange.jacobian[:rows, :]])
    generator = np.random.default_rng(seed)
    for trial in range(trials):
        q = _start(model, generator, near_configuration=trial % 2 == 0)
        for _ in range(WITNESS_NEWTON_STEPS):
            g, jacobian = (part.full() for part in system(q, parameters))
            if not np.all(np.isfinite(jacobian)) or np.max(np.abs(g), initial=0) < RESIDUAL / 10:
                break
            q = q - np.linalg.lstsq(jacobian, g.ravel(), rcond=WITNESS_RANK_TOLERANCE)[0]
        g, jacobian = (part.full() for part in system(q, parameters))
        if np.all(np.isfinite(jacobian)) and np.max(np.abs(g), initial=0) < RESIDUAL:
            yield q


def _start(model: Model, generator: np.random.Generator, near_configuration: bool) -> Array:
    low = np.array([float(coordinate.range[0]) for coordinate in model.coordinates])
    high = np.array([float(coordinate.range[1]) for coordinate in model.coordinates])
    anywhere: Array = low + (high - low) * generator.random(model.n)
    if not (near_configuration and model.configuration):
        return anywhere
    known = {name: float(value) for name, value in model.configuration}
    given = np.array([known.get(coordinate.name, np.nan) for coordinate in model.coordinates])
    near: Array = given + SPREAD * (2 * generator.random(model.n) - 1)
    return np.asarray(np.where(np.isnan(given), anywhere, near))
