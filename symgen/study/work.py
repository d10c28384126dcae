"""Chunks worked out: by threads of this process, or by processes of a local cluster; the same bytes either way."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

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
Count = Callable[[int], None]


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


def by_processes(assignment: Assignment, workers: int, numbers: Sequence[int], counted: Count) -> list[ChunkOutcome]:
    """Chunks by processes of a local cluster; each makes the kernels anew from the model file."""
    from distributed import Client, LocalCluster, as_completed

    with (
        tempfile.TemporaryDirectory(prefix="symgen-study-") as folder,
        LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address=None,
            local_directory=folder,
        ) as cluster,
        Client(cluster) as client,
    ):
        futures = client.map(work_in_process, [assignment] * len(numbers), numbers, pure=False)
        outcomes = []
        for done, (_, outcome) in enumerate(as_completed(futures, with_results=True), 1):
            outcomes.append(outcome)
            counted(done)
    return sorted(outcomes, key=lambda one: one.number)


def work_in_process(assignment: Assignment, number: int) -> ChunkOutcome:
    """A chunk in a worker."""
    return _study_work(assignment).work(number)


@lru_cache(maxsize=1)
def _study_work(assignment: Assignment) -> StudyWork:
    plan = planned_study(load_model(assignment.request.model), assignment.request, StudyMistakes())
    result = verified_result(assignment.request.model, plan.kernels, assignment.record, lambda _: None)
    if kernels_hash(result) != assignment.kernels:
        message = "a worker makes other kernels of the model file: it has another symgen, or the file has changed"
        raise NoKernelsError(message)
    chunks = chunk_grid(plan)
    kernels = StudyKernels(result)
    return StudyWork(plan, chunks, StudyStates(plan, kernels), kernels, StudyStore(assignment.folder, plan, chunks))
