"""Weighted least squares with weights from the residuals, against outliers, with honest standard errors.

Each drive has the weight of its own residuals; samples that are far off count less (Huber, Robust Estimation of a
Location Parameter, 1964).  Errors are the larger ones of those of white noise and of those that neighbours in time
allow (Newey and West, A simple, positive semi-definite, heteroskedasticity and autocorrelation consistent covariance
matrix, 1987), each sample judged by the fit without it (MacKinnon and White, Some heteroskedasticity-consistent
covariance matrix estimators with improved finite sample properties, 1985).
"""

from __future__ import annotations

import math

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.estimates.observations import Observations
from symgen.records import dataclass

# Standard deviations up to which a sample counts in full (95 % efficiency for normal noise).
HUBER = 1.345
# The median of absolute normal errors, in standard deviations.
MEDIAN_DEVIATION = 0.6745
# Of a column, what is not a combination of others; below it the column says nothing of its own.
OWN_SHARE = 1e-6
# Neighbours in time whose residuals may be alike.
NEIGHBOURS = 6
# Of the longest column, what rounding makes of one that is 0.
ROUNDED_LENGTH = 1e-9
# Of a residual, the share at least that is not the sample's own doing.
LEAST_SPARE = 0.1
# Of the inputs, a change of the fit after which weights have settled.
SETTLED_FIT = 1e-6
# How often weights are made anew.
MOST_ROUNDS = 50


@dataclass(frozen=True, slots=True)
class LinearEstimate:
    """Values and standard errors (c) with their covariance (c, c); NaN where the columns leave a value open.

    `sigmas` (m) are the residuals of drives, `condition` that of the weighted columns at unit length, `weakest` (c)
    the combination of unit length that these show least.  `outliers` is the share of samples that count less than half.
    """

    values: Array
    errors: Array
    covariance: Array
    open_columns: tuple[int, ...]
    sigmas: Array
    condition: float
    weakest: Array
    outliers: float

    @property
    def closed_columns(self) -> list[int]:
        """Those whose values were determined."""
        return [k for k in range(len(self.values)) if k not in self.open_columns]

    def predicted(self, seen: Observations) -> Array:
        """Inputs (S, m) less what is known."""
        return np.asarray(seen.columns @ np.nan_to_num(self.values), dtype=np.float64)


def estimated(seen: Observations) -> LinearEstimate:
    """The estimate of all columns of a log."""
    count = seen.columns.shape[2]
    kept = _independent(seen)
    columns = seen.columns[..., kept]
    lengths = np.linalg.norm(columns, axis=(0, 1))
    rounds = _Rounds(columns / lengths, seen.inputs, seen.directions)
    solution, covariance = rounds.solution / lengths, rounds.covariance() / np.outer(lengths, lengths)
    values, errors, full = (np.full(shape, math.nan) for shape in (count, count, (count, count)))
    values[kept], errors[kept] = solution, np.sqrt(np.diag(covariance))
    full[np.ix_(kept, kept)] = covariance
    condition, least = rounds.condition()
    weakest = np.zeros(count)
    weakest[kept] = least
    left = tuple(k for k in range(count) if k not in kept)
    outliers = float(np.mean(rounds.weights < 0.5))
    return LinearEstimate(values, errors, full, left, rounds.sigmas, condition, weakest, outliers)


def _independent(seen: Observations) -> list[int]:
    """Columns that no combination of those before them gives, in their order."""
    flat = seen.columns.reshape(-1, seen.columns.shape[2])
    lengths = np.linalg.norm(flat, axis=0)
    kept: list[int] = []
    basis = np.empty((len(flat), 0))
    for k in np.flatnonzero(lengths > ROUNDED_LENGTH * np.max(lengths)):
        own = flat[:, k] / lengths[k]
        for _ in range(2):  # the second time takes what rounding left
            own = own - basis @ (basis.T @ own)
        size = float(np.linalg.norm(own))
        if size > OWN_SHARE and len(kept) < len(flat):
            kept.append(int(k))
            basis = np.column_stack([basis, own / size])
    return kept


class _Rounds:
    """Weights of drives and samples, made anew until they have settled."""

    def __init__(self, columns: Array, inputs: Array, directions: int) -> None:
        self._columns, self._inputs, self._directions = columns, inputs, directions
        samples, drives = inputs.shape
        self.weights = np.ones(samples)
        self.sigmas = np.ones(drives)
        self.solution = self._solved()
        for _ in range(MOST_ROUNDS):
            before = self.solution
            self.sigmas = self._deviations()
            distance = np.sqrt(np.mean((self.residuals / self.sigmas) ** 2, axis=1))
            self.weights = np.minimum(1.0, HUBER / np.maximum(distance, 1e-300))
            self.solution = self._solved()
            scale = np.sqrt(np.sum((columns @ (self.solution - before)) ** 2) / max(np.sum(inputs**2), 1e-300))
            if scale < SETTLED_FIT:
                break

    @property
    def residuals(self) -> Array:
        """Measured less fitted inputs (S, m)."""
        return np.asarray(self._inputs - self._columns @ self.solution, dtype=np.float64)

    def covariance(self) -> Array:
        """Of the solution (c, c); samples beyond the corner of Huber's function take no part in its slope."""
        columns = self._weighted()
        inverse: Array = np.asarray(np.linalg.pinv(_normal(columns[self.weights >= 1])), dtype=np.float64)
        samples, drives, count = columns.shape
        bounded: Array = np.asarray(self.residuals / self.sigmas * self.weights[:, None], dtype=np.float64)
        # what drives share in one direction is one error
        spare = max(1, samples * self._directions - count) / (samples * drives)
        white = inverse @ _normal(columns) @ inverse * float(np.mean(bounded**2)) / spare
        middle = _of_neighbours(np.einsum("smc,sm->sc", columns, _as_if_left_out(columns, inverse, bounded)))
        alike = inverse @ middle @ inverse
        factors = np.sqrt(np.maximum(1.0, np.diag(alike) / np.maximum(np.diag(white), 1e-300)))
        return np.asarray(white * np.outer(factors, factors), dtype=np.float64)

    def condition(self) -> tuple[float, Array]:
        """The condition number of the weighted columns at unit length, and the combination that they show least."""
        normal = _normal(self._weighted())
        lengths = np.sqrt(np.diag(normal))
        values, vectors = np.linalg.eigh(normal / np.outer(lengths, lengths))
        return math.sqrt(float(values[-1]) / max(float(values[0]), 1e-300)), vectors[:, 0]

    def _weighted(self) -> Array:
        return np.asarray(self._columns / self.sigmas[:, None], dtype=np.float64)

    def _solved(self) -> Array:
        root = np.sqrt(self.weights)[:, None]
        flat = (self._weighted() * root[..., None]).reshape(-1, self._columns.shape[2])
        lengths = np.linalg.norm(flat, axis=0)
        solved = np.linalg.lstsq(flat / lengths, (self._inputs / self.sigmas * root).ravel(), rcond=None)[0]
        return np.asarray(solved / lengths, dtype=np.float64)

    def _deviations(self) -> Array:
        sizes = np.median(np.abs(self.residuals), axis=0) / MEDIAN_DEVIATION
        floor = np.finfo(float).eps * np.max(np.abs(self._inputs), axis=0)
        return np.asarray(np.maximum(sizes, np.maximum(floor, 1e-300)), dtype=np.float64)


def _normal(columns: Array) -> Array:
    """The matrix of normal equations (c, c) of columns (S, m, c)."""
    flat = columns.reshape(-1, columns.shape[2])
    return np.asarray(flat.T @ flat, dtype=np.float64)


def _as_if_left_out(columns: Array, inverse: Array, residuals: Array) -> Array:
    """Residuals (S, m) that each sample would have if the others alone were fitted."""
    shares = np.einsum("smc,cd,snd->smn", columns, inverse, columns)
    left = np.eye(columns.shape[1]) - shares
    # a sample that the fit rests on alone says nothing of its error
    left += np.eye(columns.shape[1]) * np.maximum(0.0, LEAST_SPARE - np.linalg.eigvalsh(left)[:, 0])[:, None, None]
    return np.asarray(np.linalg.solve(left, residuals[..., None])[..., 0], dtype=np.float64)


def _of_neighbours(scores: Array) -> Array:
    """The sum (c, c) of products of scores (S, c), those of neighbours in time included."""
    middle = scores.T @ scores
    for lag in range(1, min(NEIGHBOURS, len(scores) - 1) + 1):
        moved = scores[lag:].T @ scores[:-lag] * (1 - lag / (NEIGHBOURS + 1))
        middle = middle + moved + moved.T
    return np.asarray(middle, dtype=np.float64)
