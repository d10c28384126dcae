"""Studies on a cluster of Dask that exists: a scheduler and workers, each a process that the study did not start."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from studied_arm import arm_file, tree
from study_packages import distributed

from symgen.cli.main import main
from symgen.study import work as work_module
from symgen.study.store import DONE_FOLDER
from symgen.study.work import NoSchedulerError, by_scheduler

pytestmark = [pytest.mark.toolchain, pytest.mark.campaign]
GIVEN = ("--over", "m=1:8:200", "--over", "g=5:10:200", "--along", "swing", "--show", "inputs,power,singularity")


class Cluster:
    """A scheduler with workers, which can be ended one by one."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._folder, self._stack = folder, stack
        contact = folder / "scheduler.json"
        where = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(contact))
        self.scheduler = self._started("scheduler", *where)
        ends = time.monotonic() + 60
        while not contact.is_file() and time.monotonic() < ends:
            time.sleep(0.05)
        with distributed.Client(scheduler_file=str(contact), timeout=60, set_as_default=False) as client:
            self.address: str = client.scheduler.address
            self.worker = self._started("worker", "--nthreads", "1", "--no-nanny", "--no-dashboard", self.address)
            client.wait_for_workers(1, timeout=60)

    def _started(self, *command: str) -> subprocess.Popen[bytes]:
        # no module of `dask` is `dask` on the command line
        start = "import sys; from dask.__main__ import main; sys.argv[0] = 'dask'; main()"
        process = subprocess.Popen(
            [sys.executable, "-c", start, *command],
            cwd=self._folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self._stack.callback(process.wait)
        self._stack.callback(process.kill)
        return process


@pytest.fixture
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    with ExitStack() as stack:
        yield Cluster(tmp_path_factory.mktemp("cluster"), stack)


def studied(out: Path, *more: str) -> int:
    return main(["study", str(arm_file()), *GIVEN, "--out", str(out), "--quiet", *more])


def test_its_workers_make_the_bytes_of_threads(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # the workers of a cluster do not stand where the study does
    monkeypatch.chdir(tmp_path)
    assert main(["study", arm_file().name, *GIVEN, "--quiet"]) == 2
    (tmp_path / "arm.yaml").write_bytes(arm_file().read_bytes())
    assert main(["study", "arm.yaml", *GIVEN, "--out", "cluster", "--scheduler", cluster.address]) == 0
    assert re.search(r"workers are seen at http://.*:\d+/status", capsys.readouterr().err)
    assert studied(tmp_path / "threads") == 0
    assert len(tree(tmp_path / "threads")) > 20
    assert tree(tmp_path / "threads") == tree(tmp_path / "cluster")


def test_a_lost_scheduler_ends_a_study_that_goes_on_later(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    by_client = work_module._by_client

    def lost(client: Any, assignment: Any, numbers: Any, counted: Any) -> Any:
        def killing(done: int) -> None:
            counted(done)
            cluster.scheduler.kill()

        return by_client(client, assignment, numbers, killing)

    monkeypatch.setattr(work_module, "_by_client", lost)
    assert studied(tmp_path / "lost", "--scheduler", cluster.address) == 1
    complaint = capsys.readouterr().err
    assert f"the scheduler at {cluster.address} is lost" in complaint
    assert "chunks are kept: the same command continues" in complaint
    assert any((tmp_path / "lost/arm/study.partial" / DONE_FOLDER).glob("*.json"))
    assert studied(tmp_path / "lost") == 0
    assert studied(tmp_path / "undisturbed") == 0
    assert tree(tmp_path / "lost") == tree(tmp_path / "undisturbed")


def test_a_worker_with_another_symgen_is_refused_by_name(cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(work_module, "__version__", "9.9.9")
    with pytest.raises(NoSchedulerError, match=r"the worker tcp://127\.0\.0\.1:\d+ has symgen .*, and 9\.9\.9 is here"):
        by_scheduler(None, cluster.address, [0], lambda _: None, print)


def test_a_scheduler_without_workers_or_none_at_all_is_said(
    cluster: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    with distributed.Client(cluster.address, set_as_default=False) as client:
        cluster.worker.kill()
        ends = time.monotonic() + 60
        while client.scheduler_info()["workers"] and time.monotonic() < ends:
            time.sleep(0.05)
    with pytest.raises(NoSchedulerError, match="has no workers: start some"):
        by_scheduler(None, cluster.address, [0], lambda _: None, print)
    monkeypatch.setattr(work_module, "CONNECTION_SECONDS", 1)
    cluster.scheduler.kill()
    cluster.scheduler.wait()
    with pytest.raises(NoSchedulerError, match="no scheduler of Dask answers at"):
        by_scheduler(None, cluster.address, [0], lambda _: None, print)


def test_two_clusters_are_one_too_many(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert studied(tmp_path, "--workers", "2", "--scheduler", "tcp://127.0.0.1:1") == 2
    assert "--workers and --scheduler are two clusters" in capsys.readouterr().err
