"""States per second of a study against the bare batch kernel: u of the RA-PKM along its circle, masses varied.

    python tools/study_speed.py [MODEL.yaml PATH PARAMETER PARAMETER]

Seconds are those that processors spend in this process, so that others on the machine do not count;
`wall` is what a clock says.  The bare kernel has as many states a call as fit in the caches, and keeps nothing of them.
"""

from __future__ import annotations

import ctypes
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
from symgen.study.kernels import RECORD_FILE, StudyKernels, kernels_hash
from symgen.study.plan import StudyPlan, planned_study
from symgen.study.shown.summary import settings_of
from symgen.study.states import StudyStates
from symgen.study.store import StudyStore
from symgen.study.work import StudyWork, by_threads

DEFAULT = ("models/rapkm_2rrr_rr.yaml", "circle", "m_payload", "m_1")
BARE_STATES, BARE_CALLS = 2**12, 500
SIDES = (320, 700, 2236)


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


def main(arguments: list[str]) -> None:
    """Prints the table."""
    file, path, *names = arguments or DEFAULT
    model, pair = Path(file), (names[0], names[1])
    plan = plan_of(model, path, pair, 2)
    options = Options(outputs=plan.kernels, scalars=("float64",), parts=("c",), verify=False)
    result = generate(model, options, lambda _: None)
    kernels = StudyKernels(result)
    print("| | states | million states per second of a core | of the bare kernel | wall |\n|---|---|---|---|---|")
    states = StudyStates(plan, kernels)
    alone = bare(result, kernels, states, BARE_STATES)
    print(f"| batch kernel alone | {BARE_STATES} a call | {alone / 1e6:.1f} | | |")
    short = bare(result, kernels, states, plan.states)
    print(f"| the same | {plan.states} a call | {short / 1e6:.1f} | {100 * short / alone:.0f} % | |")
    for side in SIDES:
        plan = plan_of(model, path, pair, side)
        for threads in (1, 2):
            runs = [studied(plan, result, kernels, threads) for _ in range(3 if side < SIDES[-1] else 1)]
            rate, wall = max(one for one, _ in runs), max(one for _, one in runs)
            row = f"| {threads} thread{'s' * (threads > 1)} | {plan.points * plan.states:,} | {rate / 1e6:.1f} "
            print(f"{row}| {100 * rate / alone:.0f} % | {wall / 1e6:.1f} |", flush=True)
    print(f"\nmemory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3:.0f} MB")


if __name__ == "__main__":
    main(sys.argv[1:])
