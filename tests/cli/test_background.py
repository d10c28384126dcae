"""Work in a process of its own: answers, faults, and nothing left behind when the parent goes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from symgen.diagnostics import SymgenBug
from symgen.runtime.background import Background, Receive

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="processes are forked on Linux only")

PARENT = """
import os, signal, time
from symgen.runtime.background import Background

signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where the tests run behind a shell's `&`

def work(receive):
    print(os.getpid(), flush=True)
    return receive()

with Background(work):
    time.sleep(60)
"""

KILLED = """
import os, signal
from symgen.diagnostics import SymgenBug
from symgen.runtime.background import Background

def work(receive):
    os.kill(os.getpid(), signal.SIGKILL)

with Background(work) as background:
    try:
        background.answer()
    except SymgenBug as bug:
        print(bug)
"""

TYPESET_BEFORE = """
import typst
from symgen.runtime.background import Background

def work(receive):
    return len(typst.compile(receive(), format="pdf"))

typst.compile(b"before", format="pdf")
with Background(work) as background:
    background.send(b"after")
    assert background.answer() > 0
"""


def test_messages_go_in_and_the_answer_comes_out() -> None:
    def work(receive: Receive) -> int:
        return int(receive()) + int(receive())

    with Background(work) as background:
        background.send(1)
        background.send(2)
        assert background.answer() == 3


def test_a_fault_comes_back_with_its_traceback() -> None:
    def work(_receive: Receive) -> int:
        raise OSError("disk on fire")

    with Background(work) as background, pytest.raises(SymgenBug, match="disk on fire"):
        background.answer()


def test_what_was_typeset_before_does_not_keep_the_work_waiting() -> None:
    subprocess.run([sys.executable, "-c", TYPESET_BEFORE], check=True, timeout=60)


@pytest.mark.parametrize("ending", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_the_work_ends_with_its_parent(ending: signal.Signals) -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert parent.stdout is not None
    child = int(parent.stdout.readline())
    parent.send_signal(ending)
    _, errors = parent.communicate(timeout=10)  # returns once nobody holds the pipes: the child is gone as well
    assert errors.count(b"Traceback") <= 1  # of the parent
    assert not _runs(child)


def _runs(process: int) -> bool:
    for _ in range(50):
        try:
            with open(f"/proc/{process}/stat") as stat:
                if stat.read().rpartition(")")[2].split()[0] == "Z":
                    return False
            os.kill(process, 0)
        except (FileNotFoundError, ProcessLookupError):
            return False
        time.sleep(0.02)
    return True


def test_a_process_that_is_killed_is_told() -> None:
    # in a process of its own: where something was typeset before, work is not done in another one
    made = subprocess.run([sys.executable, "-c", KILLED], capture_output=True, text=True, check=True)
    assert made.stdout == "the background process was killed without an answer, most likely because memory ran out\n"
