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
from scipy import linalg

from symgen.identification.arrays import Array
from symgen.identification.estimates.inverse_root import inverse_root
from symgen.identification.estimates.observations import Observations
from symgen.identification.independent import independent_columns
from symgen.records import dataclass

# Standard deviations up to which a sample counts in full (95 % efficiency for normal noise).
HUBER = 1.345
# The median of absolute normal errors, in standard deviations.
MEDIAN_DEVIATION = 0.6745
# Neighbours in time whose residuals may be alike.
NEIGHBOURS = 6
# Of a residual, the share at least that is not the sample's own doing.
LEAST_SPARE = 0.1
# Of the inputs, a change of the fit after which weights have settled.
SETTLED_FIT = 1e-6
# How often weights are made anew.
MOST_ROUNDS = 50


@dataclass(frozen=True, slots=True)
class LinearEstimate:
    """Values (c) with a root (c, c) of their covariance; NaN where the columns leave a value open.

    What is open adds to values that are not: `shares` (closed, open) are the coefficients of its columns by the others.
    `sigmas` (m) are the residuals of drives, `condition` that of the weighted columns at unit length, `weakest` (c)
    the combination of unit length that these show least.  `outliers` is the share of samples that count less than half.
    """

    values: Array
    root: Array
    open_columns: tuple[int, ...]
    shares: Array
    sigmas: Array
    condition: float
    weakest: Array
    outliers: float

    @property
    def covariance(self) -> Array:
        """Of the values (c, c): the root times itself, transposed."""
        return np.asarray(self.root @ self.root.T, dtype=np.float64)

    @property
    def errors(self) -> Array:
        """Standard errors (c)."""
        return np.asarray(np.linalg.norm(self.root, axis=1), dtype=np.float64)

    @property
    def closed_columns(self) -> list[int]:
        """Those whose values were determined."""
        return [k for k in range(len(self.values)) if k not in self.open_columns]

    def shown(self, whole: Array) -> Array:
        """What the values that were determined would be for `whole` columns (c) or rows (c, ...) of values."""
        return np.asarray(whole[self.closed_columns] + self.shares @ whole[list(self.open_columns)], dtype=np.float64)

    def predicted(self, seen: Observations) -> Array:
        """Inputs (S, m) less what is known."""
        return np.asarray(seen.columns @ np.nan_to_num(self.values), dtype=np.float64)


def estimated(seen: Observations, instruments: Array | None = None) -> LinearEstimate:
    """The estimate of all columns of a log.

    Columns with noise of the log in them have `instruments` (S, m, c): all columns, these as they are without noise.
    What is left by the fit is orthogonal to instruments, not to columns, and what they do not tell apart is left open.
    """
    count = seen.columns.shape[2]
    kept = independent_columns(_flat(seen.columns if instruments is None else instruments))
    columns = seen.columns[..., kept]
    lengths = np.linalg.norm(columns, axis=(0, 1))
    chosen = None if instruments is None else _at_unit_length(instruments[..., kept])
    rounds = _Rounds(columns / lengths, seen.inputs, seen.directions, chosen)
    left = tuple(k for k in range(count) if k not in kept)
    values, root = np.full(count, math.nan), np.zeros((count, count))
    values[kept], root[np.ix_(kept, kept)] = rounds.solution / lengths, rounds.covariance_root() / lengths[:, None]
    root[list(left)] = math.nan
    shares = rounds.solved_for(seen.columns[..., left]) / lengths[:, None]
    condition, least = rounds.condition()
    weakest = np.zeros(count)
    weakest[kept] = least
    outliers = float(np.mean(rounds.weights < 0.5))
    return LinearEstimate(values, root, left, shares, rounds.sigmas, condition, weakest, outliers)


class _Rounds:
    """Weights of drives and samples, made anew until they have settled."""

    def __init__(self, columns: Array, inputs: Array, directions: int, instruments: Array | None) -> None:
        self._columns, self._inputs, self._directions = columns, inputs, directions
        self._instruments = instruments
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

    def covariance_root(self) -> Array:
        """A root (c, c) of the covariance of the solution.

        Samples beyond the corner of Huber's function take no part in its slope.  Columns are taken along directions in
        which those of the other samples are orthonormal: squares of their condition number never occur.
        """
        weighted = self._weighted((self.weights >= 1).astype(float))
        inverse = inverse_root(_flat(weighted[self.weights >= 1]))
        columns = np.asarray(weighted @ inverse, dtype=np.float64)
        samples, drives, count = columns.shape
        bounded: Array = np.asarray(self.residuals / self.sigmas * self.weights[:, None], dtype=np.float64)
        # what drives share in one direction is one error
        spare = max(1, samples * self._directions - count) / (samples * drives)
        triangle = linalg.qr(_flat(columns), mode="r")[0][:count]
        middle = _of_neighbours(np.einsum("smc,sm->sc", columns, _as_if_left_out(columns, bounded)))
        spread = triangle.T * math.sqrt(float(np.mean(bounded**2)) / spare)
        return np.asarray(inverse @ _larger(spread, middle), dtype=np.float64)

    def condition(self) -> tuple[float, Array]:
        """The condition number of the weighted columns at unit length, and the combination that they show least."""
        columns = _flat(self._weighted(np.ones(len(self.weights))))
        _, values, rows = linalg.svd(columns / np.linalg.norm(columns, axis=0), full_matrices=False)
        return float(values[0]) / max(float(values[-1]), 1e-300), np.asarray(rows[-1], dtype=np.float64)

    def _weighted(self, samples: Array) -> Array:
        """Columns by weights of drives; with instruments what these show of them, by weights of samples (S).

        Least squares of the second stage (Theil, Economic Forecasts and Policy, 1958).
        """
        columns = self._columns / self.sigmas[:, None]
        if self._instruments is None:
            return np.asarray(columns, dtype=np.float64)
        root, instruments = np.sqrt(samples)[:, None, None], self._instruments / self.sigmas[:, None]
        shares = np.linalg.lstsq(_flat(instruments * root), _flat(columns * root), rcond=None)[0]
        return np.asarray(instruments @ shares, dtype=np.float64)

    def _solved(self) -> Array:
        return self.solved_for(self._inputs[..., None])[:, 0]

    def solved_for(self, wanted: Array) -> Array:
        """The values (c, k) of the columns that come nearest to wanted ones (S, m, k), by weights as they are."""
        root = np.sqrt(self.weights)[:, None, None]
        flat, wanted = (_flat(of * root) for of in (self._weighted(self.weights), wanted / self.sigmas[:, None]))
        lengths = np.linalg.norm(flat, axis=0)
        solved = np.linalg.lstsq(flat / lengths, wanted, rcond=None)[0]
        return np.asarray(solved / lengths[:, None], dtype=np.float64)

    def _deviations(self) -> Array:
        sizes = np.median(np.abs(self.residuals), axis=0) / MEDIAN_DEVIATION
        floor = np.finfo(float).eps * np.max(np.abs(self._inputs), axis=0)
        return np.asarray(np.maximum(sizes, np.maximum(floor, 1e-300)), dtype=np.float64)


def _at_unit_length(columns: Array) -> Array:
    return np.asarray(columns / np.linalg.norm(columns, axis=(0, 1)), dtype=np.float64)


def _flat(columns: Array) -> Array:
    """Columns (S, m, c) as one matrix (S m, c)."""
    samples, drives, count = columns.shape
    return columns.reshape(samples * drives, count)


def _as_if_left_out(columns: Array, residuals: Array) -> Array:
    """Residuals (S, m) that each sample would have if the others alone were fitted; columns are orthonormal."""
    left = np.eye(columns.shape[1]) - np.einsum("smc,snc->smn", columns, columns)
    # a sample that the fit rests on alone says nothing of its error
    left += np.eye(columns.shape[1]) * np.maximum(0.0, LEAST_SPARE - np.linalg.eigvalsh(left)[:, 0])[:, None, None]
    return np.asarray(np.linalg.solve(left, residuals[..., None])[..., 0], dtype=np.float64)


def _larger(root: Array, other: Array) -> Array:
    """A root (c, c) of the larger of two covariances in each of the directions in which both are uncorrelated.

    The one is given by its root, lower triangular, the other (c, c) as it is.  What hardly shows by itself may show
    well together with others: errors that are scaled one by one would put these out of reach.
    """
    half = linalg.solve_triangular(root, other, lower=True)
    ratios, directions = linalg.eigh(linalg.solve_triangular(root, half.T, lower=True))
    return np.asarray(root @ directions * np.sqrt(np.maximum(1.0, ratios)), dtype=np.float64)


def _of_neighbours(scores: Array) -> Array:
    """The sum (c, c) of products of scores (S, c), those of neighbours in time included."""
    middle = scores.T @ scores
    for lag in range(1, min(NEIGHBOURS, len(scores) - 1) + 1):
        moved = scores[lag:].T @ scores[:-lag] * (1 - lag / (NEIGHBOURS + 1))
        middle = middle + moved + moved.T
    return np.asarray(middle, dtype=np.float64)
