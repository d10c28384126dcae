"""Linear algebra over the field of fractions: products, determinants, solutions and null spaces of small matrices."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from symgen.closedform.algebra.quotient import Matrix, Quotient, polynomial
from symgen.closedform.algebra.ring import TrigRing


def zero(ring: TrigRing) -> Quotient:
    """The fraction 0."""
    return polynomial(ring, ring.zero)


def one(ring: TrigRing) -> Quotient:
    """The fraction 1."""
    return polynomial(ring, ring.one)


def dot(ring: TrigRing, left: Sequence[Quotient], right: Sequence[Quotient]) -> Quotient:
    """The sum of products of two equally long rows."""
    total = zero(ring)
    for a, b in zip(left, right, strict=True):
        if a and b:
            total = total + a * b
    return total


def transpose(matrix: Matrix) -> Matrix:
    """The transpose of a matrix with at least one row."""
    return tuple(zip(*matrix, strict=True))


def multiply(ring: TrigRing, left: Matrix, right: Matrix) -> Matrix:
    """The matrix product; `right` has at least one row."""
    columns = transpose(right)
    return tuple(tuple(dot(ring, row, column) for column in columns) for row in left)


def add(left: Matrix, right: Matrix) -> Matrix:
    """The sum of two matrices of the same shape."""
    return tuple(tuple(a + b for a, b in zip(u, v, strict=True)) for u, v in zip(left, right, strict=True))


def identity(ring: TrigRing, size: int) -> Matrix:
    """The unit matrix."""
    return tuple(tuple(one(ring) if i == j else zero(ring) for j in range(size)) for i in range(size))


def column(vector: Sequence[Quotient]) -> Matrix:
    """A vector as a matrix with one column."""
    return tuple((entry,) for entry in vector)


def reduce_rows(matrix: Matrix) -> tuple[list[list[Quotient]], list[int]]:
    """The reduced row echelon form (without zero rows) and its pivot columns; the shortest entry is the pivot."""
    rows = [list(row) for row in matrix]
    pivots: list[int] = []
    width = len(rows[0]) if rows else 0
    done = 0
    for j in range(width):
        candidates = [i for i in range(done, len(rows)) if rows[i][j]]
        if not candidates:
            continue
        best = min(candidates, key=lambda i: (len(rows[i][j].numerator) + len(rows[i][j].denominator), i))
        rows[done], rows[best] = rows[best], rows[done]
        pivot = rows[done][j]
        rows[done] = [entry / pivot if entry else entry for entry in rows[done]]
        for i in range(len(rows)):
            if i != done and rows[i][j]:
                factor = rows[i][j]
                rows[i] = [a - factor * b if b else a for a, b in zip(rows[i], rows[done], strict=True)]
        pivots.append(j)
        done += 1
        if done == len(rows):
            break
    return rows[:done], pivots


def null_space(ring: TrigRing, matrix: Matrix, width: int) -> Matrix:
    """A basis of the kernel, one vector per row of the result; `width` is the number of columns."""
    if not matrix:
        return identity(ring, width)
    rows, pivots = reduce_rows(matrix)
    basis = []
    for free in (j for j in range(width) if j not in pivots):
        vector = [zero(ring)] * width
        vector[free] = one(ring)
        for row, pivot in zip(rows, pivots, strict=True):
            vector[pivot] = -row[free]
        basis.append(tuple(vector))
    return tuple(basis)


def solve(matrix: Matrix, right: Matrix) -> Matrix | None:
    """The solution X of matrix X = right, None when there is no unique one."""
    size = len(matrix[0])
    joined = tuple((*a, *b) for a, b in zip(matrix, right, strict=True))
    rows, pivots = reduce_rows(joined)
    if pivots != list(range(size)):
        return None
    return tuple(tuple(row[size:]) for row in rows)


def determinant(ring: TrigRing, matrix: Matrix) -> Quotient:
    """The determinant by Laplace expansion with shared minors (1 for the empty matrix)."""
    size = len(matrix)
    known: dict[tuple[int, ...], Quotient] = {(): one(ring)}
    for k in range(1, size + 1):
        level: dict[tuple[int, ...], Quotient] = {}
        for columns in combinations(range(size), k):
            total = zero(ring)
            for place, j in enumerate(columns):
                entry, minor = matrix[k - 1][j], known[columns[:place] + columns[place + 1 :]]
                if entry and minor:
                    term = entry * minor
                    total = total + (term if (k - 1 + place) % 2 == 0 else -term)
            level[columns] = total
        known = level
    return known[tuple(range(size))]
