"""What G changes by along coordinates and what follows from it by Christoffel symbols: C, and C q_dot.

C q_dot takes each symbol once for a pair of rates, and only those that may not be 0.  C has the symbols of whole rows,
and what momenta change by in place of them: where much moves together that is far shorter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from symgen.symbolic.calculus import derivative_along, jacobian
from symgen.symbolic.graph import Graph
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached

# The entries of dG/dq^k that are not zero, by row and column, i <= j.
Slopes: TypeAlias = Mapping[tuple[int, int], Scalar]


def slopes_of(graph: Graph, mass_matrix: Matrix, q: Vector) -> tuple[Slopes, ...]:
    """Those of G for every coordinate; rows of many machines have few."""
    n = len(q)
    upper = {(i, j): x for i in range(n) for j in range(i, n) if (x := mass_matrix[i][j]).op != "const"}
    moved: dict[Scalar, list[tuple[int, int]]] = {}
    for place, entry in upper.items():
        for node in reached([entry]):
            if node.op == "symbol":
                moved.setdefault(node, []).append(place)
    slopes = []
    for coordinate in q:
        places = moved.get(coordinate, [])
        rates = derivative_along(graph, [upper[place] for place in places], {coordinate: graph.one})
        entries = without_hidden_zeros(rates)
        slopes.append({place: x for place, x in zip(places, entries, strict=True) if not x.is_zero})
    return tuple(slopes)


def with_zeros(graph: Graph, slopes: Sequence[Slopes], n: int) -> tuple[Matrix, ...]:
    """dG/dq^k (n x n) for every k."""
    zeros = (graph.zero,) * n
    gradients = []
    for one in slopes:
        rows = {i: list(zeros) for place in one for i in place}
        for (i, j), slope in one.items():
            rows[i][j] = rows[j][i] = slope
        gradients.append(tuple(tuple(rows[i]) if i in rows else zeros for i in range(n)))
    return tuple(gradients)


def by_christoffel_symbols(graph: Graph, d: Sequence[Matrix], velocity: Vector) -> Matrix:
    """C (n x n) from d_k G: 1/2 sum_k (d_k G_ij + d_j G_ik - d_i G_jk) v_k, so that G_dot - 2 C is skew."""
    n = len(velocity)
    symmetric = [[dot(graph, [d[k][i][j] for k in range(n)], velocity) for j in range(n)] for i in range(n)]
    gyroscopic = [[dot(graph, [d[j][i][k] for k in range(n)], velocity) for j in range(n)] for i in range(n)]
    half = graph.const(1) / 2
    return tuple(
        tuple((symmetric[i][j] + (gyroscopic[i][j] - gyroscopic[j][i])) * half for j in range(n)) for i in range(n)
    )


def by_momenta(graph: Graph, q: Vector, qd: Vector, mass_matrix: Matrix, momentum: Vector) -> Matrix:
    """The same along q_dot, 1/2 (G_dot + dp/dq - (dp/dq)^T) with p = G q_dot (n): the n^2 slopes of p are the sums
    over k of the n^3 of G."""
    n, half = len(q), graph.const(1) / 2
    upper = [(i, j) for i in range(n) for j in range(i, n)]
    rates = derivative_along(graph, [mass_matrix[i][j] for i, j in upper], dict(zip(q, qd, strict=True)))
    moved = dict(zip(upper, rates, strict=True))
    slopes = jacobian(graph, momentum, q)
    return tuple(
        tuple((moved[min(i, j), max(i, j)] + (slopes[i][j] - slopes[j][i])) * half for j in range(n)) for i in range(n)
    )


def by_products_of_rates(
    graph: Graph, qd: Vector, gradient: Sequence[Matrix], slopes: Sequence[Slopes]
) -> list[Scalar]:
    """The forces (n) of the rates, from dG/dq^k for every k, whose entries that are not zero are `slopes`."""
    half, forces = graph.const(1) / 2, list[Scalar]()
    for i, pairs in enumerate(_pairs_of_rates(len(qd), slopes)):
        total = graph.zero
        for j, k in pairs:
            christoffel = gradient[k][i][j] + gradient[j][i][k] - gradient[i][j][k]
            weight = half if j == k else graph.one
            total = total + christoffel * weight * (qd[j] * qd[k])
        forces.append(total)
    return forces


def _pairs_of_rates(n: int, slopes: Sequence[Slopes]) -> list[list[tuple[int, int]]]:
    """For every i the pairs j <= k of rates that may load it."""
    pairs: list[set[tuple[int, int]]] = [set() for _ in range(n)]
    for k, places in enumerate(slopes):
        for i, j in places:
            pairs[k].add((i, j))
            pairs[i].add((min(j, k), max(j, k)))
            pairs[j].add((min(i, k), max(i, k)))
    return [sorted(these) for these in pairs]
