"""The published formulas (27) and (28): N_B from (B B^T)^-1, M~^+ from delta columns of M~ chosen anew at every state.

The switching of Sec. 5.4 is arithmetic: the weight of a choice is (1 + sign(d - d')) / 2, so that the columns of the
choice with the largest det M~_1^T M~_1 are the ones that count, without a branch.  Without switching one choice is used
everywhere: the formula as it stands in the paper, singular where its columns become dependent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import TypeAlias

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import Cholesky, diagonal_sizes
from symgen.linear_algebra.exterior import square, unit, wedge_all
from symgen.linear_algebra.guards import Guard
from symgen.mechanics.genericity import configurations
from symgen.methods.admission import OfInputs
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.system import MethodInput
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matvec
from symgen.symbolic.scalar import Scalar

Projection: TypeAlias = Callable[[Vector], Vector]
# Choices of inputs up to which the method `printed` is made of them.
MOST_PARTITIONS = 20


def printed_candidate(system: MethodInput, fixed: Sequence[int] | None = None) -> Candidate | str:
    """u by (27) and (28); `fixed` names the inputs of M~_1 and takes the switching away."""
    reason = system.driven or system.regular
    if reason is not None:
        return reason
    mechanics, generic = system.mechanics, system.generic
    graph, m, delta = mechanics.graph, generic.m, generic.delta
    choices = list(combinations(range(m), delta)) if fixed is None else [tuple(fixed)]
    if len(choices) > MOST_PARTITIONS:
        return f"there are {len(choices)} choices of inputs"
    project, guards = _projection(graph, mechanics.constraint_jacobian)
    columns = [project(column) for column in mechanics.inputs]
    force = project(mechanics.balance)
    orders = [(*J, *(k for k in range(m) if k not in J)) for J in choices]
    weights, largest = _weights(graph, [_determinant(graph, columns, J) for J in choices])
    ordered = [_mixed(graph, weights, [columns[order[place]] for order in orders]) for place in range(m)]
    # a projected column is no longer than the column itself
    squares = [dot(graph, column, column) for column in mechanics.inputs]
    chosen = [graph.sum(w * squares[order[k]] for w, order in zip(weights, orders, strict=True)) for k in range(delta)]
    values, own = _inverse(graph, ordered[:delta], ordered[delta:], force, chosen)
    u = [graph.zero] * m
    for weight, order in zip(weights, orders, strict=True):
        for place, k in enumerate(order):
            u[k] = u[k] + weight * values[place]
    scale = graph.sum(graph.product(squares[k] for k in J) for J in choices)
    rank = (Guard(Status.ACTUATION_RANK, largest, 2, guards, scale, delta),) if m > delta else ()
    kept = (*guards, *rank, *own)
    return solved_for_u(system, u, kept)


def fixed_candidate(system: MethodInput) -> Candidate | str:
    """The same without switching: with the choice of inputs that is best at the configuration of the file.

    It fails at regular states, where the inputs that are chosen no longer span the motions.
    """
    reason = system.driven or system.regular
    if reason is not None:
        return reason
    mechanics, generic = system.mechanics, system.generic
    choices = list(combinations(range(generic.m), generic.delta))
    if len(choices) == 1:
        return "there is one choice of inputs, which `printed` takes"
    if len(choices) > MOST_PARTITIONS:
        return f"there are {len(choices)} choices of inputs"
    project, _ = _projection(mechanics.graph, mechanics.constraint_jacobian)
    columns = [project(column) for column in mechanics.inputs]
    sizes = Evaluator([_determinant(mechanics.graph, columns, chosen) for chosen in choices])
    start = configurations(mechanics)[0]
    return printed_candidate(system, max(zip(sizes(start), choices, strict=True))[1])


def _projection(graph: Graph, b: Matrix) -> tuple[Projection, tuple[Guard, ...]]:
    """x -> x - B^T (B B^T)^-1 B x (21)."""
    if not b:
        return lambda x: x, ()
    size = len(b)
    a = tuple(tuple(dot(graph, b[min(i, j)], b[max(i, j)]) for j in range(size)) for i in range(size))
    factor = Cholesky(graph, a, diagonal_sizes(graph, a))

    def project(x: Vector) -> Vector:
        weights = factor.solve(matvec(graph, b, x))
        return tuple(value - dot(graph, [row[i] for row in b], weights) for i, value in enumerate(x))

    guards = tuple(replace(guard, status=Status.CONSTRAINT_RANK) for guard in factor.guards)
    return project, guards


def _determinant(graph: Graph, columns: Sequence[Vector], chosen: Sequence[int]) -> Scalar:
    """det M~_1^T M~_1 as a sum of squared minors: no pivot may vanish in a choice that is not taken."""
    return square(graph, wedge_all(unit(graph), [columns[k] for k in chosen]))


def _weights(graph: Graph, sizes: Sequence[Scalar]) -> tuple[list[Scalar], Scalar]:
    """1 for the largest of the sizes, the last one of equals, 0 for the others; and the largest size."""
    weights, largest = [graph.one], sizes[0]
    for size in sizes[1:]:
        wins = (graph.one + graph.function("copysign", (graph.one, size - largest))) * Fraction(1, 2)
        stays = 1 - wins
        weights = [*(weight * stays for weight in weights), wins]
        largest = wins * size + stays * largest
    return weights, largest


def _mixed(graph: Graph, weights: Sequence[Scalar], vectors: Sequence[Vector]) -> Vector:
    return tuple(
        graph.sum(weight * vector[i] for weight, vector in zip(weights, vectors, strict=True))
        for i in range(len(vectors[0]))
    )


def _inverse(
    graph: Graph, first: Sequence[Vector], second: Sequence[Vector], force: Vector, squares: Sequence[Scalar]
) -> tuple[Vector, tuple[Guard, ...]]:
    """(28): [I; R^T] (I + R R^T)^-1 M~_1^+ force with R = M~_1^+ M~_2; `squares` are the sizes of the first columns."""
    normal = Cholesky(graph, tuple(tuple(dot(graph, x, y) for y in first) for x in first), squares)

    def pseudoinverse(x: Vector) -> Vector:
        return normal.solve([dot(graph, column, x) for column in first])

    part = pseudoinverse(force)
    guards = tuple(replace(guard, status=Status.ACTUATION_RANK) for guard in normal.guards)
    if not second:
        return part, guards
    r = [pseudoinverse(column) for column in second]
    size = len(first)
    units = identity(graph, size)
    a = tuple(
        tuple(units[i][j] + graph.sum(column[i] * column[j] for column in r) for j in range(size)) for i in range(size)
    )
    top = Cholesky(graph, a, diagonal_sizes(graph, a)).solve(part)
    return (*top, *(dot(graph, column, top) for column in r)), guards


PRINTED: Method = OfInputs(lambda workspace: printed_candidate(workspace.fresh()))
PRINTED_FIXED: Method = OfInputs(lambda workspace: fixed_candidate(workspace.fresh()))
