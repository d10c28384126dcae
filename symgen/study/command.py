"""`symgen study`: from a request to `study.zarr` and `study.html`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from symgen.generation.results import Result, WrongUseError
from symgen.model.load import load_model
from symgen.output.write import write_files
from symgen.study.asked.request import StudyMistakes, StudyRequest, check_request
from symgen.study.chunks import chunk_grid
from symgen.study.estimate import MOST_UNASKED_STATES, estimated
from symgen.study.kernels import RECORD_FILE, NoKernelsError, StudyKernels, kernels_hash, verified_result
from symgen.study.plan import StudyPlan, planned_study
from symgen.study.shown.compromises import compromise_picture, compromise_table, compromises
from symgen.study.shown.over_time import band_pictures, time_bands
from symgen.study.shown.page import study_page
from symgen.study.shown.pictures import study_pictures
from symgen.study.shown.summary import StudySummary, settings_of, settings_rows, summarised
from symgen.study.sizing.choice import motor_fits, sizing_lines, sizing_tables
from symgen.study.states import StudyStates
from symgen.study.store import PARTIAL, ZARR, StudyStore, is_own, kept_settings
from symgen.study.work import (
    Assignment,
    ChunkOutcome,
    NoSchedulerError,
    StudyWork,
    by_processes,
    by_scheduler,
    by_threads,
)

Progress = Callable[[str], None]
PAGE = "study.html"
RECORD_FOLDER = "record"
# Failed chunks that are listed; the others are counted.
MOST_LISTED_CHUNKS = 5


@dataclass(frozen=True, slots=True)
class StudyRun:
    """How a study is run: by so many processes as `workers`, by those of a `scheduler` at an address, or by threads;
    `agreed` takes any number of states."""

    out: Path
    workers: int | None
    scheduler: str | None
    agreed: bool
    quiet: bool


def run_study(request: StudyRequest, mistakes: StudyMistakes, run: StudyRun, progress: Progress) -> int:
    """Writes OUT/<model>/study.zarr and study.html; 0, or 1 where chunks failed or nothing can be assembled.

    Raises ModelError and WrongUseError for mistakes, and OSError where nothing can be written; what is done is kept
    then, and the same study continues.
    """
    check_request(mistakes, request)
    progress("reading the model")
    plan = planned_study(load_model(request.model), request, mistakes)
    folder = run.out / plan.model.name
    if not is_own(folder / ZARR):
        raise WrongUseError(f"{folder / ZARR} was not made by a study: move it, or name another folder with --out")
    try:
        work, assignment = _study_work(plan, folder, progress)
        progress("")
        _announce(work, run)
        outcomes = _worked(work, assignment, run, progress)
    except (NoKernelsError, NoSchedulerError) as error:
        progress("")
        print(f"{request.model}: {error}", file=sys.stderr)
        return 1
    return _finished(work, folder, outcomes, run, progress)


def _study_work(plan: StudyPlan, folder: Path, progress: Progress) -> tuple[StudyWork, Assignment]:
    """Kernels and states, and the folder of the study, in which work goes on where there is some of the same study."""
    partial = folder / PARTIAL
    result = _kernels(plan, partial, progress)
    progress("compiling")
    kernels = StudyKernels(result)
    chunks = chunk_grid(plan)
    store = StudyStore(partial, plan, chunks)
    work = StudyWork(plan, chunks, StudyStates(plan, kernels), kernels, store)
    store.begin(settings_of(plan, kernels_hash(result)), {_record(plan): result.files[RECORD_FILE]})
    # workers may have been started elsewhere
    request = replace(plan.request, model=plan.request.model.resolve())
    there = partial.resolve()
    return work, Assignment(request, there, there / RECORD_FOLDER, kernels_hash(result))


def _record(plan: StudyPlan) -> str:
    return f"{RECORD_FOLDER}/{plan.model.name}/{RECORD_FILE}"


def _kernels(plan: StudyPlan, partial: Path, progress: Progress) -> Result:
    """As an interrupted study of the same kernels has verified them, else verified now."""
    known = kept_settings(partial)
    if known == settings_of(plan, str(known.get("kernels_hash"))) and (partial / _record(plan)).is_file():
        result = verified_result(plan.request.model, plan.kernels, partial / RECORD_FOLDER, progress, plan.scalars)
        if kernels_hash(result) == known["kernels_hash"]:
            return result
    return verified_result(plan.request.model, plan.kernels, None, progress, plan.scalars)


def _announce(work: StudyWork, run: StudyRun) -> None:
    """Tells what the study takes; WrongUseError where that is more than anybody asks for by mistake."""
    estimate = estimated(work)
    name = work.plan.model.name
    if estimate.states > MOST_UNASKED_STATES and not run.agreed:
        if not work.store.is_begun:
            work.store.discard()
        raise WrongUseError(f"{name}: {estimate.text}; add --yes to run it")
    if not run.quiet:
        print(f"{name}: {estimate.text}", file=sys.stderr)


def _worked(work: StudyWork, assignment: Assignment, run: StudyRun, progress: Progress) -> list[ChunkOutcome]:
    """All chunks that are not there yet; what is done is kept whatever ends this."""
    total = len(work.chunks)
    numbers = [number for number in range(total) if not work.store.is_done(number)]
    if len(numbers) < total and not run.quiet:
        print(f"  {total - len(numbers)} of {total} chunks are there from before", file=sys.stderr)

    def counted(done: int) -> None:
        progress(f"working, {total - len(numbers) + done} of {total} chunks")

    def dashboard(address: str) -> None:
        if address and not run.quiet:
            progress("")
            print(f"  workers are seen at {address}", file=sys.stderr)

    counted(0)
    try:
        if run.scheduler is not None:
            return by_scheduler(assignment, run.scheduler, numbers, counted, dashboard)
        if run.workers is None:
            return by_threads(work, numbers, counted)
        return by_processes(assignment, run.workers, numbers, counted, dashboard)
    except BaseException as error:
        progress("")
        if not isinstance(error, NoKernelsError):
            done = sum(map(work.store.is_done, range(total)))
            print(f"\n{done} of {total} chunks are kept: the same command continues", file=sys.stderr)
        raise


def _finished(
    work: StudyWork, folder: Path, outcomes: Sequence[ChunkOutcome], run: StudyRun, progress: Progress
) -> int:
    """Results and page, and what failed; nothing is written where no state has a result."""
    import xarray

    plan = work.plan
    failed = [one for one in outcomes if one.failure is not None]
    progress("summing up")
    summary = summarised(work, failed)
    if not summary.valid:
        work.store.discard()
        progress("")
        print(f"{plan.request.model}: {summary.nowhere}", file=sys.stderr)
        _print_failed(failed, summary)
        return 1
    bands = () if failed else time_bands(work)
    work.store.finish(folder / ZARR, summary.attributes, [array for band in bands for array in band.arrays])
    progress("drawing")
    with xarray.open_zarr(folder / ZARR) as results:
        pictures = [*study_pictures(plan, results), *band_pictures(plan, bands)]
        fits, variants = motor_fits(plan, results), compromises(plan, results)
        pictures += map(compromise_picture, variants)
        tables = (*summary.tables, *sizing_tables(plan, fits), *(compromise_table(plan, results, v) for v in variants))
    title = f"Study of {plan.model.description or plan.model.name}"
    page = study_page(title, settings_rows(plan, summary), tables, pictures)
    (written,) = write_files(folder, {PAGE: page})
    progress("")
    if not run.quiet:
        print(*summary.lines, *sizing_lines(fits), "written:", f"  {folder / ZARR}", f"  {written}", "", sep="\n")
    _print_failed(failed, summary)
    return 1 if failed else 0


def _print_failed(failed: Sequence[ChunkOutcome], summary: StudySummary) -> None:
    """Chunks that failed twice, with their states and why."""
    for one in failed[:MOST_LISTED_CHUNKS]:
        print(f"chunk {one.number} failed twice: {one.failure}\n  {summary.failed[one.number]}", file=sys.stderr)
    if len(failed) > MOST_LISTED_CHUNKS:
        print(f"and {len(failed) - MOST_LISTED_CHUNKS} more chunks", file=sys.stderr)
