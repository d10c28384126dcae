"""What ends a run from outside: Ctrl-C, SIGTERM, SIGHUP. Compilers end at once, then the run as after any error."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from symgen.runtime import processes

_MEANINGS = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "ended with its terminal"}
# Seconds in which a second signal must not break off the cleaning up after the first.
_SAME_MOMENT = 1.0


class EndedError(SystemExit):
    """A signal ends the run; `number` is the exit code that a shell reports, `meaning` a word for it."""

    def __init__(self, number: int) -> None:
        self.number = 128 + number
        super().__init__(self.number)
        self.meaning = _MEANINGS[signal.Signals(number).name]


@contextmanager
def signals_end_the_run(process_ends: bool) -> Iterator[None]:
    """A signal becomes an EndedError, unless it is ignored already, as under nohup; outside the main thread nothing.

    Where the process ends with the run, more of them are ignored once one came: the same signal is often sent twice,
    and the second would kill a process that is about to say what became of its files.
    """
    processes.begin()
    before = {}
    ended = _Ending()
    if threading.current_thread() is threading.main_thread():
        numbers = [getattr(signal, name) for name in _MEANINGS if hasattr(signal, name)]
        before = {n: signal.signal(n, ended) for n in numbers if signal.getsignal(n) not in (signal.SIG_IGN, None)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, signal.SIG_IGN if process_ends and ended.came else handler)


class _Ending:
    """The handler, which remembers when it was called last."""

    def __init__(self) -> None:
        self._last = float("-inf")

    @property
    def came(self) -> bool:
        """Whether it was called."""
        return self._last > float("-inf")

    def __call__(self, number: int, _frame: FrameType | None) -> None:
        now = time.monotonic()
        if now - self._last < _SAME_MOMENT:
            return
        self._last = now
        processes.end_with(EndedError(number))
