"""The whole command on one model file, in a process group of its own, with limits of CPU time and memory."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

CPU_SECONDS = 60
MEGABYTES = 1000
# a loaded machine takes longer on the clock; what stands still without computing ends here
PATIENCE = 20
SAMPLES_A_SECOND = 2
TICKS = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class CommandRun:
    """How a run of the command ended: exit code (negative: a signal), what it said, what it took.

    `cpu` and `megabytes` are those of the command and all its children; the memory is that of all of them together.
    """

    code: int
    out: str
    err: str
    cpu: float
    megabytes: float
    ended: str = ""


def run_command(
    model: Path, folder: Path, options: Sequence[str] = (), cpu: float = CPU_SECONDS, megabytes: float = MEGABYTES
) -> CommandRun:
    """`symgen MODEL` with options into `folder`, verification included.

    `ended` says why a run was ended from here: time, memory or no end.
    """
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    command = [sys.executable, "-m", "symgen", str(model), "--out", str(folder), *options]
    with (folder / "stdout").open("w+") as out, (folder / "stderr").open("w+") as err:
        began = os.times()
        process = subprocess.Popen(
            command,
            stdout=out,
            stderr=err,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
            preexec_fn=_limited(cpu, megabytes),
        )
        watch = _Watch(process, cpu, megabytes)
        process.wait()
        watch.stop()
        end_group(process.pid)
        now = os.times()
        spent = (now.children_user + now.children_system) - (began.children_user + began.children_system)
        out.seek(0)
        err.seek(0)
        code, said, complained = process.returncode, out.read(), err.read()
    return CommandRun(code, said, complained, max(spent, watch.cpu), watch.megabytes, watch.ended)


def _limited(cpu: float, megabytes: float) -> Callable[[], None]:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (int(cpu) + 5, int(cpu) + 10))
        # address space is far more than memory in use: it only ends what has run wild between two looks
        room = int(6 * megabytes) * 1_000_000
        resource.setrlimit(resource.RLIMIT_AS, (room, room))
        os.nice(5)

    return limit


def end_group(leader: int) -> None:
    """Ends what is left of a process group of our own."""
    try:
        os.killpg(leader, signal.SIGKILL)
    except ProcessLookupError:
        return


class _Watch:
    """Looks at the processes of a session again and again, and ends them where they take too much."""

    def __init__(self, process: subprocess.Popen[bytes], cpu: float, megabytes: float) -> None:
        self._process, self._limit_cpu, self._limit_megabytes = process, cpu, megabytes
        self.cpu = self.megabytes = 0.0
        self.ended = ""
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """No further looks."""
        self._over.set()
        self._thread.join()

    def _look(self) -> None:
        began = time.monotonic()
        while not self._over.wait(1 / SAMPLES_A_SECOND):
            cpu, megabytes = _taken(self._process.pid)
            self.cpu, self.megabytes = max(self.cpu, cpu), max(self.megabytes, megabytes)
            if cpu > self._limit_cpu:
                self.ended = "time"
            elif megabytes > self._limit_megabytes:
                self.ended = "memory"
            elif time.monotonic() - began > PATIENCE * self._limit_cpu:
                self.ended = "no end"
            if self.ended:
                end_group(self._process.pid)
                return


def _taken(session: int) -> tuple[float, float]:
    """CPU seconds, those of ended children too, and megabytes in use by the processes of a session."""
    ticks = kilobytes = 0
    for folder in Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
            if int(fields[3]) != session:
                continue
            ticks += sum(map(int, fields[11:15]))
            kilobytes += _share(folder)
        except (OSError, ValueError, IndexError):
            continue
    return ticks / TICKS, kilobytes * 1024 / 1e6


def _share(folder: Path) -> int:
    """Kilobytes of a process; what several have in common, such as memory before a fork, counts once in all."""
    lines = (folder / "smaps_rollup").read_text().splitlines()
    return next((int(line.split()[1]) for line in lines if line.startswith("Pss:")), 0)
