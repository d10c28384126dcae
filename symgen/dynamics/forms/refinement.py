"""One step of iterative refinement: what the equations of motion still ask for is solved for once more.

After it the error is that of a solution of equations whose every entry was changed by a few eps, in working precision
(Skeel 1980; Higham, Accuracy and Stability of Numerical Algorithms, 12.2): rows and masses of very different size cost
nothing any more, whatever the method lost beside the large ones.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from symgen.dynamics.forms.motion import Problem
from symgen.graph.matrix import Vector, dot
from symgen.graph.scalar import Graph

Solution: TypeAlias = tuple[Vector, Vector]  # q_ddot and lambda


def refined(problem: Problem, solution: Solution, solve: Callable[[Vector, Vector], Solution]) -> Solution:
    """A better q_ddot and lambda; `solve` gives those of G q_ddot + B^T lambda = f, B q_ddot = c for any f and c."""
    first = _rounded(problem.graph, solution)
    # exactly, the sum of both is the solution again
    further = _rounded(problem.graph, solve(*_left_over(problem, *first)))
    return _sum(first[0], further[0]), _sum(first[1], further[1])


def _left_over(problem: Problem, q_ddot: Vector, multipliers: Vector) -> Solution:
    """f - G q_ddot - B^T lambda and -a - B q_ddot, for numbers that have been computed."""
    graph, rows = problem.graph, problem.rows
    forces = tuple(
        f - dot(graph, g, q_ddot) - graph.sum(row[i] * x for row, x in zip(rows, multipliers, strict=True))
        for i, (f, g) in enumerate(zip(problem.force, problem.mass_matrix, strict=True))
    )
    rates = tuple(-a - dot(graph, row, q_ddot) for row, a in zip(rows, problem.bias, strict=True))
    return forces, rates


def _rounded(graph: Graph, solution: Solution) -> Solution:
    q_ddot, multipliers = solution
    return tuple(map(graph.rounded, q_ddot)), tuple(map(graph.rounded, multipliers))


def _sum(a: Vector, b: Vector) -> Vector:
    return tuple(x + y for x, y in zip(a, b, strict=True))
