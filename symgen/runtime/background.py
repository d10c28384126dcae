"""One piece of work in a process of its own, which is sent messages on its way."""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
import traceback
from collections.abc import Callable
from typing import Any, Generic, TypeAlias, TypeVar

from symgen.diagnostics import SymgenBug

Answer = TypeVar("Answer")
Receive: TypeAlias = Callable[[], Any]
# The number of an option of prctl, from sys/prctl.h.
_PR_SET_PDEATHSIG = 1
# Keeps a pool of threads once it has typeset something: a fork has the pool without its threads, and waits for ever.
_THREADED = "typst"


class Background(Generic[Answer]):
    """Runs `work(receive)` in a forked process; `receive` blocks until the next message is sent.

    Where processes cannot be forked safely the work is done when the answer is asked for.  Messages and answer must
    pickle.  Use as a context manager: what is not finished is ended.
    """

    def __init__(self, work: Callable[[Receive], Answer]) -> None:
        self._work = work
        self._process = None
        self._messages: list[Any] = []
        if sys.platform.startswith("linux") and _THREADED not in sys.modules:
            context = multiprocessing.get_context("fork")
            self._pipe, far = context.Pipe()
            self._process = context.Process(target=_child, args=(work, far, self._pipe, os.getpid()), daemon=True)
            self._process.start()
            far.close()

    def __enter__(self) -> Background[Answer]:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is not None and self._process.is_alive():
            self._process.terminate()

    def send(self, message: Any) -> None:
        """The next message; nothing happens when the work has ended early."""
        if self._process is None:
            self._messages.append(message)
            return
        try:
            self._pipe.send(message)
        except BrokenPipeError:
            return

    def answer(self) -> Answer:
        """Waits for the end of the work; a fault of it is a SymgenBug with its traceback."""
        if self._process is None:
            waiting = iter(self._messages)
            fault, answer = _outcome(self._work, lambda: next(waiting))
        else:
            try:
                fault, answer = self._pipe.recv()
            except (EOFError, ConnectionError) as error:
                self._process.join()
                raise SymgenBug(f"the background process {_end(self._process.exitcode)}") from error
            self._process.join()
        if fault is not None:
            raise SymgenBug(f"in the background process:\n{fault}")
        result: Answer = answer
        return result


def _end(code: int | None) -> str:
    """How a process ended that has not answered."""
    if code == -signal.SIGKILL:
        return "was killed without an answer, most likely because memory ran out"
    return f"ended without an answer (exit code {code})"


def _child(
    work: Callable[[Receive], Answer],
    pipe: multiprocessing.connection.Connection,
    far: multiprocessing.connection.Connection,
    parent: int,
) -> None:
    """Works until the answer is sent or the parent is gone; the parent alone decides what an interrupt means.

    A copy of the parent's end left open here would keep `recv` waiting for a parent that was killed.
    """
    _end_with(parent)
    far.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_DFL)
    with contextlib.suppress(EOFError, ConnectionError):
        pipe.send(_outcome(work, pipe.recv))


def _outcome(work: Callable[[Receive], Answer], receive: Receive) -> tuple[str | None, Any]:
    """The traceback of a fault, or the answer."""
    try:
        return None, work(receive)
    except (EOFError, ConnectionError):
        raise
    except Exception:
        return traceback.format_exc(), None


def _end_with(parent: int) -> None:
    """Lets the kernel kill this process when the parent is killed, which may be long before the next message is due."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)
