"""The whole benchmark on one page: states and exact results, candidates, one program, times, counts, errors."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Any

import symgen
from symgen.generation.draft import Draft
from symgen.generation.results import WrongUseError
from symgen.ir.kernel import Program, Scalar
from symgen.laboratory.bench.batch import BEST_PEERS, Many, many_states
from symgen.laboratory.bench.build import Built, CandidateFootprint, build, find_gcc, nanoseconds, results_of
from symgen.laboratory.bench.callgrind import count_instructions, find_valgrind
from symgen.laboratory.bench.candidate import CCandidate, PythonCandidate, Task
from symgen.laboratory.bench.pareto import pareto_front
from symgen.laboratory.bench.peers.roster import in_single, peers, python_peers
from symgen.laboratory.bench.python_timing import run_python
from symgen.laboratory.bench.symgen_kernels import generated, programs_of, symgen_candidates, symgen_python
from symgen.laboratory.bench.workload import Errors, Workload, admissible_samples, beyond_tolerance, errors_of, workload
from symgen.model.blocks.allocation import without_allocation
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.model.quantities import MAIN, ROWS
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import Sample

SCALARS: tuple[Scalar, ...] = ("float64", "float32")
OTHER_STATES = 250  # of all but inverse dynamics
COUNTED_STATES = 64
# Measured beside what the equations of motion are solved for: one state at a time, in C.
MATRICES = (
    "mass_matrix",
    "coriolis_matrix",
    "coriolis_force",
    "constraint_jacobian",
    "nullspace_projector",
    "nullspace_projector_dot",
    "projected_control_pseudoinverse",
)
PASSES = 301
Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class MeasuredCandidate:
    """What one candidate took and how far off it was.

    `beyond` is the number of states at which symgen's generated kernel is beyond the tolerance, None for all others.
    `nanoseconds` is the median of one call (Python: a state of one call for all states), `instructions` the mean of a
    call or None without valgrind, `footprint` is None for Python.
    """

    generator: str
    form: str
    language: str
    scalar: Scalar
    nanoseconds: float
    single_nanoseconds: float | None
    instructions: float | None
    footprint: CandidateFootprint | None
    operations: Mapping[str, int] | None
    errors: Errors
    chosen: bool
    on_front: bool = False
    beyond: int | None = None

    @property
    def label(self) -> str:
        """The name in tables and charts, without the scalar type."""
        return f"{self.generator} {self.form}"


@dataclass(frozen=True, slots=True)
class Comparison:
    """All candidates of one quantity."""

    task: Task
    states: int
    measured: tuple[MeasuredCandidate, ...]
    left_out: tuple[tuple[str, str], ...]
    many: tuple[Many, ...] = ()


@dataclass(frozen=True, slots=True)
class Benchmark:
    """What `symgen bench` measured for one model."""

    model: str
    comparisons: tuple[Comparison, ...]
    notes: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """A JSON-able form; an infinite error is null."""
        return {
            "model": self.model,
            "symgen": symgen.__version__,
            "notes": list(self.notes),
            "comparisons": [
                {
                    "quantity": comparison.task.quantity,
                    "states": comparison.states,
                    "left_out": dict(comparison.left_out),
                    "measured": [_finite(asdict(measured)) for measured in comparison.measured],
                    "many_states": [asdict(many) for many in comparison.many],
                }
                for comparison in self.comparisons
            ],
        }


def benchmark(path: Path, states: int, progress: Progress, out: Path | None = None) -> Benchmark:
    """Measure every quantity of interest of one model.

    symgen's kernels are those of OUT/<model>, where a run has verified some; without `out`, what derivation chooses.

    Raises ModelError for mistakes in the file and WrongUseError where there is no gcc or nothing to measure.
    """
    if find_gcc() is None:
        raise WrongUseError("symgen bench compiles everything with gcc, and there is no gcc on this machine")
    model = without_allocation(load_model(path))
    reference = Reference(model)
    tasks = [_task(model, name) for name in (*MAIN, *MATRICES) if name in reference.quantities()]
    if not any(task.quantity in MAIN for task in tasks):
        raise WrongUseError(f"{path}: nothing to measure, the model has none of {', '.join(MAIN)}")
    progress("looking for admissible states")
    samples = admissible_samples(reference, states, [task.quantity for task in tasks])
    notes = [] if find_valgrind() else ["there is no valgrind: instructions were not counted"]
    comparisons = []
    for task in tasks:
        progress(f"deriving {task.quantity}")
        draft = generated(model, task, SCALARS, out)
        notes += draft.notes
        if not draft.derivations.left_out:
            chosen = samples if task.quantity == "inverse_dynamics" else samples[:OTHER_STATES]
            comparisons.append(_compare(model, reference, task, draft, chosen, progress))
    return Benchmark(model.name, tuple(comparisons), tuple(dict.fromkeys(notes)))


def _task(model: Model, quantity: str) -> Task:
    sizes = {"n": model.n, "m": model.m, "r": model.r}
    size = math.prod(sizes[extent] for extent in ROWS[quantity].shape)
    return Task(quantity, "u" if "u" in ROWS[quantity].arguments else "qdd", size)


def _compare(
    model: Model, reference: Reference, task: Task, draft: Draft, samples: Sequence[Sample], progress: Progress
) -> Comparison:
    loads = {scalar: workload(reference, samples, task, scalar, progress) for scalar in SCALARS}
    progress(f"writing {task.quantity}")
    programs = programs_of(model, task, SCALARS, draft)
    full_rank = reference.ranks.constraints == model.r
    left_out: tuple[tuple[str, str], ...] = () if full_rank else (("peers", "the constraints depend on each other"),)
    candidates = [c for scalar in SCALARS for c in symgen_candidates(model, programs, scalar)]
    if full_rank:
        peer_kernels = peers(model, task, loads["float64"].states[:200])
        left_out = peer_kernels.left_out
        candidates += peer_kernels.candidates
        candidates += [in_single(candidate) for candidate in peer_kernels.candidates if "float32" in SCALARS]
    with tempfile.TemporaryDirectory(prefix="symgen-bench-") as folder:
        progress(f"compiling {task.quantity}, {len(candidates)} kernels")
        built = build(Path(folder), model, task, candidates, loads)
        progress(f"running {task.quantity}")
        measured = _measure(
            built, Path(folder), task, candidates, loads,
            lambda scalar, results: beyond_tolerance(reference, task, loads[scalar], results),
        )
        progress(f"running {task.quantity} on many states")
        chosen = next(iter(programs.values()))
        many: tuple[Many, ...] = ()
        if task.quantity in MAIN:
            loops = _loops(candidates, measured)
            many = many_states(Path(folder), model, task, chosen, loops, loads["float64"])
    for candidate in _python(model, task, programs, full_rank) if task.quantity in MAIN else ():
        results, together, alone = run_python(model, candidate, loads["float64"])
        errors = errors_of(loads["float64"], results)
        row = MeasuredCandidate(
            generator=candidate.generator,
            form=candidate.form,
            language="Python",
            scalar="float64",
            nanoseconds=together,
            single_nanoseconds=alone,
            instructions=None,
            footprint=None,
            operations=None,
            errors=errors,
            chosen=candidate.chosen,
        )
        measured.append(row)
    return Comparison(task, len(samples), _with_front(measured), left_out, many)


def _loops(candidates: Sequence[CCandidate], measured: Sequence[MeasuredCandidate]) -> list[CCandidate]:
    """symgen's kernel and the fastest peers, to be called state by state; a library holds no -fPIE.

    Among them is the fastest one that is straight lines, which a compiler makes lanes of.
    """
    timed = [(m.nanoseconds, c) for c, m in zip(candidates, measured, strict=True) if c.scalar == "float64"]
    own = [c for _, c in timed if c.chosen][:1]
    peers = sorted((t for t in timed if t[1].generator != "symgen" and "-fPIE" not in t[1].flags), key=lambda t: t[0])
    best = [c for _, c in peers[:BEST_PEERS]]
    straight = [c for _, c in peers if c.straight is not None][:1]
    return own + best + [c for c in straight if c not in best]


def _measure(
    built: Built,
    folder: Path,
    task: Task,
    candidates: Sequence[CCandidate],
    loads: Mapping[Scalar, Workload],
    beyond: Callable[[Scalar, Any], int],
) -> list[MeasuredCandidate]:
    results = results_of(built, folder, candidates, task)
    times = nanoseconds(built, PASSES)
    entries = [candidate.entry for candidate in candidates]
    states = min(COUNTED_STATES, len(loads["float64"].states))
    counts = count_instructions(built.program, states, entries) if find_valgrind() else {}
    return [
        MeasuredCandidate(
            generator=c.generator,
            form=c.form,
            language="C",
            scalar=c.scalar,
            nanoseconds=times[c.entry],
            single_nanoseconds=None,
            instructions=counts.get(c.entry),
            footprint=built.footprints[c.entry],
            operations=c.operations,
            errors=errors_of(loads[c.scalar], results[c.entry]),
            chosen=c.chosen,
            beyond=beyond(c.scalar, results[c.entry]) if c.chosen else None,
        )
        for c in candidates
    ]


def _python(
    model: Model, task: Task, programs: Mapping[str, Mapping[Scalar, Program]], full_rank: bool
) -> list[PythonCandidate]:
    return [*symgen_python(model, programs, task), *(python_peers(model, task) if full_rank else [])]


def _with_front(measured: Sequence[MeasuredCandidate]) -> tuple[MeasuredCandidate, ...]:
    """Marks what nothing else of its language and scalar type beats in both time and 99 % error."""
    marked = list(measured)
    for group in dict.fromkeys((m.language, m.scalar) for m in measured):
        places = [k for k, m in enumerate(measured) if (m.language, m.scalar) == group]
        for k in pareto_front([(measured[k].nanoseconds, measured[k].errors.percentile_99) for k in places]):
            marked[places[k]] = replace(measured[places[k]], on_front=True)
    return tuple(marked)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    return None if isinstance(value, float) and not isfinite(value) else value
