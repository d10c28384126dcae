"""The Pareto front: what nothing else beats in both cost and error."""

from __future__ import annotations

from collections.abc import Sequence


def pareto_front(points: Sequence[tuple[float, float]]) -> tuple[int, ...]:
    """Indices of the points (cost, error) that no other point dominates, by rising cost.

    A point dominates another when it is no worse in both and better in one; of equal points the first counts.
    """
    front: list[int] = []
    best = float("inf")
    for index in sorted(range(len(points)), key=lambda k: (*points[k], k)):
        if points[index][1] < best:
            front.append(index)
            best = points[index][1]
    return tuple(front)
