"""Chunks worked out: by threads of this process, by processes of a local cluster, or by the workers of a scheduler.

The same bytes whoever works on them.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from symgen import __version__
from symgen.model.load import load_model
from symgen.study.asked.request import StudyMistakes, StudyRequest
from symgen.study.chunks import ChunkGrid, chunk_grid, chunk_values
from symgen.study.kernels import NoKernelsError, StudyKernels, kernels_hash, verified_result
from symgen.study.plan import StudyPlan, planned_study
from symgen.study.reductions import chunk_results
from symgen.study.states import StudyStates
from symgen.study.store import StudyStore

# How often a chunk is worked on: what fails a second time is reported.
TRIES = 2
# Of the time in which a scheduler has to answer.
CONNECTION_SECONDS = 10
Count = Callable[[int], None]
# Dask has its workers give memory back to the system beyond 64 kB; arrays of one chunk are as large as those of the
# next, and to have them anew each time takes a tenth of the time.
KEEPING_MEMORY = {"distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 2**30}
# Takes the address of a page that shows what workers do.
Dashboard = Callable[[str], None]


class NoSchedulerError(Exception):
    """A scheduler that does not answer any more, or has no workers that can work; the text says why."""


@dataclass(frozen=True, slots=True)
class ChunkOutcome:
    """What became of a chunk: nothing went wrong, or `failure` says what did, twice."""

    number: int
    failure: str | None = None


@dataclass(frozen=True, slots=True)
class StudyWork:
    """All that is needed to work a chunk out."""

    plan: StudyPlan
    chunks: ChunkGrid
    states: StudyStates
    kernels: StudyKernels
    store: StudyStore

    def work(self, number: int) -> ChunkOutcome:
        """Works a chunk out and writes it.  Raises OSError where it cannot be written."""
        if self.store.is_done(number):
            return ChunkOutcome(number)
        failure = ""
        for _ in range(TRIES):
            try:
                values = chunk_values(self.plan, self.chunks, number)
                results = chunk_results(self.plan, self.kernels, self.states, values)
            except Exception as error:
                failure = f"{type(error).__name__}: {error}"
            else:
                self.store.write(number, values, results)
                return ChunkOutcome(number)
        return ChunkOutcome(number, failure)


@dataclass(frozen=True, slots=True)
class Assignment:
    """What travels to a worker: the study, where it stands, where its verification's record is, and the hash of its
    kernels."""

    request: StudyRequest
    folder: Path
    record: Path
    kernels: str


def by_threads(work: StudyWork, numbers: Sequence[int], counted: Count) -> list[ChunkOutcome]:
    """Chunks by threads of this process, as many as Dask is configured for; kernels let go of Python's lock."""
    import dask
    from dask.callbacks import Callback

    done = 0

    def one_more(*_: object) -> None:
        nonlocal done
        done += 1
        counted(done)

    tasks = [dask.delayed(work.work, pure=False)(number) for number in numbers]
    with Callback(posttask=one_more):
        return list(dask.compute(*tasks, scheduler="threads"))


def by_processes(
    assignment: Assignment, workers: int, numbers: Sequence[int], counted: Count, dashboard: Dashboard
) -> list[ChunkOutcome]:
    """Chunks by processes of a local cluster; each makes the kernels anew from the model file.

    Its page is for this machine alone, and there is one where Bokeh is installed.
    """
    import dask
    from distributed import Client, LocalCluster

    with (
        dask.config.set(KEEPING_MEMORY),
        tempfile.TemporaryDirectory(prefix="symgen-study-") as folder,
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address="127.0.0.1:0",
            local_directory=folder,
        ) as cluster,
        Client(cluster) as client,
    ):
        if find_spec("bokeh") is not None:
            dashboard(client.dashboard_link)
        return _by_client(client, assignment, numbers, counted)


def by_scheduler(
    assignment: Assignment, address: str, numbers: Sequence[int], counted: Count, dashboard: Dashboard
) -> list[ChunkOutcome]:
    """Chunks by the workers of a scheduler that exists, which see the same files.  Raises NoSchedulerError."""
    from distributed import Client

    try:
        client = Client(address, timeout=CONNECTION_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise NoSchedulerError(f"no scheduler of Dask answers at {address}: {error}") from error
    with client:
        _check_workers(client, address)
        dashboard(client.dashboard_link)
        try:
            return _by_client(client, assignment, numbers, counted)
        except (OSError, CancelledError) as error:
            raise NoSchedulerError(f"the scheduler at {address} is lost") from error


def _by_client(client: Any, assignment: Assignment, numbers: Sequence[int], counted: Count) -> list[ChunkOutcome]:
    return handed_out(client, work_in_process, assignment, numbers, counted)


def handed_out(
    client: Any,
    work: Callable[[Assignment, int], ChunkOutcome],
    assignment: Assignment,
    numbers: Sequence[int],
    counted: Count,
) -> list[ChunkOutcome]:
    """What the workers of a client make of chunks by `work`, in the order of their numbers."""
    from distributed import as_completed

    futures = client.map(work, [assignment] * len(numbers), numbers, pure=False)
    outcomes = []
    for done, (_, outcome) in enumerate(as_completed(futures, loop=client.loop, with_results=True), 1):
        if isinstance(outcome, BaseException):  # a chunk that is lost with its scheduler
            raise outcome
        outcomes.append(outcome)
        counted(done)
    return sorted(outcomes, key=lambda one: one.number)


def _check_workers(client: Any, address: str) -> None:
    """Every worker has this version of symgen."""
    workers = client.run(version_in_process, on_error="return")
    if not workers:
        raise NoSchedulerError(f"the scheduler at {address} has no workers: start some")
    for name, version in sorted(workers.items()):
        if version != __version__:
            has = f"symgen {version}" if isinstance(version, str) else f"no symgen that can be used ({version})"
            raise NoSchedulerError(f"the worker {name} has {has}, and {__version__} is here: install the same")


def version_in_process() -> str:
    """The version of symgen of a worker."""
    return __version__


def work_in_process(assignment: Assignment, number: int) -> ChunkOutcome:
    """A chunk in a worker."""
    return _study_work(assignment).work(number)


@lru_cache(maxsize=1)
def _study_work(assignment: Assignment) -> StudyWork:
    plan = planned_study(load_model(assignment.request.model), assignment.request, StudyMistakes())
    result = verified_result(assignment.request.model, plan.kernels, assignment.record, lambda _: None, plan.scalars)
    if kernels_hash(result) != assignment.kernels:
        message = "a worker makes other kernels of the model file: it has another symgen, or the file has changed"
        raise NoKernelsError(message)
    chunks = chunk_grid(plan)
    kernels = StudyKernels(result)
    return StudyWork(plan, chunks, StudyStates(plan, kernels), kernels, StudyStore(assignment.folder, plan, chunks))
