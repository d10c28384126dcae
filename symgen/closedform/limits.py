"""Counted work: a closed form that needs more than a fixed number of steps is not attempted, on any machine."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

WORK_LIMIT = 300_000
"""Products of terms, about two seconds of work."""


class TooLargeError(Exception):
    """A closed form is not worth it; the text is the reason."""


class WorkCounter:
    """Counts products of terms while a limit is set; what failed once on its own fails again at once."""

    def __init__(self) -> None:
        self._spent = 0
        self._what = ""
        self._failed: dict[str, str] = {}

    @contextmanager
    def limited(self, what: str) -> Iterator[None]:
        """Raise TooLargeError, saying what was being built, beyond WORK_LIMIT products; the outermost limit counts."""
        if what in self._failed:
            raise TooLargeError(self._failed[what])
        outermost = not self._what
        if outermost:
            self._spent, self._what = 0, what
        before = self._spent
        try:
            yield
        except TooLargeError as large:
            if before < WORK_LIMIT // 10:
                self._failed[what] = str(large)
            raise
        finally:
            if outermost:
                self._what = ""

    def spend(self, products: int) -> None:
        """Note work that is about to be done."""
        self._spent += products
        if self._what and self._spent > WORK_LIMIT:
            raise TooLargeError(f"{self._what} needs more than {WORK_LIMIT} products of terms")
