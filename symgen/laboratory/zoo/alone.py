"""Draws side by side, and one by itself: CPU time grows by up to a half where two processes share a core."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path


@contextmanager
def beside_others(folder: Path) -> Iterator[None]:
    """While this lasts, others of the campaign that writes to a folder may run, but none by itself."""
    with ExitStack() as running:
        with _entrance(folder):
            running.enter_context(_locked(folder / "running.lock", fcntl.LOCK_SH))
        yield


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Waits until no other runs; none begins while this lasts, nor while it waits."""
    with _entrance(folder), _locked(folder / "running.lock", fcntl.LOCK_EX):
        yield


def _entrance(folder: Path) -> AbstractContextManager[None]:
    """Whoever is about to run passes here, one at a time: those who come later do not overtake who waits."""
    folder.mkdir(parents=True, exist_ok=True)
    return _locked(folder / "entrance.lock", fcntl.LOCK_EX)


@contextmanager
def _locked(path: Path, kind: int) -> Iterator[None]:
    with path.open("w") as file:
        fcntl.flock(file, kind)
        yield
