"""A call every few seconds between two steps of the main thread: by a timer of the system, without a thread.

A thread would print into lines of others, and be missing in a process that is forked. Timers end with a fork.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from contextlib import suppress
from types import FrameType

# Seconds between two calls.
SECONDS = 2.0


class Clock:
    """Calls `tick` every 2 s from `start` to `stop`.

    Nothing happens outside of the main thread, on systems without timers, or where another owns the signal.
    """

    def __init__(self, tick: Callable[[], None]) -> None:
        self._tick = tick
        self._running = False

    def start(self, anew: bool = True) -> None:
        """The next call is due in 2 s; a clock that is running goes on unless it begins anew."""
        if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "setitimer"):
            return
        if not self._running:
            if signal.getsignal(signal.SIGALRM) is not signal.SIG_DFL:
                return
            signal.signal(signal.SIGALRM, self._called)
            self._running = anew = True
        if anew:
            signal.setitimer(signal.ITIMER_REAL, SECONDS, SECONDS)

    def stop(self) -> None:
        """No further calls."""
        if self._running:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            self._running = False

    def _called(self, _number: int, _frame: FrameType | None) -> None:
        # a stream that is being written to says so, and one that is closed cannot be told anything
        with suppress(RuntimeError, ValueError, OSError):
            self._tick()
