"""One step of iterative refinement: what equations still ask for is solved for once more.

After it the error is that of a solution of equations whose every entry was changed by a few eps, in working precision
(Skeel 1980; Higham, Accuracy and Stability of Numerical Algorithms, 12.2): rows and masses of very different size cost
nothing any more, whatever the method lost beside the large ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, matvec, subtract_vectors
from symgen.symbolic.scalar import Scalar

Solution: TypeAlias = tuple[Vector, Vector]  # accelerations, or what is solved for in their place, and lambda


def refined(graph: Graph, solution: Solution, left_over: Callable[[Vector, Vector], Solution],
            solve: Callable[[Vector, Vector], Solution]) -> Solution:
    """A better solution; `left_over` tells what is missing of both right-hand sides, `solve` solves for it."""
    first = _rounded(graph, solution)
    # exactly, the sum of both is the solution again
    further = _rounded(graph, solve(*left_over(*first)))
    return _sum(first[0], further[0]), _sum(first[1], further[1])


def of_motion(graph: Graph, mass_matrix: Matrix, rows: Matrix, f: Vector, c: Vector) -> Callable[..., Solution]:
    """f - G q_ddot - B^T lambda, c - B q_ddot."""

    def left_over(q_ddot: Vector, multipliers: Vector) -> Solution:
        inertial = matvec(graph, mass_matrix, q_ddot)
        return subtract_vectors(less_forces(graph, f, rows, multipliers), inertial), missing(graph, rows, c, q_ddot)

    return left_over


def of_columns(
    graph: Graph, columns: Sequence[Vector], weights: Sequence[Scalar], b: Vector, c: Vector
) -> Callable[..., Solution]:
    """b - x - A l, c - A^T W x."""

    def left_over(x: Vector, multipliers: Vector) -> Solution:
        weighted = tuple(entry * weight for entry, weight in zip(x, weights, strict=True))
        return subtract_vectors(less_forces(graph, b, columns, multipliers), x), missing(graph, columns, c, weighted)

    return left_over


def less_forces(graph: Graph, f: Vector, rows: Sequence[Vector], multipliers: Vector) -> Vector:
    """f - B^T lambda."""
    return tuple(
        entry - graph.sum(row[i] * factor for row, factor in zip(rows, multipliers, strict=True))
        for i, entry in enumerate(f)
    )


def missing(graph: Graph, rows: Sequence[Vector], c: Vector, x: Vector) -> Vector:
    """c - B x."""
    return tuple(entry - dot(graph, row, x) for row, entry in zip(rows, c, strict=True))


def _rounded(graph: Graph, solution: Solution) -> Solution:
    x, multipliers = solution
    return tuple(map(graph.rounded, x)), tuple(map(graph.rounded, multipliers))


def _sum(a: Vector, b: Vector) -> Vector:
    return tuple(x + y for x, y in zip(a, b, strict=True))
