"""Inputs within limits along several directions of internal force, by definition: faces of what the limits leave.

K = (1 - X (N M)) W^-1, X being the weighted inverse, is symmetric, and its columns are the inputs that move nothing and
are nearest, in the weights, to a change of one input alone.  On a face some inputs have the values of their limits:
u = u_0 + K_S (K_SS)^-1 (limits - u_0), at the squared distance (limits - u_0)' (K_SS)^-1 (limits - u_0).  The nearest
inputs lie on a face that begins with a limit that u_0 violates, goes on with one that the nearest inputs on that face
violate, and so on: of all faces that are reached so the nearest point that violates nothing is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product
from typing import Any, TypeAlias

from flint import arb, arb_mat

from symgen.verify.reference.arithmetic.linear import (
    column,
    columns_of,
    independent_columns,
    rows_of,
    solve,
)

Limits: TypeAlias = Sequence[tuple[int, Any, Any]]
"""The number of an input, its lower and its upper limit."""
_Face: TypeAlias = frozenset[tuple[int, bool]]
"""Inputs with whether they are at their upper limits."""


class NoneWithinError(Exception):
    """No inputs within their limits produce the motion."""


def nearest_within(least: Any, unmoving: Any, limits: Limits, directions: int, weights: Sequence[Any]) -> Any:
    """The inputs (m x 1) nearest to `least` within limits; `unmoving` is K.  Raises NoneWithinError.

    An input takes no part in internal forces that change it, the inputs held after it in the order of the limits apart,
    by less than a ten-thousandth of what they may: the root of K_kk, what is left of it, beside that of 1 / w_k.
    """
    by_input = {k: (lower, upper) for k, lower, upper in limits}
    part = {k: 1e-8 / weights[k] for k, *_ in limits}
    best: tuple[float, Any] | None = None
    looked_at: set[_Face] = set()
    faces: list[_Face] = [frozenset()]
    while faces:
        face = faces.pop()
        if face in looked_at:
            continue
        looked_at.add(face)
        nearest = _on_face(least, unmoving, by_input, face) if _exists(unmoving, part, face) else None
        if nearest is None:
            continue
        distance, inputs = nearest
        held = {k for k, _ in face}
        beyond = [
            (k, bool(inputs[k, 0] > upper))
            for k, (lower, upper) in by_input.items()
            if k not in held and (inputs[k, 0] > upper or inputs[k, 0] < lower)
        ]
        if not beyond:
            best = (distance, inputs) if best is None or distance < best[0] else best
        elif len(face) < directions:
            faces += [face | {one} for one in beyond]
    if best is None:
        raise NoneWithinError
    return best[1]


def _exists(unmoving: Any, part: dict[int, Any], face: _Face) -> bool:
    """Whether each input on a face takes part in what moves those before it in the order of limits alone."""
    places = [k for k in reversed(part) if k in {k for k, _ in face}]
    gram = rows_of(columns_of(unmoving, places), places).tolist()
    for i, k in enumerate(places):
        if not gram[i][i] > part[k]:
            return False
        for j in range(i + 1, len(places)):
            factor = gram[j][i] / gram[i][i]
            gram[j] = [x - factor * y for x, y in zip(gram[j], gram[i], strict=True)]
    return True


def utilisation(least: Any, unmoving: Any, limits: Limits, directions: int) -> Any:
    """The least largest |u_i - c_i| / h_i of all inputs that produce a motion, of which `least` are some (1 x 1).

    A linear program whose solution has one input more than directions at that share: of all such choices the one of
    which the largest share is least.
    """
    middles, halves = [(b + a) / 2 for _, a, b in limits], [(b - a) / 2 for _, a, b in limits]
    free: Any = columns_of(unmoving, independent_columns(unmoving, directions) if directions else [])
    best: Any = None
    for chosen in combinations(range(len(limits)), directions + 1):
        for signs in product((1, -1), repeat=directions):
            ends = [sign * halves[i] for i, sign in zip(chosen, (1, *signs), strict=True)]
            rows = [[*(free[i, j] for j in range(directions)), -end] for i, end in zip(chosen, ends, strict=True)]
            missing = column([middles[i] - least[i, 0] for i in chosen])
            try:
                shares = solve(arb_mat(directions + 1, directions + 1, [x for row in rows for x in row]), missing)
            except ZeroDivisionError:
                continue
            inputs = [
                least[i, 0] + sum((free[i, j] * shares[j, 0] for j in range(directions)), arb(0))
                for i in range(len(limits))
            ]
            shares_taken = [abs(u - c) / h for u, c, h in zip(inputs, middles, halves, strict=True)]
            largest = shares_taken[0]
            for share in shares_taken[1:]:
                largest = largest.max(share)
            best = largest if best is None else best.min(largest)
    return column([best])


def unmoving_inputs(inverse: Any, projected_control: Any, weights: Sequence[Any]) -> Any:
    """K (m x m) from the weighted inverse of N M (m x n) and N M (n x m)."""
    m = len(weights)
    moved = inverse * projected_control
    unit = arb_mat(m, m, [arb(int(i == j)) for i in range(m) for j in range(m)])
    return (unit - moved) * arb_mat(m, m, [1 / weights[i] if i == j else arb(0) for i in range(m) for j in range(m)])


def _on_face(least: Any, unmoving: Any, by_input: dict[int, tuple[Any, Any]], face: _Face) -> tuple[float, Any] | None:
    """The squared distance of the nearest inputs on a face, and these; None where the face does not exist."""
    if not face:
        return 0.0, least
    held = sorted(face)
    places = [k for k, _ in held]
    missing = column([by_input[k][upper] - least[k, 0] for k, upper in held])
    try:
        factors = solve(rows_of(columns_of(unmoving, places), places), missing)
    except ZeroDivisionError:  # inputs that do not change by themselves
        return None
    return float((missing.transpose() * factors)[0, 0]), least + columns_of(unmoving, places) * factors
