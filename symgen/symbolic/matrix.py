"""Small dense matrices of scalars as tuples of rows; zeros cost nothing because the constructors drop them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

Vector: TypeAlias = tuple[Scalar, ...]
Matrix: TypeAlias = tuple[Vector, ...]


def dot(graph: Graph, a: Sequence[Scalar], b: Sequence[Scalar]) -> Scalar:
    """Inner product."""
    return graph.sum(x * y for x, y in zip(a, b, strict=True) if not (x.is_zero or y.is_zero))


def transpose(a: Matrix, columns: int) -> Matrix:
    """Transposed matrix; `columns` is needed when there are no rows."""
    return tuple(tuple(row[j] for row in a) for j in range(columns))


def matvec(graph: Graph, a: Matrix, x: Sequence[Scalar]) -> Vector:
    """A x."""
    return tuple(dot(graph, row, x) for row in a)


def matmul(graph: Graph, a: Matrix, b: Matrix, columns: int) -> Matrix:
    """A B, where B has `columns` columns."""
    bt = transpose(b, columns)
    return tuple(tuple(dot(graph, row, column) for column in bt) for row in a)


def add(a: Matrix, b: Matrix) -> Matrix:
    """A + B."""
    return tuple(tuple(x + y for x, y in zip(p, q, strict=True)) for p, q in zip(a, b, strict=True))


def subtract(a: Matrix, b: Matrix) -> Matrix:
    """A - B."""
    return tuple(tuple(x - y for x, y in zip(p, q, strict=True)) for p, q in zip(a, b, strict=True))


def subtract_vectors(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return tuple(x - y for x, y in zip(a, b, strict=True))


def scale(a: Matrix, factor: Scalar) -> Matrix:
    """factor * A."""
    return tuple(tuple(x * factor for x in row) for row in a)


def identity(graph: Graph, n: int) -> Matrix:
    """I_n."""
    return tuple(tuple(graph.one if i == j else graph.zero for j in range(n)) for i in range(n))


def flatten(a: Matrix) -> Vector:
    """Row-major entries."""
    return tuple(x for row in a for x in row)
