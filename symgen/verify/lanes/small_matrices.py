"""Small matrices at many states at once, in float64, with the same bits on every machine.

A library of linear algebra has other kernels for other processors, which add in another order; where Newton's method
goes from there is another state.  These are sums and products of whole lanes.
"""

from __future__ import annotations

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes


def times(matrices: Lanes, vectors: Lanes) -> Lanes:
    """Matrices (r x n) by vectors, state by state."""
    return (matrices * vectors[:, None, :]).sum(axis=2)


def products(left: Lanes, right: Lanes) -> Lanes:
    """Matrices (r x n) by matrices (n x m)."""
    made = np.zeros((len(left), left.shape[1], right.shape[2]))
    for k in range(left.shape[2]):
        made += left[:, :, k, None] * right[:, k, None, :]
    return made


def inverses(grams: Lanes) -> Lanes:
    """Of symmetric positive definite matrices, in place of them one row after the other (Golub and Van Loan, Matrix
    Computations, 4th ed., section 4.2: no other order of rows is needed)."""
    made = grams.copy()
    for k in range(grams.shape[1]):
        pivot = made[:, k, k].copy()
        row, column = made[:, k] / pivot[:, None], made[:, :, k].copy()
        made -= column[:, :, None] * row[:, None, :]
        made[:, k], made[:, :, k], made[:, k, k] = row, -column / pivot[:, None], 1 / pivot
    return made


def pseudoinverses(rows: Lanes, least: float) -> Lanes:
    """Those (n x r) of rows, where what is shorter than the `least` share of the longest row depends on the others.

    By two decompositions (Golub and Van Loan, section 5.5): rows are combinations of directions at right angles, the
    longest rest of a row giving the next one, and these combinations are decomposed in the same way.
    """
    combinations, directions = _longest_first(rows, least)
    across, factors = _columns(combinations)
    made = np.swapaxes(across, 1, 2).copy()
    for k in reversed(range(made.shape[1])):
        made[:, k] = (made[:, k] - times(np.swapaxes(made[:, k + 1 :], 1, 2), factors[:, k, k + 1 :])) / factors[
            :, k, k, None
        ]
    return products(np.swapaxes(directions, 1, 2), made)


def _longest_first(rows: Lanes, least: float) -> tuple[Lanes, Lanes]:
    """Combinations (r x k) and directions (k x n) at right angles, both 0 from where rows depend on those before."""
    count, r, n = rows.shape
    most = min(r, n)
    combinations, directions = np.zeros((count, r, most)), np.zeros((count, most, n))
    rest, states, longest = rows.copy(), np.arange(count), np.zeros(count)
    for k in range(most):
        squares = (rest * rest).sum(axis=2)
        place = squares.argmax(axis=1)
        size = np.sqrt(squares[states, place])
        longest = np.maximum(longest, size)
        independent = size > least * longest
        if not independent.any():
            break
        along = _unit(rest[states, place], independent)
        # what rounding leaves along those before it
        along = _unit(along - times(np.swapaxes(directions[:, :k], 1, 2), times(directions[:, :k], along)), independent)
        shares = times(rest, along)
        rest -= shares[:, :, None] * along[:, None, :]
        combinations[:, :, k], directions[:, k] = shares, along
    return combinations, directions


def _columns(matrices: Lanes) -> tuple[Lanes, Lanes]:
    """Columns at right angles (r x k) and the factors (k x k) that make the matrices of them, right of the diagonal;
    columns of 0 stay, with a factor of 1."""
    columns = matrices.copy()
    k = columns.shape[2]
    factors = np.broadcast_to(np.eye(k), (len(columns), k, k)).copy()
    for j in range(k):
        size = np.sqrt((columns[:, :, j] * columns[:, :, j]).sum(axis=1))
        columns[:, :, j] = _unit(columns[:, :, j], size > 0)
        factors[:, j, j] = np.where(size > 0, size, 1.0)
        shares = times(np.swapaxes(columns[:, :, j + 1 :], 1, 2), columns[:, :, j])
        columns[:, :, j + 1 :] -= columns[:, :, j, None] * shares[:, None, :]
        factors[:, j, j + 1 :] = shares
    return columns, factors


def _unit(vectors: Lanes, which: Lanes) -> Lanes:
    """Of length 1, and 0 elsewhere."""
    sizes = np.sqrt((vectors * vectors).sum(axis=1))
    good = which & (sizes > 0)
    return np.where(good[:, None], vectors / np.where(good, sizes, 1.0)[:, None], 0.0)
