"""Linear algebra at known rank, in ball arithmetic.

No cutoff decides a rank here: ranks are given, every inverse is that of a regular Gram matrix, and the working
precision (256 bits) pays for the squared condition number.  A ball that contains a singular matrix raises
ZeroDivisionError.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from math import hypot
from typing import Any

from flint import arb, arb_mat, ctx


def identity(n: int) -> Any:
    """The n x n identity."""
    matrix = arb_mat(n, n)
    for i in range(n):
        matrix[i, i] = 1
    return matrix


def column(values: Sequence[Any]) -> Any:
    """A column of numbers."""
    return arb_mat(len(values), 1, list(values))


def solve(matrix: Any, right: Any) -> Any:
    """The solution of a regular system; sizes of zero are fine."""
    if matrix.nrows() == 0 or right.ncols() == 0:
        return arb_mat(matrix.nrows(), right.ncols())
    return matrix.solve(right)


def rows_of(matrix: Any, indices: Sequence[int]) -> Any:
    """The rows `indices`."""
    table = matrix.tolist()
    return arb_mat(len(indices), matrix.ncols(), [entry for i in indices for entry in table[i]])


def columns_of(matrix: Any, indices: Sequence[int]) -> Any:
    """The columns `indices`."""
    table = matrix.tolist()
    return arb_mat(matrix.nrows(), len(indices), [row[j] for row in table for j in indices])


def square(matrix: Any) -> Any:
    """Square of the Frobenius norm, as a ball."""
    if matrix.nrows() == 0 or matrix.ncols() == 0:
        return arb(0)
    other = matrix.transpose()
    return (other * matrix if matrix.nrows() > matrix.ncols() else matrix * other).trace()


def norm(matrix: Any) -> float:
    """Frobenius norm, to a float's accuracy."""
    return hypot(*map(float, matrix.entries()))


def determinant(matrix: Any) -> Any:
    """The determinant; 1 for size zero.

    Elimination divides by pivots, and of a singular matrix it knows no digit at any precision; the characteristic
    polynomial, which takes longer, needs no division.
    """
    if not matrix.nrows():
        return arb(1)
    value = matrix.det()
    return sums_of_minors(matrix)[-1] if value.contains(0) else value


def right_pseudoinverse(matrix: Any, rank: int) -> Any:
    """B+ (n x r) of B (r x n) of the given generic rank.

    For rank < r the Cauchy-Binet mean over the row subsets I of that size: B+ = sum_I w_I [B_I+],
    w_I = det(B_I B_I') / sum.  It is smooth near the manifold, and the Moore-Penrose inverse on it.  With e_k the sum
    of the principal minors of size k of A = B B', it is B' times the gradient of e_rank by A, divided by e_rank.
    """
    r, n = matrix.nrows(), matrix.ncols()
    if rank == 0:
        return arb_mat(n, r)
    gram = matrix * matrix.transpose()
    if rank == r:
        return solve(gram, matrix).transpose()
    minors = sums_of_minors(gram)
    *_, gradient = gradients_of_minors(gram, minors, rank)
    check_total(minors[rank])
    return matrix.transpose() * gradient * (1 / minors[rank])


def gradients_of_minors(gram: Any, minors: Sequence[Any], most: int) -> Iterator[Any]:
    """The derivatives of the sums of the principal minors of the sizes from 1 to `most` by the matrix."""
    one = identity(gram.nrows())
    gradient = one
    for size in range(1, most + 1):
        yield gradient
        if size < most:
            gradient = one * minors[size] - gram * gradient


def check_total(total: Any) -> None:
    """ZeroDivisionError where a sum of minors may vanish.

    Rows in units far apart lose digits with the power of their sizes: half of the working precision is to be left.
    """
    if total.rel_accuracy_bits() < ctx.prec // 2:
        raise ZeroDivisionError("the matrix may be of lower rank")


def sums_of_minors(gram: Any) -> list[Any]:
    """The sums of the principal minors of each size from 0 on, as coefficients of the characteristic polynomial."""
    if not gram.nrows():
        return [arb(1)]
    coefficients = list(gram.charpoly())[::-1]
    return [-value if size % 2 else value for size, value in enumerate(coefficients)]


def pseudoinverse(matrix: Any, rank: int) -> Any:
    """The Moore-Penrose inverse (m x n) of an n x m matrix of known rank, by a full-rank factorisation."""
    n, m = matrix.nrows(), matrix.ncols()
    if rank == 0:
        return arb_mat(m, n)
    if rank == m:
        return solve(matrix.transpose() * matrix, matrix.transpose())
    if rank == n:
        return solve(matrix * matrix.transpose(), matrix).transpose()
    basis = columns_of(matrix, independent_columns(matrix, rank))
    left = solve(basis.transpose() * basis, basis.transpose())
    factor = left * matrix
    return factor.transpose() * solve(factor * factor.transpose(), left)


def independent_columns(matrix: Any, rank: int) -> list[int]:
    """`rank` columns by pivoting on the largest remaining one."""
    chosen = sorted(column for _, column in islice(pivots(matrix), rank))
    if len(chosen) < rank:
        raise ZeroDivisionError("the matrix is of lower rank")
    return chosen


def pivots(matrix: Any) -> Iterator[tuple[float, int]]:
    """Columns by what is left of their squares, the largest first (modified Gram-Schmidt on midpoints), down to 0."""
    left = {j: [arb(entry.mid()) for entry in row] for j, row in enumerate(matrix.transpose().tolist())}
    while left:
        squares = {j: sum((x * x for x in c), arb(0)) for j, c in left.items()}
        pivot = max(left, key=lambda j: float(squares[j].mid()))
        if not float(squares[pivot].mid()):
            return
        yield float(squares[pivot].mid()), pivot
        direction = left.pop(pivot)
        for j, other in left.items():
            share = (sum((x * y for x, y in zip(direction, other, strict=True)), arb(0)) / squares[pivot]).mid()
            left[j] = [arb((y - share * x).mid()) for x, y in zip(direction, other, strict=True)]


# The power of two of a row's size below which a pivot does not count.
RANK_NOISE = -100
# The power of two of a row's size above which it counts.
RANK_SIGNAL = -60
# Of rows of ordinary size: what elimination in floats leaves in doubt is far below.
PLAIN_PIVOT = 2.0**-16


def numerical_rank(matrix: Any, noise: int = RANK_NOISE, signal: int = RANK_SIGNAL) -> int | None:
    """Rank of a matrix by its pivots; None when one of them cannot be told (see `independent_rows`)."""
    rows = independent_rows(matrix, noise, signal)
    return None if rows is None else len(rows)


def independent_rows(matrix: Any, noise: int = RANK_NOISE, signal: int = RANK_SIGNAL) -> list[int] | None:
    """Rows that span all of them, by pivots: above 2^signal of a row's size they count, below 2^noise they do not.

    None when a pivot falls between (the point is too close to a singularity to tell).  Where all pivots are so large
    that floats tell them, floats do: of a long chain that takes a hundredth.
    """
    rows = [{j: arb(x.mid()) for j, x in enumerate(row) if x.mid() != 0} for row in matrix.tolist()]
    sizes = [max((float(abs(entry)) for entry in row.values()), default=0.0) for row in rows]
    largest = max(sizes, default=0.0)
    left = {
        i: {j: entry / size for j, entry in row.items()}
        for i, (row, size) in enumerate(zip(rows, sizes, strict=True))
        if size > largest * 2.0**noise
    }
    if (plain := _plainly_independent(left, matrix.ncols())) is not None:
        return plain
    # rows of many machines have few entries: only those that an elimination touches are looked at again
    heads = {i: _largest(row) for i, row in left.items()}
    chosen: list[int] = []
    while left:
        size, i, j = max((size, i, j) for i, (size, j) in heads.items())
        if size < 2.0**noise:
            break
        if size < 2.0**signal:
            return None
        pivot = left.pop(i)
        del heads[i]
        for k, row in left.items():
            if j in row:
                share = row[j] / pivot[j]
                for place, y in pivot.items():
                    row[place] = arb((row.get(place, arb(0)) - share * y).mid())
                heads[k] = _largest(row)
        chosen.append(i)
    return sorted(chosen)


def _plainly_independent(rows: Mapping[int, Mapping[int, Any]], columns: int) -> list[int] | None:
    """As many rows as there are, or as columns, where no pivot is near what rounding leaves; None where one is."""
    left = {i: [float(row[j]) if j in row else 0.0 for j in range(columns)] for i, row in rows.items()}
    heads = {i: _largest_of(row) for i, row in left.items()}
    chosen: list[int] = []
    for _ in range(min(len(left), columns)):
        size, i, j = max((size, i, j) for i, (size, j) in heads.items())
        if not size >= PLAIN_PIVOT:
            return None
        pivot = left.pop(i)
        del heads[i]
        for k, row in left.items():
            if row[j]:
                share = row[j] / pivot[j]
                left[k] = changed = [x - share * y for x, y in zip(row, pivot, strict=True)]
                changed[j] = 0.0
                heads[k] = _largest_of(changed)
        chosen.append(i)
    return sorted(chosen)


def _largest_of(row: Sequence[float]) -> tuple[float, int]:
    """The size of the largest number, and where it stands."""
    size = max(map(abs, row))
    return size, next((j for j, x in enumerate(row) if abs(x) == size), 0)


def _largest(row: Mapping[int, Any]) -> tuple[float, int]:
    """The size of the largest entry, and where it stands."""
    return max(((float(abs(entry).mid()), j) for j, entry in row.items()), default=(0.0, 0))
