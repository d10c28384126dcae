"""u of mechanisms given by bodies beside peers that walk the frames: instructions, times, differences.

States are drawn from the ranges of the coordinates, without a search for loops that close: instructions hardly depend
on the state, and u is defined off the manifold as well.  Every kernel is compared with the cheapest peer, whose
derivation shares nothing with symgen's; exactness is the matter of symgen's own verification.
"""

from __future__ import annotations

import random
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import symgen
from symgen.generation.draft import Draft
from symgen.generation.results import WrongUseError
from symgen.laboratory.bench.build import TIMED_STATES, CandidateFootprint, build, find_gcc, nanoseconds, results_of
from symgen.laboratory.bench.callgrind import count_instructions, find_valgrind
from symgen.laboratory.bench.candidate import CCandidate, Task
from symgen.laboratory.bench.peers.mechanism_roster import mechanism_peers
from symgen.laboratory.bench.peers.pinocchio_program import Timed, pinocchio_time
from symgen.laboratory.bench.symgen_kernels import generated, symgen_candidates
from symgen.laboratory.bench.workload import Workload
from symgen.model.blocks.allocation import without_allocation
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model
from symgen.model.model import Model

Progress = Callable[[str], None]
TASK = "inverse_dynamics"
COUNTED_STATES = 24
PASSES = 101


@dataclass(frozen=True, slots=True)
class MeasuredKernel:
    """What one kernel took; `difference` is the median of |u - u'|/|u'| against the cheapest peer."""

    generator: str
    form: str
    nanoseconds: float
    instructions: float | None
    footprint: CandidateFootprint
    operations: Mapping[str, int] | None
    difference: float


@dataclass(frozen=True, slots=True)
class MechanismBenchmark:
    """The kernels of one mechanism; `pinocchio` is its nanoseconds and difference, or why there are none."""

    model: str
    form: str
    kernels: tuple[MeasuredKernel, ...]
    left_out: tuple[tuple[str, str], ...]
    pinocchio: tuple[float, float] | str
    notes: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """A JSON-able form."""
        return {"symgen": symgen.__version__, **asdict(self)}


def mechanism_benchmark(path: Path, progress: Progress, out: Path | None = None) -> MechanismBenchmark:
    """Measure u of one mechanism.

    symgen's kernel is that of OUT/<model>, where a run has verified one; without `out`, what derivation chooses.

    Raises ModelError for mistakes in the file, WrongUseError without gcc, or where there is no u.
    """
    import numpy as np

    model = measurable(path)
    task = Task(TASK, "qdd", model.m)
    states = drawn_states(model, TIMED_STATES)
    load = Workload("float64", np.array(states), np.zeros((len(states), model.m)), np.zeros((len(states), model.m)), [])
    progress("deriving u")
    draft = measured_draft(path, model, task, out)
    form = draft.choice(TASK).title
    programs = {form: draft.written}
    progress("writing peers")
    peers, left_out = mechanism_peers(model, load.states)
    candidates = [*symgen_candidates(model, programs, "float64"), *peers]
    kernels, exact = measured_kernels(model, task, candidates, load, progress)
    progress("running Pinocchio")
    timed = pinocchio_time(model, states)
    if isinstance(timed, Timed):
        return MechanismBenchmark(
            model.name, form, tuple(kernels), left_out, (timed.nanoseconds, _difference(np.array(timed.u), exact)),
            draft.notes,
        )
    return MechanismBenchmark(model.name, form, tuple(kernels), left_out, timed, draft.notes)


def measurable(path: Path) -> Model:
    """The model of a file, without its allocation: peers have none.

    Raises ModelError for mistakes in the file, WrongUseError without gcc, or where there is no u.
    """
    if find_gcc() is None:
        raise WrongUseError("symgen bench compiles everything with gcc, and there is no gcc on this machine")
    model = without_allocation(load_model(path))
    if not model.m:
        raise WrongUseError(f"{path}: nothing to measure, the model has no inputs")
    return model


def measured_draft(path: Path, model: Model, task: Task, out: Path | None) -> Draft:
    """What is measured of symgen, as a run under `out` has verified it, or as derivation chooses."""
    draft = generated(model, task, ("float64",), out)
    if draft.derivations.left_out:
        raise WrongUseError(f"{path}: nothing to measure: {'; '.join(draft.notes)}")
    return draft


def measured_kernels(
    model: Model, task: Task, candidates: Sequence[CCandidate], load: Workload, progress: Progress
) -> tuple[list[MeasuredKernel], Any]:
    """What each kernel took, and the results of the peer that takes least, which the others are compared with."""
    with tempfile.TemporaryDirectory(prefix="symgen-bench-") as folder:
        progress(f"compiling {len(candidates)} kernels")
        built = build(Path(folder), model, task, candidates, {"float64": load})
        progress("running")
        results = results_of(built, Path(folder), candidates, task)
        times = nanoseconds(built, PASSES)
        entries = [candidate.entry for candidate in candidates]
        counts = count_instructions(built.program, COUNTED_STATES, entries) if find_valgrind() else {}
        # where there are no peers, symgen's other kernel
        others = [c for c in candidates if c.generator != "symgen"] or candidates[-1:]
        exact = results[min(others, key=lambda c: counts.get(c.entry, times[c.entry])).entry]
        kernels = [
            MeasuredKernel(
                generator=c.generator,
                form=c.form,
                nanoseconds=times[c.entry],
                instructions=counts.get(c.entry),
                footprint=built.footprints[c.entry],
                operations=c.operations,
                difference=_difference(results[c.entry], exact),
            )
            for c in candidates
        ]
    return kernels, exact


def drawn_states(model: Model, count: int) -> list[list[float]]:
    """Rows q, qd, qdd, p with the parameters' default values; seeded."""
    source = random.Random(1)
    usual = default_values(model.parameters)
    rows = []
    for _ in range(count):
        q = [source.uniform(float(c.range[0]), float(c.range[1])) for c in model.coordinates]
        rates = [source.uniform(-1.0, 1.0) for _ in range(2 * model.n)]
        rows.append([*q, *rates, *(usual[one.name] for one in model.parameters)])
    return rows


def _difference(computed: Any, exact: Any) -> float:
    import numpy as np

    return float(np.median(np.linalg.norm(computed - exact, axis=1) / np.linalg.norm(exact, axis=1)))
