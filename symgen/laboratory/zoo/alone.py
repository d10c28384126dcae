"""Draws side by side, and one by itself: CPU time grows by up to a half where two processes share a core."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def beside_others(folder: Path) -> Iterator[None]:
    """While this lasts, others of the campaign that writes to a folder may run, but none by itself."""
    with _entrance(folder):
        running = _Lock(folder / "running.lock", fcntl.LOCK_SH)
    with running:
        yield


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Waits until no other runs; none begins while this lasts, nor while it waits."""
    with _entrance(folder), _Lock(folder / "running.lock", fcntl.LOCK_EX):
        yield


def _entrance(folder: Path) -> _Lock:
    """Whoever is about to run passes here, one at a time: those who come later do not overtake who waits."""
    return _Lock(folder / "entrance.lock", fcntl.LOCK_EX)


class _Lock:
    """A lock on a file, held from now until it is left."""

    def __init__(self, path: Path, kind: int) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("w")
        fcntl.flock(self._file, kind)

    def __enter__(self) -> None:
        return None

    def __exit__(self, *_: object) -> None:
        self._file.close()
