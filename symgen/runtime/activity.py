"""What a run is at, inside of its steps: told by those who work, and read by the one who tells the user.

Steps that may take seconds say what they do and, where it can be counted, how much of it is done.  Nothing is printed
here and nothing depends on it; see `symgen.terminal.Progress`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

Item = TypeVar("Item")
# A share of the work that is too small to foresee the rest from, and the seconds from which the rest is worth telling.
LEAST_SHARE, WORTH_SHOWING = 0.02, 2.0


class Work:
    """A piece of work: `whole` counts all of it in any unit (0: unknown), `done` what is behind."""

    __slots__ = ("began", "done", "part", "seconds", "what", "whole")

    def __init__(self, what: str, whole: float, seconds: float) -> None:
        self.what, self.whole, self.seconds = what, whole, seconds
        self.done, self.part = 0.0, ""
        self.began = time.monotonic()

    def left(self, now: float) -> float | None:
        """Seconds that are left, from what the work has taken so far or usually takes; None where nothing is known."""
        spent = now - self.began
        if self.whole and self.done >= LEAST_SHARE * self.whole:
            return spent * (self.whole - self.done) / self.done
        return self.seconds - spent if self.seconds > spent else None


_works: list[Work] = []


@contextmanager
def working(what: str, whole: float = 0, seconds: float = 0) -> Iterator[Work]:
    """While this lasts the run is at `what`; `seconds` is what it usually takes, where that is known beforehand."""
    work = Work(what, whole, seconds)
    _works.append(work)
    try:
        yield work
    finally:
        _works.remove(work)


def each(what: str, items: Sequence[Item], named: Callable[[Item], str] = lambda _: "",
         sizes: Sequence[float] | None = None) -> Iterator[Item]:  # fmt: skip
    """The items one after the other, told by name; `sizes` are their shares of the work, equal ones without."""
    shares = [1.0] * len(items) if sizes is None else sizes
    with working(what, sum(shares)) as work:
        for item, share in zip(items, shares, strict=True):
            work.part = named(item)
            yield item
            work.done += share


def described() -> str:
    """What the run is at, from the outside inwards, and how long the innermost counted work will take yet."""
    now = time.monotonic()
    words = []
    left: float | None = None
    for work in tuple(_works):
        words += [" ".join(word for word in (work.what, work.part) if word)]
        left = work.left(now) if work.left(now) is not None else left
    if left is not None and left >= WORTH_SHOWING:
        words.append(f"about {_rounded(left)} s more")
    return ", ".join(word for word in words if word)


def _rounded(seconds: float) -> int:
    """An estimate shows no more digits than it has."""
    step = 1 if seconds < 10 else 5 if seconds < 60 else 10
    return max(1, round(seconds / step) * step)
