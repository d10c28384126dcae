"""Counted work, and limits of it: what is offered as another method must not take longer than it may be worth.

Work is counted where it is done, in steps of one operation on floats, and what is counted is the same on every machine:
whether a limit is reached never depends on a clock.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

# Steps that others take, by what they take beside an operation on floats (CPython 3.11).
SCALAR, SLOPE, PRECISE = 200, 5, 10
# What deriving another method may take, in scalars: of shipped models none takes more than 12 for each operation.
FREE_SCALARS, SCALARS_AN_OPERATION = 50_000, 20


class TooLongError(Exception):
    """More work than is allowed."""


class _Counter:
    __slots__ = ("done", "most")

    def __init__(self) -> None:
        self.done, self.most = 0, math.inf


_counter = _Counter()


def spend(steps: int) -> None:
    """Counts work; TooLongError where that is more than is allowed."""
    _counter.done += steps
    if _counter.done > _counter.most:
        raise TooLongError


@contextmanager
def at_most(steps: float) -> Iterator[None]:
    """While this lasts, work of so many steps is allowed, and no more than around it."""
    outside = _counter.most
    _counter.most = min(outside, _counter.done + steps)
    try:
        yield
    finally:
        _counter.most = outside


def worth_trying(operations: int) -> int:
    """What deriving another method may take where one of so many operations is at hand."""
    return SCALAR * (FREE_SCALARS + SCALARS_AN_OPERATION * operations)


def done() -> int:
    """All work that was counted so far."""
    return _counter.done
