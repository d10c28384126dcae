"""Zeros of functions by Levenberg and Marquardt's method in Arb's numbers, of which the midpoints count.

The damping falls with what is left, so that a step has least norm and convergence stays superlinear where rows of
slopes depend on each other at the zero (Nocedal and Wright, Numerical Optimization, ch. 10).  Digits are those of the
caller.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from flint import arb_mat, ctx

from symgen.validity.precise import Precise

# Values of functions at a point, and a row of slopes for each.
Evaluated: TypeAlias = tuple[Sequence[Precise], Sequence[Sequence[Precise]]]
# Of the mean square of the slopes: a step with more damping leads nowhere.
MOST_DAMPING = 1e6
# Steps in turn that may come closer by less than STALLED allows: a way on which there are more leads to no zero, as
# towards one, even where slopes vanish too, each step takes away more.
STALLED_STEPS = 8
# What of its distance such a step leaves at least.
STALLED = 0.9


def zero_beside(
    evaluate: Callable[[list[Precise]], Evaluated],
    start: Sequence[Precise],
    vanished: float,
    steps: int,
    damping: float,
    widths: Sequence[Precise] | None = None,
    inside: Callable[[list[Precise]], list[Precise]] = list,
) -> list[Precise] | None:
    """Where the largest of the functions has `vanished`, or None where no way of so many steps leads there.

    Steps are short in units of `widths`; `inside` brings them back to where they may lead.
    """
    x = list(start)
    units = [1] * len(x) if widths is None else widths
    values, slopes = evaluate(x)
    size, slow = _largest(values), 0
    least = 2.0 ** (-ctx.prec // 2)
    for _ in range(steps):
        if size <= vanished:
            return x
        rows = arb_mat([[slope * unit for slope, unit in zip(row, units, strict=True)] for row in slopes])
        step = _step(rows, arb_mat([[value] for value in values]), damping)
        fresh_size = size
        if step is not None:
            trial = inside([(a - u * b).mid() for a, u, b in zip(x, units, step.entries(), strict=True)])
            fresh = evaluate(trial)
            fresh_size = _largest(fresh[0])
            slow = slow + 1 if fresh_size > STALLED * size else 0
        if fresh_size < size:
            damping = max(damping * min(0.03, fresh_size / size), least)
            x, (values, slopes), size = trial, fresh, fresh_size
        else:
            damping *= 10
        if damping > MOST_DAMPING or slow == STALLED_STEPS:
            return None
    return x if size <= vanished else None


def _step(slopes: Any, values: Any, damping: float) -> Any | None:
    """J' (J J' + shift)^-1 g; None where rounding leaves the matrix singular, so that more damping is due.

    A number without bounds, which would grow by 1 / damping for each row that depends on others.
    """
    gram = (slopes * slopes.transpose()).mid()
    shift = damping * gram.trace() / gram.nrows()
    for i in range(gram.nrows()):
        gram[i, i] += shift
    try:
        return slopes.transpose() * gram.mid().solve(values, algorithm="approx")
    except ZeroDivisionError:
        return None


def _largest(values: Sequence[Precise]) -> float:
    return max(float(abs(value)) for value in values)
