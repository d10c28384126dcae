"""A step that takes long is told again and again, with what it is at and how long it will take."""

from __future__ import annotations

import io
import os
import re
import signal
import subprocess
import threading
import time
from pathlib import Path

import pytest

from symgen import pipeline
from symgen.generation.results import Options
from symgen.runtime import activity, clock
from symgen.runtime.activity import described, each, working
from symgen.terminal import Progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "SECONDS", 0.02)


def wait_for(stream: io.StringIO, lines: int) -> list[str]:
    limit = time.monotonic() + 30
    while len(written := stream.getvalue().splitlines()) < lines and time.monotonic() < limit:
        time.sleep(0.005)
    return written


def test_a_log_is_told_what_a_step_is_at_until_it_is_done() -> None:
    log = io.StringIO()
    progress = Progress("arm", quiet=False, stream=log)
    progress("deriving")
    with working("methods of", 8) as work:
        work.part = "multipliers"
        lines = wait_for(log, 4)
    assert lines[0] == "arm: deriving ..."
    assert all(line.startswith("arm: deriving, methods of multipliers, ") for line in lines[1:])
    progress.done()
    said = log.getvalue()
    time.sleep(0.1)
    assert log.getvalue() == said
    assert signal.getsignal(signal.SIGALRM) is signal.SIG_DFL


def test_messages_of_one_stage_that_a_log_does_not_show_do_not_put_off_the_clock() -> None:
    log = io.StringIO()
    progress = Progress("arm", quiet=False, stream=log)
    limit = time.monotonic() + 30
    while len(log.getvalue().splitlines()) < 3 and time.monotonic() < limit:
        progress("reference, state 3 of 64")
        time.sleep(0.002)
    progress.done()
    assert log.getvalue().splitlines()[1].startswith("arm: reference, state 3 of 64, ")


def test_a_terminal_keeps_one_line() -> None:
    terminal = Terminal()
    progress = Progress("arm", quiet=False, stream=terminal)
    progress("deriving")
    limit = time.monotonic() + 30
    while terminal.getvalue().count("\r") < 4 and time.monotonic() < limit:
        time.sleep(0.005)
    progress.done()
    assert "\n" not in terminal.getvalue()
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_a_quiet_run_tells_nothing() -> None:
    log = io.StringIO()
    progress = Progress("arm", quiet=True, stream=log)
    progress("deriving")
    time.sleep(0.1)
    progress.done()
    assert log.getvalue() == ""
    assert signal.getsignal(signal.SIGALRM) is signal.SIG_DFL


def test_a_stream_that_is_closed_or_being_printed_to_ends_nothing() -> None:
    log = io.StringIO()
    progress = Progress("arm", quiet=False, stream=log)
    progress("deriving")
    log.close()
    time.sleep(0.1)
    progress.done()


def test_tools_and_forks_are_not_called_by_the_clock() -> None:
    progress = Progress("arm", quiet=False, stream=io.StringIO())
    progress("compiling")
    # a process that the signal reached would be ended by it
    assert subprocess.run(["sleep", "0.2"], check=False).returncode == 0
    child = os.fork()
    if not child:
        time.sleep(0.1)
        os._exit(0 if signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0) else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    progress.done()


def test_other_threads_and_owners_of_the_signal_are_left_alone() -> None:
    log = io.StringIO()
    thread = threading.Thread(target=Progress("arm", quiet=False, stream=log), args=("deriving",))
    thread.start()
    thread.join()
    assert signal.getsignal(signal.SIGALRM) is signal.SIG_DFL
    before = signal.signal(signal.SIGALRM, signal.SIG_IGN)
    try:
        progress = Progress("arm", quiet=False, stream=log)
        progress("deriving")
        progress.done()
        assert signal.getsignal(signal.SIGALRM) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGALRM, before)


@pytest.fixture
def at(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time that activities see, which the test sets."""
    now = [0.0]
    monkeypatch.setattr(activity.time, "monotonic", lambda: now[0])
    return now


def test_the_rest_is_foreseen_from_the_share_of_the_work_that_is_done(at: list[float]) -> None:
    seen = []
    for name in each("shortening", ["short", "long", "last"], str, sizes=[10, 30, 60]):
        seen.append(described())
        at[0] += {"short": 2.0, "long": 6.0, "last": 12.0}[name]
    assert seen == ["shortening short", "shortening long, about 20 s more", "shortening last, about 10 s more"]
    assert described() == ""


def test_what_work_usually_takes_is_told_until_it_has_taken_that(at: list[float]) -> None:
    with working("verifying"), working("compiling 20 MB of C", seconds=10):
        assert described() == "verifying, compiling 20 MB of C, about 10 s more"
        at[0] = 5.0
        assert described() == "verifying, compiling 20 MB of C, about 5 s more"
        at[0] = 11.0
        assert described() == "verifying, compiling 20 MB of C"
    assert described() == ""


@pytest.mark.campaign
def test_the_time_of_a_run_is_foreseen_from_its_derivation(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before that nothing is known, and without verification the derivation is most of it."""
    model = Path(__file__).parents[2] / "models" / "differential_drive.yaml"
    for longer, verify in ((True, True), (True, False), (False, True)):
        monkeypatch.setattr(pipeline, "WHOLE_PER_DERIVING", 1e5 if longer else 1e-5)
        seen: dict[str, str] = {}
        options = Options(parts=("c", "python"), verify=verify, states=8)
        pipeline.generate(model, options, lambda text, seen=seen: seen.setdefault(text, described()))
        assert "in all" not in seen["reading the model"] + seen["deriving"]
        assert (re.fullmatch(r"about \d+0 s in all", seen["writing"]) is not None) is (longer and verify)


def test_a_step_that_fails_is_over() -> None:
    def fails() -> None:
        with working("ways"):
            for _ in each("to", [1, 2]):
                raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fails()
    assert described() == ""
