"""What a study of many states takes on clusters up to 1 000 cores: overhead of Dask measured, the rest simulated.

    python tools/study_cluster.py [STATES]

A scheduler hands out one chunk after the other, each in the measured time; cores work on theirs side by side.
Seconds are those that the processor spends in this process, where the scheduler is and what waits for it, so that
others on the machine do not count.
"""

from __future__ import annotations

import heapq
import sys
import time
from pathlib import Path

from symgen.model.load import load_model
from symgen.study.asked.options import request_of
from symgen.study.chunks import chunk_grid
from symgen.study.plan import StudyPlan, planned_study
from symgen.study.work import Assignment, ChunkOutcome, handed_out

MODEL = Path(__file__).resolve().parent.parent / "models/rapkm_2rrr_rr.yaml"
# States a second of a core, as docs/study.md has them.
RATE = 45e6
# Chunks of which the overhead is measured, none of which takes any time.
IDLE_CHUNKS = 2000
CORES = (1, 10, 100, 1000)
STATES = 10**12


def idle(_: Assignment, number: int) -> ChunkOutcome:
    """A chunk that is done at once."""
    return ChunkOutcome(number)


def measured_overhead(assignment: Assignment) -> float:
    """Seconds of a processor that a scheduler and what waits for it take for a chunk."""
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        handed_out(client, idle, assignment, range(100), lambda _: None)
        began = time.process_time()
        handed_out(client, idle, assignment, range(IDLE_CHUNKS), lambda _: None)
        return (time.process_time() - began) / IDLE_CHUNKS


def simulated(chunks: int, cores: int, seconds: float, overhead: float) -> float:
    """Seconds until all chunks are done, each handed out after the one before, as soon as a core is free."""
    free = [0.0] * min(cores, chunks)
    handed = 0.0
    for _ in range(chunks):
        handed = max(handed, heapq.heappop(free)) + overhead
        heapq.heappush(free, handed + seconds)
    return max(free)


def plan_of(states: int) -> StudyPlan:
    """u of the RA-PKM along its circle over two masses, with about so many states."""
    side = max(1, round((states / 201) ** 0.5))
    over = [f"m_payload=0:1:{side}", f"m_1=0.1:0.5:{side}"]
    request, mistakes = request_of(MODEL, over, ["circle"], ["inputs"], None, None, None, ())
    return planned_study(load_model(MODEL), request, mistakes)


def main() -> int:
    """The table."""
    given = float(sys.argv[1]) if len(sys.argv) > 1 else float(STATES)
    plan = plan_of(int(given))
    assignment = Assignment(plan.request, Path("/shared/study.partial"), Path("/shared/study.partial/record"), "0" * 64)
    overhead = measured_overhead(assignment)
    chunks, states = len(chunk_grid(plan)), plan.points * plan.states
    seconds = states / chunks / RATE
    print(f"{states:.3g} states in {chunks} chunks of {seconds:.2f} s; {1e3 * overhead:.2f} ms of Dask each")
    for cores in CORES:
        took = simulated(chunks, cores, seconds, overhead)
        print(f"{cores:6} cores  {took:10.0f} s  {states / RATE / cores / took:6.1%}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
