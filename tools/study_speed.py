"""States per second of a study against the bare batch kernel: u of the RA-PKM along its circle, masses varied.

    python tools/study_speed.py [MODEL.yaml PATH PARAMETER PARAMETER]

Seconds are those that processors spend in this process, so that others on the machine do not count;
`wall` is what a clock says.  The bare kernel has as many states a call as fit in the caches, and keeps nothing of them.
The path is taken as it is in the file, and sampled more finely.
"""

from __future__ import annotations

import ctypes
import re
import resource
import sys
import tempfile
import time
from pathlib import Path

import dask
import numpy as np

from symgen.generation.results import Options, Result
from symgen.model.load import load_model
from symgen.pipeline import generate
from symgen.study.asked.options import request_of
from symgen.study.asked.request import check_request
from symgen.study.chunks import chunk_grid
from symgen.study.command import RECORD_FOLDER
from symgen.study.kernels import RECORD_FILE, StudyKernels, kernels_hash
from symgen.study.plan import StudyPlan, planned_study
from symgen.study.shown.summary import settings_of
from symgen.study.states import StudyStates
from symgen.study.store import StudyStore
from symgen.study.work import Assignment, StudyWork, by_processes, by_threads

DEFAULT = ("models/rapkm_2rrr_rr.yaml", "circle", "m_payload", "m_1")
BARE_STATES, BARE_CALLS = 2**12, 500
# Of a square of points, so that states are 2e7, 1e8 and 1e9.
STATES = (2e7, 1e8, 1e9)
# The same for processes, which take seconds each to start and to make the kernels.
STATES_OF_PROCESSES = (1e9, 4e9)
# How many times as many steps a path is sampled in.
FINER = (1, 5)


def plan_of(model: Path, path: str, names: tuple[str, str], side: int) -> StudyPlan:
    """Two masses from 0.1 to 0.5 kg, `side` values of each."""
    over = [f"{name}=0.1:0.5:{side}" for name in names]
    request, mistakes = request_of(model, over, [path], ["inputs"], None, None, None, ())
    check_request(mistakes, request)
    return planned_study(load_model(model), request, mistakes)


def bare(result: Result, kernels: StudyKernels, states: StudyStates, count: int) -> float:
    """States a second of the batch kernel alone with so many a call, the best of some rounds."""
    block = states.of(np.array([[0.1, 0.1]]))
    tiled = [np.tile(block.parts[name][0], count)[:, :count].copy() for name in ("q", "qd", "qdd")]
    out = np.empty((result.model.m, count))
    function = kernels._library[f"{result.model.c_name}_inverse_dynamics_batch"]
    pointers = [ctypes.c_void_p(one.ctypes.data) for one in (*tiled, block.parameters, out)]
    sizes = ctypes.c_size_t(count), ctypes.c_size_t(count)
    best = 0.0
    for _ in range(7):
        began = time.process_time()
        for _ in range(BARE_CALLS):
            function(*sizes, *pointers, None)
        best = max(best, BARE_CALLS * count / (time.process_time() - began))
    return best


def studied(plan: StudyPlan, result: Result, kernels: StudyKernels, threads: int) -> tuple[float, float]:
    """States a second of processors and of a clock."""
    chunks = chunk_grid(plan)
    with tempfile.TemporaryDirectory() as folder, dask.config.set(num_workers=threads):
        store = StudyStore(Path(folder) / "partial", plan, chunks)
        store.begin(settings_of(plan, kernels_hash(result)), {RECORD_FILE: result.files[RECORD_FILE]})
        work = StudyWork(plan, chunks, StudyStates(plan, kernels), kernels, store)
        work.states.of(np.array([[0.1, 0.1]]))  # the path is solved once
        began = time.process_time(), time.perf_counter()
        by_threads(work, range(len(chunks)), lambda _: None)
        spent = time.process_time() - began[0], time.perf_counter() - began[1]
    states = plan.points * plan.states
    return states / spent[0], states / spent[1]


def processed(plan: StudyPlan, result: Result, workers: int) -> tuple[float, float]:
    """The same of processes, each of which makes the kernels from the model file first."""
    chunks = chunk_grid(plan)
    with tempfile.TemporaryDirectory() as folder:
        partial = Path(folder) / "partial"
        store = StudyStore(partial, plan, chunks)
        record = f"{RECORD_FOLDER}/{plan.model.name}/{RECORD_FILE}"
        store.begin(settings_of(plan, kernels_hash(result)), {record: result.files[RECORD_FILE]})
        assignment = Assignment(plan.request, partial, partial / RECORD_FOLDER, kernels_hash(result))
        began = _children_seconds(), time.perf_counter()
        by_processes(assignment, workers, range(len(chunks)), lambda _: None, lambda _: None)
        spent = _children_seconds() - began[0], time.perf_counter() - began[1]
    states = plan.points * plan.states
    return states / spent[0], states / spent[1]


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def sampled(model: Path, finer: int, folder: Path) -> Path:
    """The model file with paths of so many times as many steps."""
    text = re.sub(
        r"samples: (\d+)", lambda one: f"samples: {finer * (int(one[1]) - 1) + 1}", model.read_text(encoding="utf-8")
    )
    made = folder / model.name
    made.write_text(text, encoding="utf-8")
    return made


def table(model: Path, path: str, names: tuple[str, str]) -> None:
    """Prints the rows of a model file."""
    plan = plan_of(model, path, names, 2)
    options = Options(outputs=plan.kernels, scalars=("float64",), parts=("c",), verify=False)
    result = generate(model, options, lambda _: None)
    kernels = StudyKernels(result)
    states = StudyStates(plan, kernels)
    alone = bare(result, kernels, states, BARE_STATES)
    print(f"| batch kernel alone | | {BARE_STATES} a call | {alone / 1e6:.1f} | | |")
    for wanted in STATES:
        plan = plan_of(model, path, names, round((wanted / plan.states) ** 0.5))
        for threads in (1, 2):
            runs = [studied(plan, result, kernels, threads) for _ in range(3 if wanted < STATES[-1] else 1)]
            best = max(one for one, _ in runs), max(one for _, one in runs)
            _row(f"{threads} thread{'s' * (threads > 1)}", plan, best, alone)
    for wanted in STATES_OF_PROCESSES:
        plan = plan_of(model, path, names, round((wanted / plan.states) ** 0.5))
        for workers in (1, 2):
            _row(f"{workers} process{'es' * (workers > 1)}", plan, processed(plan, result, workers), alone)


def _row(what: str, plan: StudyPlan, best: tuple[float, float], alone: float) -> None:
    rate, wall = best
    row = f"| {what} | {plan.states} | {plan.points * plan.states:,} | {rate / 1e6:.1f} "
    print(f"{row}| {100 * rate / alone:.0f} % | {wall / 1e6:.1f} |", flush=True)


def main(arguments: list[str]) -> None:
    """Prints the table."""
    file, path, *names = arguments or DEFAULT
    print("| | states of a point | states | million states per second of a core | of the bare kernel | wall |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for finer in FINER:
            table(sampled(Path(file), finer, Path(folder)), path, (names[0], names[1]))
    print(f"\nmemory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3:.0f} MB")


if __name__ == "__main__":
    main(sys.argv[1:])
