"""The full set of inertial parameters: ten a body, each body such as can be, nearest to the estimates and to the file.

What the log determines counts in its standard errors, what it leaves open stays near the file: a pseudo-inertia by a
standard deviation as large as the mass and a length of its body, the same in all directions.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array
from symgen.identification.bodies.barrier import by_barrier
from symgen.identification.bodies.nearest_bodies import LEAST_EIGENVALUE, NearestBodies
from symgen.identification.bodies.pseudo_inertia import (
    DIRECTIONS,
    coordinates,
    nearest_possible,
    pseudo_inertia,
    ten_parameters,
)
from symgen.identification.bodies.semidefinite import by_semidefinite_program
from symgen.identification.combinations import BodyCombinations, base_map, inertial_values
from symgen.identification.estimates.least_squares import LinearEstimate
from symgen.identification.estimates.linear_terms import EstimatedNames
from symgen.identification.estimates.whitened import deviation_before, whitening
from symgen.model.inertial_parameters import InertialParameter
from symgen.model.model import Model
from symgen.records import dataclass

# How the set was come to.
AS_ESTIMATED = "as estimated: every body can be"
BY_PROGRAM = "semidefinite program (CVXPY, Clarabel)"
BY_BARRIER = "barrier method (SciPy)"
# The eigenvalue, at mass and length of the body, that one has at first which the file makes impossible, as it does in
# the plane, where it gives one moment: a radius of gyration of a tenth of the length.
PLAIN_EIGENVALUE = 0.01
# Of a standard error, what rounding makes of a value that is 0.
ROUNDED_VALUE = 1e-9
# How near to the least eigenvalue one is at the edge.
AT_EDGE = 1e-6
# A body without mass in the file is measured at this, where no other body has one either, and one at a point by this.
USUAL_MASS, USUAL_LENGTH = 1.0, 1.0


@dataclass(frozen=True, slots=True)
class WholeBodies:
    """Values (p) of all inertial `parameters`, with those before and standard errors; `linear` are the further ones.

    Those that `count` (p) are part of a base parameter.

    `misfit` is how far base parameters made of them are from the estimates, in standard errors of these (rms);
    `at_edge` are bodies and rotors that would go beyond what can be, were they let.
    """

    parameters: tuple[InertialParameter, ...]
    before: Array
    values: Array
    errors: Array
    count: tuple[bool, ...]
    linear: Mapping[str, float]
    misfit: float
    at_edge: tuple[str, ...]
    method: str


def whole_bodies(
    model: Model, made: BodyCombinations, names: EstimatedNames, known: Mapping[str, float], estimate: LinearEstimate
) -> WholeBodies:
    """The full set that a log and a file come to."""
    before = inertial_values(model, known)
    scaled = _scaled(model, before)
    count = scaled.unknowns.shape[1]
    by_name = {p.name: p for p in model.parameters}
    held = np.array([deviation_before(by_name[name], known[name]) for name in names.with_columns])
    unknowns = linalg.block_diag(scaled.unknowns, np.diag(held))
    possible = np.concatenate([scaled.possible, np.array([known[name] for name in names.with_columns]) / held])
    closed = estimate.closed_columns
    combined = estimate.shown(linalg.block_diag(made.matrix, np.eye(len(held))) @ unknowns)
    white = whitening(estimate)
    problem = _problem(white @ combined, white @ estimate.values[closed], possible, scaled)
    x, method = _solved(problem)
    steps = unknowns @ linalg.solve_triangular(problem.factor, np.eye(len(x)))
    errors = np.linalg.norm(steps[: len(before)], axis=1)
    values = scaled.unknowns @ x[:count]
    values[np.abs(values) < ROUNDED_VALUE * errors] = 0.0
    off = white @ (combined @ x - estimate.values[closed])
    edge = problem.least(x) < AT_EDGE
    return WholeBodies(
        made.base.parameters,
        before,
        values,
        np.asarray(errors, dtype=np.float64),
        tuple(map(bool, np.any(base_map(made.base), axis=0))),
        dict(zip(names.with_columns, map(float, (unknowns @ x)[len(before) :]), strict=True)),
        float(np.sqrt(np.mean(off**2))) if len(off) else 0.0,
        tuple(name for name, reached in zip(scaled.owners, edge, strict=True) if reached),
        method,
    )


@dataclass(frozen=True, slots=True)
class _ScaledBodies:
    """Inertial parameters (p) = unknowns (p, 10 b + r) x, of `owners`: bodies with any mass or moment, then rotors.

    `possible` (10 b + r) is the file, each body as near to it as one can be.
    """

    unknowns: Array
    possible: Array
    owners: tuple[str, ...]
    bodies: int


def _scaled(model: Model, before: Array) -> _ScaledBodies:
    count = len(model.mechanism.bodies)
    tens = before[: 10 * count].reshape(count, 10)
    rotors = before[10 * count :]
    kept = [k for k in range(count) if np.any(tens[k])]
    masses = _sizes(tens[kept, 0], USUAL_MASS)
    lengths = np.sqrt(_sizes(tens[kept, 4:7].sum(axis=1) / 2 / masses, USUAL_LENGTH**2))
    scales = _sizes(rotors, float(np.mean(masses * lengths**2)) if kept else 1.0)
    unknowns = np.zeros((len(before), 10 * len(kept) + len(rotors)))
    possible = np.empty(unknowns.shape[1])
    for place, (k, mass, length) in enumerate(zip(kept, masses, lengths, strict=True)):
        units = np.sqrt(mass) * np.array([length, length, length, 1.0])
        columns = [ten_parameters(units[:, None] * one * units) for one in DIRECTIONS]
        unknowns[10 * k : 10 * k + 10, 10 * place : 10 * place + 10] = np.transpose(columns)
        matrix = pseudo_inertia(tens[k]) / units[:, None] / units
        if np.linalg.eigvalsh(matrix)[0] < LEAST_EIGENVALUE:
            matrix = nearest_possible(matrix, PLAIN_EIGENVALUE)
        possible[10 * place : 10 * place + 10] = coordinates(matrix)
    own = np.arange(len(rotors))
    unknowns[10 * count + own, 10 * len(kept) + own] = scales
    possible[10 * len(kept) :] = np.maximum(rotors / scales, LEAST_EIGENVALUE)
    owners = [model.mechanism.bodies[k].name for k in kept]
    owners += [rotor.coordinate for rotor in model.mechanism.rotor_inertias]
    return _ScaledBodies(unknowns, possible, tuple(owners), len(kept))


def _sizes(given: Array, usual: float) -> Array:
    """What is above 0, and the mean of that for the others."""
    positive = given[given > 0]
    return np.where(given > 0, given, np.mean(positive) if len(positive) else usual)


def _problem(rows: Array, target: Array, possible: Array, scaled: _ScaledBodies) -> NearestBodies:
    """Rows that the data want to be the target, and each unknown held where it was possible."""
    columns = np.vstack([rows, np.eye(len(possible))])
    orthonormal, factor = linalg.qr(columns, mode="economic")
    centre = linalg.solve_triangular(factor, orthonormal.T @ np.concatenate([target, possible]))
    rotors = len(scaled.owners) - scaled.bodies
    return NearestBodies(centre, factor, scaled.bodies, rotors, possible)


def _solved(problem: NearestBodies) -> tuple[Array, str]:
    if np.all(problem.least(problem.centre) >= 0):
        return problem.centre, AS_ESTIMATED
    if find_spec("cvxpy") is not None and find_spec("clarabel") is not None:
        solved = by_semidefinite_program(problem)
        if solved is not None:
            return solved, BY_PROGRAM
    return by_barrier(problem), BY_BARRIER
