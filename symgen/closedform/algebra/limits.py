"""Counted work: a closed form that needs more than a fixed number of steps is not attempted, on any machine."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

WORK_LIMIT = 60_000
"""Products of terms, about half a second of work: what needs more has always been too long to be printed."""

LIMIT_OF_MODEL = 300_000
"""The same for g and B, without which there is no report."""

LIMIT_OF_THE_REST = 1_000_000
"""The same for all together that has no limit of its own."""

THE_REST = "what the closed forms rest on"


class TooLargeError(Exception):
    """A closed form is not worth it; the text is the reason."""


class WorkCounter:
    """Counts products of terms, what is `limited` on its own; what failed once on its own fails again at once."""

    def __init__(self) -> None:
        self._spent, self._what, self._limit = 0, THE_REST, LIMIT_OF_THE_REST
        self._failed: dict[str, str] = {}

    @contextmanager
    def limited(self, what: str, limit: int = WORK_LIMIT) -> Iterator[None]:
        """Raise TooLargeError, saying what was being built, beyond so many products; the outermost limit counts."""
        if what in self._failed:
            raise TooLargeError(self._failed[what])
        outermost, of_the_rest = self._what == THE_REST, self._spent
        if outermost:
            self._spent, self._what, self._limit = 0, what, limit
        before = self._spent
        try:
            yield
        except TooLargeError as large:
            if before < WORK_LIMIT // 10:
                self._failed[what] = str(large)
            raise
        finally:
            if outermost:
                self._spent, self._what, self._limit = of_the_rest, THE_REST, LIMIT_OF_THE_REST

    def spend(self, products: int) -> None:
        """Note work that is about to be done."""
        self._spent += products
        if self._spent > self._limit:
            raise TooLargeError(f"{self._what} needs more than {self._limit} products of terms")
