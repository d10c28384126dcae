"""One run at a time writes into a folder; the lock of a run that died is free.

The system holds the lock on an open file, so it goes with its process. The file goes with the lock, where that can be.
"""

from __future__ import annotations

import errno
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

LOCK = ".symgen-lock"
# Seconds after which waiting ends; a run holds the lock for less than one while it writes.
LONGEST_WAIT = 60.0
# Seconds before the wait is told.
PATIENCE = 0.5
# Seconds between two looks at the lock.
_PAUSE = 0.01


class LockedError(OSError):
    """Another run has held the folder for too long."""


@contextmanager
def folder_lock(directory: Path, notify: Callable[[str], None], longest: float = LONGEST_WAIT) -> Iterator[None]:
    """Holds the lock of an existing folder; raises LockedError where another run does not give it back.

    A folder that cannot be written, or a disk that knows no locks, is used as it is: writing will tell what is wrong.
    """
    file: int | None = None
    try:
        file = _acquired(directory / LOCK, notify, longest)
    except LockedError:
        raise
    except OSError:
        pass
    try:
        yield
    finally:
        if file is not None:
            with suppress(OSError):  # an open file may not be removable; the next run then takes it over
                (directory / LOCK).unlink(missing_ok=True)
            os.close(file)


def _acquired(path: Path, notify: Callable[[str], None], longest: float) -> int:
    """The open, locked file at `path`: another that was removed while this run waited for it locks nothing."""
    began, notified = time.monotonic(), False
    while True:
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if _locked(file):
                if _is_at(file, path):
                    os.ftruncate(file, 0)
                    os.write(file, f"{os.getpid()}\n".encode())
                    return file
            else:
                waited, holder = time.monotonic() - began, _holder(file)
                if waited > longest:
                    remedy = f"wait for it or end it, or delete {path.name} if no symgen runs"
                    message = f"another run of symgen{holder} has been writing here for {longest:g} s: {remedy}"
                    raise LockedError(errno.EAGAIN, message, str(path.parent))
                if waited > PATIENCE and not notified:
                    notified = True
                    notify(f"{path.parent}: waiting for another run of symgen{holder} that writes here")
                time.sleep(_PAUSE)
        except BaseException:
            os.close(file)
            raise
        os.close(file)


def _is_at(file: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file), path.stat())
    except FileNotFoundError:
        return False


def _holder(file: int) -> str:
    try:
        number = os.pread(file, 20, 0).strip() if hasattr(os, "pread") else b""
    except OSError:
        return ""
    return f" (process {number.decode()})" if number.isdigit() else ""


def _locked(file: int) -> bool:
    """Whether this process got the lock of an open file, now."""
    try:
        import fcntl
    except ImportError:
        import msvcrt

        try:
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined, unused-ignore]
        except OSError:
            return False
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
