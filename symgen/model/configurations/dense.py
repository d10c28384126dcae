"""Small dense linear algebra in floats or other real numbers, for checks that must not import a numerical library."""

from __future__ import annotations

import math
from operator import mul
from typing import TypeAlias

Rows: TypeAlias = list[list[float]]

# What is nothing beside 1.
RELATIVE = 1e-9

def rank(rows: Rows, relative: float = RELATIVE) -> int:
    """The rank by elimination, of the rows scaled to norm one."""
    return pivots(_unit_rows(rows), relative)


def pivots(work: Rows, least: float) -> int:
    """How many pivots are larger than `least`, by elimination with complete pivoting, which overwrites the rows."""
    pivot_count = 0
    columns = list(range(len(work[0]))) if work else []
    while work and columns:
        size, pivot_row, pivot_column = max((abs(row[c]), i, c) for i, row in enumerate(work) for c in columns)
        if size <= least:
            break
        pivot = work.pop(pivot_row)
        columns.remove(pivot_column)
        for row in work:
            if not row[pivot_column]:
                continue
            factor = row[pivot_column] / pivot[pivot_column]
            for column in columns:
                row[column] -= factor * pivot[column]
        pivot_count += 1
    return pivot_count


def null_space(rows: Rows, n: int, relative: float = RELATIVE) -> Rows:
    """An orthonormal basis of the vectors x with rows x = 0, by Gram-Schmidt, each twice."""
    basis: Rows = []
    for row in _unit_rows(rows):
        _extend(basis, row, relative)
    constrained = len(basis)
    for index in range(n):
        unit = [0.0] * n
        unit[index] = 1.0
        # A unit vector may lie close to the span of the others; all n of them together span the rest.
        if len(basis) < n:
            _extend(basis, unit, 0.5 / math.sqrt(n))
    return basis[constrained:]


def is_positive(matrix: Rows, relative: float = RELATIVE) -> tuple[bool, bool]:
    """Whether a symmetric matrix is positive semidefinite, and whether it is positive definite.

    By pivots on the diagonal, of the matrix scaled to ones there, so that units do not matter.
    """
    n = len(matrix)
    scale = [root(matrix[i][i]) if matrix[i][i] > 0 else 0.0 for i in range(n)]
    largest = max((abs(value) for row in matrix for value in row), default=0.0)
    for i in range(n):
        if scale[i] == 0 and any(abs(value) > relative * largest for value in matrix[i]):
            return False, False
    left = [i for i in range(n) if scale[i] > 0]
    definite = len(left) == n
    work = [
        [matrix[i][j] / (scale[i] * scale[j]) if scale[i] and scale[j] else 0.0 for j in range(n)] for i in range(n)
    ]
    while left:
        pivot = max(left, key=lambda i: work[i][i])
        if any(work[i][i] < -relative for i in left):
            return False, False
        if work[pivot][pivot] <= relative:
            return all(abs(work[i][j]) <= math.sqrt(relative) for i in left for j in left), False
        left.remove(pivot)
        for i in left:
            factor = work[i][pivot] / work[pivot][pivot]
            for j in left:
                work[i][j] -= factor * work[pivot][j]
    return True, definite


def _unit_rows(rows: Rows) -> Rows:
    """The rows scaled to norm one."""
    return [[value / norm for value in row] for row in rows if (norm := root(sum(v * v for v in row))) > 0]


def _extend(basis: Rows, vector: list[float], relative: float) -> None:
    for _ in range(2):
        for unit in basis:
            along = sum(map(mul, unit, vector))
            if along:
                vector = [a - along * b for a, b in zip(vector, unit, strict=True)]
    norm = root(sum(a * a for a in vector))
    if norm > relative:
        basis.append([a / norm for a in vector])


def root(x: float) -> float:
    """The square root in the kind of numbers that x is."""
    return math.sqrt(x) if isinstance(x, (float, int)) else x**0.5
