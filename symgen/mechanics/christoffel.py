"""C q_dot by products of rates: each Christoffel symbol once for a pair of rates, and only those that may not be 0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from symgen.symbolic.matrix import Matrix, Vector
from symgen.symbolic.scalar import Graph, Scalar


def by_products_of_rates(
    graph: Graph, qd: Vector, gradient: Sequence[Matrix], slopes: Sequence[Mapping[tuple[int, int], Scalar]]
) -> list[Scalar]:
    """The forces (n) of the rates, from dG/dq^k for every k, whose entries that are not zero (i <= j) are `slopes`."""
    half, forces = graph.const(1) / 2, list[Scalar]()
    for i, pairs in enumerate(_pairs_of_rates(len(qd), slopes)):
        total = graph.zero
        for j, k in pairs:
            christoffel = gradient[k][i][j] + gradient[j][i][k] - gradient[i][j][k]
            weight = half if j == k else graph.one
            total = total + christoffel * weight * (qd[j] * qd[k])
        forces.append(total)
    return forces


def _pairs_of_rates(n: int, slopes: Sequence[Mapping[tuple[int, int], Scalar]]) -> list[list[tuple[int, int]]]:
    """For every i the pairs j <= k of rates that may load it."""
    pairs: list[set[tuple[int, int]]] = [set() for _ in range(n)]
    for k, places in enumerate(slopes):
        for i, j in places:
            pairs[k].add((i, j))
            pairs[i].add((min(j, k), max(j, k)))
            pairs[j].add((min(i, k), max(i, k)))
    return [sorted(these) for these in pairs]
