"""Compilers, emulators and other tools that a run starts: within a time limit, and ended with the run.

Each leads a process group of its own: a compiler's driver that is ended alone leaves the compiler proper at work.
What a run that is killed leaves at work is ended by its guardian.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

from symgen.runtime import guardian

if TYPE_CHECKING:  # most commands start no tool
    import subprocess

# Seconds after which a killed tool is asked for by other means.
LOCK_PATIENCE = 0.2

_running: set[subprocess.Popen[bytes]] = set()
_ending = False
_starting = False  # by the main thread, in which handlers of signals run
_due: BaseException | None = None


class ToolError(Exception):
    """A tool of this machine refused its work, hangs, or made nothing of use; the text is its own, or a remedy."""


def start(command: Sequence[str], folder: Path | None = None, output: IO[bytes] | None = None,
          complaints: IO[bytes] | None = None, temporary: Path | None = None) -> subprocess.Popen[bytes]:
    """A tool at work in a folder, without input; what it prints goes to the files, or nowhere. `stop` ends it.

    What it keeps for itself goes to `temporary`, or the folder it works in: a tool that is ended leaves it behind.
    Raises ToolError where the tool cannot be started.
    """
    import subprocess

    if _ending:
        raise ToolError(f"{command[0]} is not started: the run ends")
    own = temporary or folder
    environment = None if own is None else {**os.environ, "TMPDIR": str(own.resolve())}
    with _held_back():
        try:
            process = subprocess.Popen(
                command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=output or subprocess.DEVNULL,
                stderr=complaints or subprocess.DEVNULL, process_group=0 if os.name == "posix" else None,
            )
        except OSError as error:
            raise ToolError(f"{command[0]} cannot be started: {error.strerror or error}") from error
        _running.add(process)
        guardian.watch(process.pid)
        if _ending:  # while it was being started
            stop(process)
            raise ToolError(f"{command[0]} is ended: the run ends")
    return process


@contextmanager
def _held_back() -> Iterator[None]:
    """What ends the run waits until a tool that is being started is known: it would be left at work."""
    global _starting, _due
    main = threading.current_thread() is threading.main_thread()
    _starting = _starting or main
    try:
        yield
    finally:
        if main:
            _starting = False
            due, _due = _due, None
            if due is not None:
                raise due


def end_with(error: BaseException) -> None:
    """Ends every tool and raises the error, as soon as no tool is being started; for handlers of signals."""
    global _due
    stop_all()
    if _starting:
        _due = error
    else:
        raise error


def ended(process: subprocess.Popen[bytes], limit: float) -> int:
    """Waits for the exit code of a tool; raises ToolError, and ends the tool, when it takes more than `limit` seconds.

    Whatever else ends the wait, such as an interrupt, ends the tool, too.
    """
    from subprocess import TimeoutExpired

    try:
        return process.wait(limit)
    except TimeoutExpired as error:
        raise ToolError(f"{_name(process)} did not end within {limit:.3g} s") from error
    finally:
        stop(process)


def run(command: Sequence[str], limit: float, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Runs a tool to its end; what it printed is text whatever its bytes.

    Raises ToolError as `start` and `ended` do.
    """
    from subprocess import CompletedProcess
    from tempfile import TemporaryFile

    # files, not pipes: what a tool leaves running in the background holds no reader
    with TemporaryFile() as output, TemporaryFile() as complaints:
        code = ended(start(command, folder, output, complaints), limit)
        texts = []
        for file in (output, complaints):
            file.seek(0)
            texts.append(file.read().decode("utf-8", errors="replace"))
    return CompletedProcess(list(command), code, *texts)


def stop(process: subprocess.Popen[bytes]) -> None:
    """Ends a tool with everything that it started; nothing where it has ended."""
    if process.poll() is None:
        _kill(process)
        _await_killed(process)
    if process in _running:
        _running.discard(process)
        guardian.forget(process.pid)


def stop_all() -> None:
    """Ends every tool of this run, those of other threads included; none is started until `begin`."""
    global _ending
    _ending = True
    for process in tuple(_running):
        if process.returncode is None:
            _kill(process)


def begin() -> None:
    """A run begins: tools may be started."""
    global _ending
    _ending = False


def _await_killed(process: subprocess.Popen[bytes]) -> None:
    """Waits for a tool that was killed.

    A handler of a signal may raise in `Popen.wait` between taking its lock and what lets go of it (CPython 3.11): then
    every later wait is for that lock, and the tool is asked for here.
    """
    from subprocess import TimeoutExpired

    while process.returncode is None:
        try:
            process.wait(LOCK_PATIENCE)
        except TimeoutExpired:
            with suppress(ChildProcessError):  # another thread has asked, and is about to say
                done, status = os.waitpid(process.pid, os.WNOHANG)
                if done:
                    process.returncode = os.waitstatus_to_exitcode(status)


def _name(process: subprocess.Popen[bytes]) -> str:
    command = process.args
    return str(command[0] if isinstance(command, (list, tuple)) else command)


def _kill(process: subprocess.Popen[bytes]) -> None:
    try:
        if os.name == "posix":
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    except ProcessLookupError:
        return
