"""Chunks by threads and processes, interrupted, failing, on a full disk: the same bytes in the end, or a clear word."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from studied_arm import arm_file, opened, plan_of, study_of, threads, tree

from symgen.generation.results import WrongUseError
from symgen.study import work as work_module
from symgen.study.asked.options import request_of
from symgen.study.command import StudyRun, run_study
from symgen.study.kernels import NoKernelsError
from symgen.study.plan import StudyPlan
from symgen.study.store import DONE_FOLDER, StudyStore
from symgen.study.work import Assignment, by_threads, work_in_process

pytestmark = pytest.mark.toolchain
# Several chunks: what is along the path counts as states.
OVER = ["m=1:8:200", "l=0.3:0.8:10"]


def whole(folder: Path, plan: StudyPlan, number: int = 1) -> dict[str, bytes]:
    """The files of an undisturbed study."""
    work = study_of(folder / "partial", plan)
    assert len(work.chunks) > 3
    with threads(number):
        outcomes = by_threads(work, range(len(work.chunks)), lambda _: None)
    assert [one.failure for one in outcomes] == [None] * len(work.chunks)
    work.store.finish(folder / "study.zarr", {})
    return tree(folder / "study.zarr")


@pytest.fixture(scope="module")
def plan() -> StudyPlan:
    return plan_of(OVER, "inputs,power,singularity", along=("swing",), quantiles=("0.5",))


@pytest.fixture(scope="module")
def undisturbed(plan: StudyPlan, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return whole(tmp_path_factory.mktemp("undisturbed"), plan)


def test_two_threads_make_the_bytes_of_one(plan: StudyPlan, undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    assert whole(tmp_path, plan, number=2) == undisturbed


def test_samples_have_the_same_bytes_too(tmp_path: Path) -> None:
    plan = plan_of(["m=1:8", "g=5:10"], "inputs", sample="random", count=3000, along=("swing",))
    one, two = tmp_path / "one", tmp_path / "two"
    assert whole(one, plan) == whole(two, plan, number=2)


def test_an_interrupted_study_goes_on_where_it_was(
    plan: StudyPlan, undisturbed: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = study_of(tmp_path / "partial", plan)
    for number in (0, 2):
        first.work(number)
    # as a killed process leaves it: a chunk without its note, and a file that was not renamed yet
    (tmp_path / "partial" / DONE_FOLDER / "000002.json").unlink()
    (tmp_path / "partial" / "study.zarr" / "valid" / "c.0123.partial").write_bytes(b"half")
    again = study_of(tmp_path / "partial", plan)
    worked: list[int] = []
    chunk_values = work_module.chunk_values

    def counted(*given: Any) -> Any:
        worked.append(given[2])
        return chunk_values(*given)

    monkeypatch.setattr(work_module, "chunk_values", counted)
    with threads(1):
        by_threads(again, range(len(again.chunks)), lambda _: None)
    assert sorted(worked) == list(range(1, len(again.chunks)))
    again.store.finish(tmp_path / "study.zarr", {})
    assert tree(tmp_path / "study.zarr") == undisturbed


def test_another_study_does_not_take_up_what_is_there(plan: StudyPlan, tmp_path: Path) -> None:
    study_of(tmp_path / "partial", plan).work(0)
    other = study_of(tmp_path / "partial", plan_of(["m=1:7:40", "l=0.3:0.8:50"], "inputs", along=("swing",)))
    assert not any(map(other.store.is_done, range(len(other.chunks))))


def test_a_chunk_that_fails_once_is_tried_again(
    plan: StudyPlan, undisturbed: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed: list[int] = []
    chunk_results = work_module.chunk_results

    def failing(*given: Any) -> Any:
        failed.append(len(failed))
        if len(failed) == 2:
            raise ArithmeticError("struck by lightning")
        return chunk_results(*given)

    monkeypatch.setattr(work_module, "chunk_results", failing)
    assert whole(tmp_path, plan) == undisturbed
    assert len(failed) > 4


def test_a_chunk_that_fails_twice_is_reported_with_its_states(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    chunk_results = work_module.chunk_results

    def failing(plan: Any, kernels: Any, states: Any, values: np.ndarray) -> Any:
        if values[0, 0] == 4.5:
            raise ArithmeticError("struck by lightning")
        return chunk_results(plan, kernels, states, values)

    monkeypatch.setattr(work_module, "chunk_results", failing)
    request, mistakes = request_of(arm_file(), ["m=1:8:21", "g=5:10:399"], ["swing"], ["inputs"], None, None, None, ())
    code = run_study(request, mistakes, StudyRun(tmp_path, None, None, False, True), lambda _: None)
    complaint = capsys.readouterr().err
    assert code == 1
    assert "failed twice: ArithmeticError: struck by lightning" in complaint
    assert "399 points, m 4.5 to 4.5, g 5 to 10" in complaint
    with opened(tmp_path / "arm" / "study.zarr") as results:
        largest = results.inputs_largest.sel(input="u_1").values
        assert results.attrs["failed"] == ["399 points, m 4.5 to 4.5, g 5 to 10"]
    assert np.isnan(largest[10]).all()
    assert np.isfinite(np.delete(largest, 10, axis=0)).all()
    assert "m 4.5 to 4.5" in (tmp_path / "arm" / "study.html").read_text()


@pytest.mark.campaign
def test_a_full_disk_ends_a_study_that_goes_on_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    request, mistakes = request_of(arm_file(), ["m=1:8:2000"], ["swing"], ["inputs"], None, None, None, ())
    write = StudyStore.write

    def full(self: StudyStore, number: int, *given: Any) -> None:
        if number == 2:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "study.zarr")
        write(self, number, *given)

    run = StudyRun(tmp_path / "a", None, None, False, True)
    with monkeypatch.context() as context, threads(1):
        context.setattr(StudyStore, "write", full)
        with pytest.raises(OSError, match="No space left"):
            run_study(request, mistakes, run, lambda _: None)
    assert "chunks are kept: the same command continues" in capsys.readouterr().err
    assert not (tmp_path / "a" / "arm" / "study.zarr").exists()
    assert run_study(request, mistakes, run, lambda _: None) == 0
    assert run_study(request, mistakes, StudyRun(tmp_path / "b", None, None, False, True), lambda _: None) == 0
    assert tree(tmp_path / "a") == tree(tmp_path / "b")


def test_a_write_that_fails_leaves_no_note(plan: StudyPlan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    work = study_of(tmp_path / "partial", plan)

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("symgen.study.store.os.replace", full)
    with pytest.raises(OSError, match="No space"):
        work.work(0)
    assert not work.store.is_done(0)
    assert list((tmp_path / "partial" / DONE_FOLDER).iterdir()) == []


def test_a_worker_with_other_kernels_is_refused(plan: StudyPlan, tmp_path: Path) -> None:
    study_of(tmp_path / "partial", plan)
    with pytest.raises(NoKernelsError, match="a worker makes other kernels"):
        work_in_process(Assignment(plan.request, tmp_path / "partial", tmp_path / "record", "0" * 64), 0)


def test_results_of_others_are_not_replaced(tmp_path: Path) -> None:
    foreign = tmp_path / "arm" / "study.zarr"
    foreign.mkdir(parents=True)
    (foreign / "precious").write_text("data")
    request, mistakes = request_of(arm_file(), ["m=1:8:5"], ["swing"], ["inputs"], None, None, None, ())
    with pytest.raises(WrongUseError, match="was not made by a study"):
        run_study(request, mistakes, StudyRun(tmp_path, None, None, False, True), lambda _: None)
    assert (foreign / "precious").read_text() == "data"


def command(out: Path, *more: str) -> list[str]:
    given = ["--over", "m=1:8:200", "--over", "g=5:10:200", "--along", "swing", "--show", "inputs,power,singularity"]
    return [sys.executable, "-m", "symgen", "study", str(arm_file()), *given, "--out", str(out), *more]


@pytest.mark.campaign
def test_two_processes_make_the_bytes_of_threads(tmp_path: Path) -> None:
    subprocess.run(command(tmp_path / "threads"), check=True, capture_output=True, timeout=300)
    subprocess.run(command(tmp_path / "processes", "--workers", "2"), check=True, capture_output=True, timeout=300)
    assert len(tree(tmp_path / "threads")) > 20
    assert tree(tmp_path / "threads") == tree(tmp_path / "processes")


@pytest.mark.campaign
@pytest.mark.parametrize("workers", [(), ("--workers", "1")])
def test_a_study_that_is_killed_ends_with_the_bytes_of_an_undisturbed_one(
    tmp_path: Path, workers: tuple[str, ...]
) -> None:
    subprocess.run(command(tmp_path / "undisturbed"), check=True, capture_output=True, timeout=300)
    done = tmp_path / "killed" / "arm" / "study.partial" / DONE_FOLDER
    with subprocess.Popen(
        command(tmp_path / "killed", *workers), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        ends = time.monotonic() + 200
        while not (done.is_dir() and any(done.glob("*.json"))) and time.monotonic() < ends:
            time.sleep(0.001)
        process.send_signal(signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    kept = len(list(done.glob("*.json")))
    assert 0 < kept < 64
    again = subprocess.run(command(tmp_path / "killed"), check=True, capture_output=True, text=True, timeout=300)
    assert "chunks are there from before" in again.stderr
    assert tree(tmp_path / "killed") == tree(tmp_path / "undisturbed")
