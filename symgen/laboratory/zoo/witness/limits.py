"""Limits of inputs along several directions of internal force: conditions of least distance, for one set after another.

On a set of limits that are reached the nearest inputs satisfy W (u - u_0) = A^T a + E^T b, A u = A u_0, E u = limits.
A set that is not yet all that the nearest inputs reach leads to inputs beyond one of the limits that they reach, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

from symgen.laboratory.zoo.witness.numbers.linear import Matrix, Vector, solve

# Times what is missing of limits, in the weights: inputs for which others are moved by more take no part.
MOST_MOVED = 1e4
Limits: TypeAlias = Sequence[tuple[int, Any, Any]]
"""The number of an input, its lower and its upper limit."""


class NoInputsError(Exception):
    """No inputs within their limits produce the motion."""


def nearest_within(
    projected: Matrix, u: Vector, weights: Sequence[Any], limits: Limits, directions: int
) -> Vector:
    """The inputs nearest to u that do what u does within limits.  Raises NoInputsError."""
    kept: list[tuple[float, Vector]] = []
    left: list[frozenset[tuple[int, bool]]] = [frozenset()]
    known = set(left)
    by_input = {k: (lower, upper) for k, lower, upper in limits}
    while left:
        reached = left.pop()
        inputs = _reaching(projected, u, weights, [(k, by_input[k][above]) for k, above in sorted(reached)])
        if inputs is None:
            continue
        held = {k for k, _ in reached}
        beyond = [
            (k, bool(inputs[k] > upper))
            for k, (lower, upper) in by_input.items()
            if k not in held and (inputs[k] > upper or inputs[k] < lower)
        ]
        if not beyond:
            apart = [w * (x - y) * (x - y) for w, x, y in zip(weights, inputs, u, strict=True)]
            kept.append((float(sum(apart)), inputs))
        elif len(reached) < directions:
            more = {reached | {one} for one in beyond} - known
            known |= more
            left += sorted(more, key=sorted)
    if not kept:
        raise NoInputsError
    return min(kept, key=lambda one: one[0])[1]


def _reaching(
    projected: Matrix, u: Vector, weights: Sequence[Any], reached: Sequence[tuple[int, Any]]
) -> Vector | None:
    """The nearest inputs with the same effect and these values."""
    m = len(u)
    rows = [*projected, *([float(j == k) for j in range(m)] for k, _ in reached)]
    size = m + len(rows)
    system = [[0.0] * size for _ in range(size)]
    for j in range(m):
        system[j][j] = weights[j]
        for i, row in enumerate(rows):
            system[j][m + i] = system[m + i][j] = row[j]
    right = [*[0.0] * (m + len(projected)), *(value - u[k] for k, value in reached)]
    if not reached:
        return u
    try:
        solved = solve(system, right)
    except ZeroDivisionError:  # an input that no internal force changes alone
        return None
    changes = solved[:m]
    moved = sum(w * x * x for w, x in zip(weights, changes, strict=True))
    missing = sum(weights[k] * (value - u[k]) * (value - u[k]) for k, value in reached)
    if float(moved) > MOST_MOVED**2 * float(missing):
        return None
    return [x + change for x, change in zip(u, changes, strict=True)]
