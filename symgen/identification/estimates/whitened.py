"""Estimates in units of what they are known to, and how far what a log does not show is held by the file."""

from __future__ import annotations

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.estimates.inverse_root import inverse_root
from symgen.identification.estimates.least_squares import LinearEstimate
from symgen.model.model import Parameter

# The standard deviation of a parameter before the log, as a share of its value.
HELD_BY = 1.0
# That of one which is 0, where the file has no range of it.
HELD_AT_ZERO = 1.0


def whitening(estimate: LinearEstimate) -> Array:
    """The matrix (c, c) that takes errors of the determined columns to standard deviations of 1."""
    closed = estimate.closed_columns
    # what has no error at all says nothing
    return inverse_root(estimate.root[np.ix_(closed, closed)].T).T


def deviation_before(parameter: Parameter, value: float) -> float:
    """The standard deviation of a parameter before the log."""
    if value:
        return HELD_BY * abs(value)
    return float(parameter.range[1] - parameter.range[0]) / 2 if parameter.range else HELD_AT_ZERO
