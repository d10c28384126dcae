"""Signals end a run with all that it started, and what is said of the output is true; so do odd compilers."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from symgen.cli.main import main
from symgen.runtime import processes
from symgen.runtime.processes import ToolError, run
from symgen.verify.running import compile as compiling

MODEL = """model: {name}
coordinates: {{x: {{unit: m}}, phi: {{unit: rad}}}}
parameters: {{M: {{value: 3, unit: kg}}, L: {{value: 0.7, unit: m}}}}
kinetic_energy: M*(x_dot**2 + L*x_dot*phi_dot*cos(phi) + L**2*phi_dot**2)
inputs:
  push: {{acts_on: {{x: 1}}}}
  turn: {{acts_on: {{phi: 1}}}}
"""
# The driver starts the compiler proper, which hangs where the model's name is in its arguments.
HANGING = """#!/bin/sh
case "$*" in
  *--version*) echo odd 1.0 ;;
  *{name}*) echo $$ >> "{marks}"; touch "$TMPDIR/kept"; sh -c 'echo $$ >> "{marks}"; exec sleep 300'; exit 1 ;;
  *) exec cc "$@" ;;
esac
"""


def odd_compiler(folder: Path, text: str) -> Path:
    path = folder / "oddcc"
    path.write_text(text)
    path.chmod(0o755)
    return path


def runs(process: int, patience: float = 10.0) -> bool:
    """Whether a process still runs after so many seconds; one that ends is not waited for any longer."""
    for _ in range(int(patience / 0.02)):
        try:
            with open(f"/proc/{process}/stat") as stat:
                if stat.read().rpartition(")")[2].split()[0] == "Z":
                    return False
        except FileNotFoundError:
            return False
        time.sleep(0.02)
    return True


def model(folder: Path, name: str) -> Path:
    path = folder / f"{name}.yaml"
    path.write_text(MODEL.format(name=name))
    return path


ENDINGS = {
    signal.SIGINT: (130, "interrupted"),
    signal.SIGTERM: (143, "terminated"),
    signal.SIGHUP: (129, "ended with its terminal"),
}


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="processes are looked up in /proc")
@pytest.mark.parametrize(
    ("first", "number"),
    [
        *(pytest.param(True, number, marks=pytest.mark.campaign) for number in ENDINGS if number != signal.SIGTERM),
        (True, signal.SIGTERM),
        pytest.param(False, signal.SIGTERM, marks=pytest.mark.campaign),
    ],
    ids=lambda given: given.name if isinstance(given, signal.Signals) else "nothing" if given else "one model",
)
def test_a_signal_ends_compilers_and_says_what_was_written(
    tmp_path: Path, number: signal.Signals, first: bool, tool: Callable[[str], str]
) -> None:
    if not first:
        tool("cc")
    marks, temporary = tmp_path / "marks", tmp_path / "tmp"
    temporary.mkdir()
    compiler = odd_compiler(tmp_path, HANGING.format(name="hanging", marks=marks))
    models = [*([] if first else [str(model(tmp_path, "quick"))]), str(model(tmp_path, "hanging"))]
    command = [sys.executable, "-m", "symgen", *models, "--only", "c", "--quiet", "--out", str(tmp_path / "out")]
    environment = {**os.environ, "CC": str(compiler), "TMPDIR": str(temporary)}
    started = subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=_listening
    )
    assert started.stderr is not None
    with started.stderr:
        # one driver and one compiler for each of two scalar types
        while not marks.exists() or len(marks.read_text().split()) < 4:
            assert started.poll() is None, started.stderr.read()
            time.sleep(0.02)
        started.send_signal(number)
        started.send_signal(number)  # a second one must not break off the cleaning up
        errors = started.stderr.read()
        code, word = ENDINGS[number]
        assert started.wait(30) == code
    assert not any(map(runs, map(int, marks.read_text().split())))
    assert not list(temporary.iterdir())
    assert "Traceback" not in errors
    if first:
        assert errors.endswith(f"{word}; earlier output is unchanged\n")
        assert not (tmp_path / "out").exists()
    else:
        folder = tmp_path / "out/quick"
        assert errors.endswith(f"{word}; new files are in {folder}, each complete; all else is unchanged\n")
        assert (folder / "c/quick.c").exists()
        assert not (tmp_path / "out/hanging").exists()


@pytest.mark.campaign
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="processes are looked up in /proc")
def test_a_run_that_is_killed_leaves_no_compiler(tmp_path: Path) -> None:
    marks = tmp_path / "marks"
    compiler = odd_compiler(tmp_path, HANGING.format(name="hanging", marks=marks))
    command = [sys.executable, "-m", "symgen", str(model(tmp_path, "hanging")), "--quiet", "--out", str(tmp_path)]
    environment = {**os.environ, "CC": str(compiler), "TMPDIR": str(tmp_path)}
    started = subprocess.Popen(command, env=environment, start_new_session=True)
    while not marks.exists() or len(marks.read_text().split()) < 4:
        assert started.poll() is None
        time.sleep(0.02)
    started.kill()
    started.wait()
    assert not any(map(runs, map(int, marks.read_text().split())))


def _listening() -> None:
    """Signals as a terminal sends them, whatever the tests themselves run under: `nohup` ignores some."""
    for number in ENDINGS:
        signal.signal(number, signal.SIG_DFL)


def test_the_guardian_lets_groups_that_have_ended_alone() -> None:
    # of two groups the one that was forgotten goes on when the watching process ends
    script = (
        "import os, subprocess\nfrom symgen.runtime import guardian\n"
        "quiet = {'stdout': subprocess.DEVNULL, 'process_group': 0}\n"
        "groups = [subprocess.Popen(['sleep', '30'], **quiet) for _ in range(2)]\n"
        "for group in groups:\n    guardian.watch(group.pid)\n"
        "guardian.forget(groups[0].pid)\nprint(*(group.pid for group in groups), flush=True)\nos._exit(0)\n"
    )
    process = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, check=True)
    forgotten, watched = map(int, process.stdout.split())
    try:
        assert not runs(watched)
        # the guardian has ended what it ends
        assert runs(forgotten, 0.5)
    finally:
        os.kill(forgotten, signal.SIGKILL)


def test_a_hangup_that_is_ignored_stays_ignored() -> None:
    script = (
        "import os, signal, sys\nfrom symgen.cli.signals import signals_end_the_run\n"
        "signal.signal(signal.SIGHUP, signal.SIG_IGN)\n"
        "with signals_end_the_run(process_ends=False):\n    os.kill(os.getpid(), signal.SIGHUP)\n"
        "    print('still here')\n"
    )
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout == "still here\n"


QUICK = ("does not answer", "makes nothing", "makes no library")
ODD = {
    "does not answer": ("sleep 60\n", "did not end within 1 s", 2),
    "hangs": ('case "$*" in *--version*) echo odd ;; *) sleep 60 ;; esac\n', "did not end within", 1),
    "fails without a word": ('case "$*" in *--version*) echo odd ;; *) exit 3 ;; esac\n', "ended with 3", 1),
    "dies": ('case "$*" in *--version*) echo odd ;; *) kill -SEGV $$ ;; esac\n', "ended with -11", 1),
    "makes nothing": ("echo odd\n", "made no file", 1),
    "makes no library": (
        'case "$*" in *--version*) echo odd; exit ;; esac\n'
        'while [ "$1" != -o ]; do shift; done\necho odd > "$2"\n', "made no library that loads here", 1
    ),
    "makes another library": (
        'case "$*" in *--version*) echo odd; exit ;; esac\n'
        'while [ "$1" != -o ]; do shift; done\necho "int other;" | cc -shared -xc - -o "$2"\n', "a library without", 2
    ),
}


@pytest.mark.parametrize(
    "case", [case if case in QUICK else pytest.param(case, marks=pytest.mark.campaign) for case in ODD]
)
def test_an_odd_compiler_is_an_error_with_a_remedy(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    tool: Callable[[str], str],
) -> None:
    body, expected, code = ODD[case]
    if "| cc " in body:
        tool("cc")
    monkeypatch.setenv("CC", str(odd_compiler(tmp_path, f"#!/bin/sh\n{body}")))
    monkeypatch.setattr(compiling, "LONGEST_ANSWER", 1.0)
    # each of several files is waited for
    monkeypatch.setattr(compiling, "LONGEST_COMPILATION", 0.2 if case == "hangs" else 1.0)
    out = tmp_path / "out"
    given = ["--only", "c", "--scalar", "float64", "--out", str(out), "--quiet"]
    assert main([str(model(tmp_path, "cart")), *given]) == code
    errors = capsys.readouterr().err
    assert expected in errors
    assert compiling.REMEDY in errors
    assert "internal error" not in errors
    assert not (out / "cart").exists()


def test_bytes_that_are_no_text_are_printed_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    compiler = odd_compiler(tmp_path, "#!/bin/sh\nprintf '\\377\\376 odd\\n'\nexit 1\n")
    monkeypatch.setenv("CC", str(compiler))
    assert main([str(model(tmp_path, "cart")), "--only", "c", "--out", str(tmp_path / "out"), "--quiet"]) == 1
    assert "\ufffd\ufffd odd" in capsys.readouterr().err


def test_a_tool_that_leaves_its_output_open_in_the_background_holds_nobody(tmp_path: Path) -> None:
    began = time.monotonic()
    completed = run(["sh", "-c", "echo done; sleep 20 &"], 10.0, tmp_path)
    assert (completed.returncode, completed.stdout) == (0, "done\n")
    assert time.monotonic() - began < 10


def test_a_tool_that_is_missing_or_late_is_a_tool_error(tmp_path: Path) -> None:
    with pytest.raises(ToolError, match="no-such-tool cannot be started"):
        run(["no-such-tool"], 1.0)
    with pytest.raises(ToolError, match=r"sleep did not end within 0\.2 s"):
        run(["sleep", "20"], 0.2, tmp_path)


def test_the_same_signal_once_more_does_not_kill_a_process_that_ends() -> None:
    """It may come when the run is over and what became of its files is not told yet."""
    code = (
        "import os, signal, sys\nfrom symgen.cli.signals import EndedError, signals_end_the_run\n"
        # under nohup it is ignored, here as in a run
        "signal.signal(signal.SIGHUP, signal.SIG_DFL)\n"
        "def send():\n    os.kill(os.getpid(), signal.SIGHUP)\n"
        "try:\n    with signals_end_the_run(process_ends=True):\n        send()\n"
        "except EndedError as ending:\n    send()\n    print('told')\n    sys.exit(ending.number)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (129, "told\n")
    # where the process goes on, signals are the caller's again
    done = subprocess.run(
        [sys.executable, "-c", code.replace("True", "False")], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (-signal.SIGHUP, "")


@pytest.mark.skipif(os.name != "posix", reason="elsewhere processes have no such lock")
def test_a_lock_that_nobody_lets_go_of_holds_no_run() -> None:
    """A signal whose handler raises while a tool is waited for may leave it so."""
    process = processes.start(["sleep", "60"])
    process._waitpid_lock.acquire()
    stopping = threading.Thread(target=processes.stop, args=(process,), daemon=True)
    stopping.start()
    stopping.join(20)
    assert not stopping.is_alive()
    assert process.returncode == -signal.SIGKILL
