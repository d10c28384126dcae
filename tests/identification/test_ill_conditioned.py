"""Standard errors of columns that are nearly alike, against 50 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import numpy.typing as npt
import pytest

from symgen.identification.estimates.inverse_root import inverse_root
from symgen.identification.estimates.least_squares import estimated
from symgen.identification.estimates.observations import Observations

Array = npt.NDArray[np.float64]
# Powers of the time; condition numbers of the columns are 1e4, 4e5 and 1e7.
POWERS = (7, 9, 11)
SAMPLES = 400


def powers(count: int) -> Array:
    """The columns 1, t, t^2, ... in units that are far apart."""
    t = np.arange(1, SAMPLES + 1) / SAMPLES
    return np.asarray(np.power(t[:, None], np.arange(count)) * 10.0 ** (3 * (np.arange(count) % 3) - 3))


def exact_inverse(columns: Array) -> mpmath.matrix:
    """(A^T A)^-1 in 50 digits, of the columns as they are."""
    with mpmath.workdps(50):
        matrix = mpmath.matrix(columns.tolist())
        return (matrix.T * matrix) ** -1


def off(values: Array, exact: Array) -> float:
    return float(np.max(np.abs(values / exact - 1)))


@pytest.mark.parametrize("count", POWERS)
def test_a_root_keeps_the_digits_that_normal_equations_lose(count: int) -> None:
    """Variances: off by as much as rounding times the condition number, and not times its square."""
    columns = powers(count)
    exact = np.array([float(x) for x in np.diag(np.array(exact_inverse(columns).tolist()))])
    unit = columns / np.linalg.norm(columns, axis=0)
    condition = np.linalg.cond(unit)
    variances = np.sum(inverse_root(columns) ** 2, axis=1)
    rounding = np.finfo(float).eps * condition
    assert off(variances, exact) < 10 * rounding
    # of columns at unit length, too, the normal equations lose all of that twice
    normal = np.diag(np.linalg.pinv(unit.T @ unit)) / np.sum(columns**2, axis=0)
    assert off(normal, exact) > 100 * off(variances, exact)


@pytest.mark.parametrize("count", POWERS)
def test_standard_errors_of_nearly_equal_columns(count: int) -> None:
    """Noise of one size and alternating signs: all samples count in full, and neighbours make no error larger."""
    columns = powers(count)
    noise = np.where(np.arange(SAMPLES) % 2, 0.01, -0.01)
    inputs = np.sum(columns, axis=1) + noise
    blank = np.zeros((SAMPLES, 1))
    made = estimated(
        Observations(np.arange(SAMPLES) / SAMPLES, inputs[:, None], blank, columns[:, None, :], blank[0], blank[0], 1)
    )
    with mpmath.workdps(50):
        matrix, right = mpmath.matrix(columns.tolist()), mpmath.matrix(inputs.tolist())
        inverse = exact_inverse(columns)
        left = right - matrix * (inverse * (matrix.T * right))
        variance = sum(x * x for x in left) / (SAMPLES - count)
        exact = np.array([float(mpmath.sqrt(variance * inverse[k, k])) for k in range(count)])
    assert made.open_columns == ()
    assert made.outliers == 0
    rounding = np.finfo(float).eps * np.linalg.cond(columns / np.linalg.norm(columns, axis=0))
    assert off(made.errors, exact) < 10 * rounding
    assert made.condition == pytest.approx(np.linalg.cond(columns / np.linalg.norm(columns, axis=0)), rel=1e-6)


def test_combinations_that_columns_do_not_show_have_no_part() -> None:
    """A column twice: what both make together is known as it is of one, what they differ by not at all."""
    t = np.linspace(-1, 1, 21)
    root = inverse_root(np.stack([t, 1e6 * t, t**2], axis=-1))
    together = np.array([0.5, 5e5, 0.0])
    assert np.linalg.norm(together @ root) == pytest.approx(0.5 / np.linalg.norm(t))
    assert np.linalg.norm(np.array([1.0, -1e6, 0.0]) @ root) < 1e-9
