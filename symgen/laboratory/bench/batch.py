"""Many states at once, one core: batch kernels beside the peers' C in a loop and NumPy on the same closed form."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter_ns
from typing import Any

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.endings import BATCH
from symgen.backends.c.names import global_name
from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.backends.render import render
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.laboratory.bench.build import compile_candidate, gcc
from symgen.laboratory.bench.candidate import CCandidate, Task
from symgen.laboratory.bench.peers.engines.straight import LOOP_FLAGS
from symgen.laboratory.bench.workload import Workload
from symgen.model.model import Model
from symgen.verify.running.python_module import PythonModule

# The flags of `compile()` in the generated module, for all: vectors of this machine, at their full width.
FLAGS = ("-std=c99", "-O3", "-march=native", "-mprefer-vector-width=512", "-ffp-contract=off", "-fno-math-errno")
CONTRACTING = ("-ffp-contract=fast", "-DSYMGEN_CONTRACT")
CONTRACTED = "batch contracted"
STREAMED, CACHED = 2**17, 2**10  # states: components of the first come from memory
NUMPY_BLOCK = 4096
PASSES = 9
LOOP, LANES = ", in a loop", ", in lanes"
BEST_PEERS = 3  # of each quantity, by the time of one call


@dataclass(frozen=True, slots=True)
class Many:
    """Nanoseconds a state, medians of several passes, of one way to treat many states with one set of parameters."""

    generator: str
    form: str
    language: str
    scalar: Scalar
    streamed_nanoseconds: float
    cached_nanoseconds: float

    @property
    def label(self) -> str:
        """The name in tables."""
        return f"{self.generator} {self.form}"


@dataclass(frozen=True, slots=True)
class LoopsView:
    """What the template of the loops prints."""

    n: int
    third: int
    size: int
    entries: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _BatchCandidate:
    generator: str
    form: str
    language: str
    scalar: Scalar
    run: Callable[[int], None]


def many_states(
    folder: Path,
    model: Model,
    task: Task,
    programs: Mapping[Scalar, Program],
    loops: Sequence[CCandidate],
    load: Workload,
) -> tuple[Many, ...]:
    """Times of the quantity's batch kernels and NumPy module, and of `loops`: float64 C called state by state, and,
    where that is straight lines, in lanes.

    All take the parameters of the first state, and turns in every pass.
    """
    import numpy as np

    n, end = model.n, load.states.shape[1] - len(model.parameters)
    rows = np.tile(load.states, (-(-STREAMED // len(load.states)), 1))[:STREAMED]
    parts = [np.ascontiguousarray(part) for part in (rows[:, :n], rows[:, n : 2 * n], rows[:, 2 * n : end])]
    parameters = load.states[0, end:]
    ways = [*_batches(folder, model, programs, parts, parameters), *_numpy(folder, model, programs, parts, parameters)]
    ways += _loops(folder, model, task, loops, parts, parameters)
    straight = [candidate for candidate in loops if candidate.straight is not None]
    ways += _in_lanes(folder, task, straight, parts, parameters)
    streamed, cached = (_times(ways, count) for count in (STREAMED, CACHED))
    return tuple(
        Many(way.generator, way.form, way.language, way.scalar, streamed[k], cached[k]) for k, way in enumerate(ways)
    )


def _times(ways: Sequence[_BatchCandidate], count: int) -> list[float]:
    repeats = max(1, STREAMED // count // 16)
    times: list[list[float]] = [[] for _ in ways]
    for turn in range(PASSES + 1):
        for k in range(len(ways)):
            place = (k + turn) % len(ways)
            start = perf_counter_ns()
            for _ in range(repeats):
                ways[place].run(count)
            times[place].append((perf_counter_ns() - start) / count / repeats)
    return [median(passes[1:]) for passes in times]  # the first pass touches new memory


def _arguments(kernel: Kernel, parts: Sequence[Any]) -> list[Any]:
    """Those of q, q̇ and the third array that the kernel has."""
    given = dict(zip(("q", "qd", "qdd", "u"), (*parts, parts[2]), strict=True))
    return [given[argument.name] for argument in kernel.arguments if argument.length]


def _library(folder: Path, model: Model, program: Program, further: Sequence[str] = ()) -> ctypes.CDLL:
    files = emit_c(model, program) | emit_c_batch(model, program)
    for path, text in files.items():
        (folder / Path(path).name).write_text(text, encoding="utf-8")
    sources = [str(folder / Path(path).name) for path in files if path.endswith(".c")]
    target = folder / f"{global_name(model.c_name, program.scalar, 'contracted' if further else 'many')}.so"
    gcc([*FLAGS, *further, "-shared", "-fPIC", "-o", str(target), *sources, "-lm"], "symgen's batch kernels")
    return ctypes.CDLL(str(target))


def _batches(
    folder: Path, model: Model, programs: Mapping[Scalar, Program], parts: Sequence[Any], parameters: Any
) -> list[_BatchCandidate]:
    import numpy as np

    ways = []
    for scalar, program in programs.items():
        (kernel,) = program.kernels
        rows = [np.ascontiguousarray(part.T, dtype=scalar) for part in _arguments(kernel, parts)]
        result = np.empty((len(kernel.outputs), STREAMED), dtype=scalar)
        given = [*rows, np.array([*parameters, 0.0], dtype=scalar), result]
        for form, further in (("batch", ()), (CONTRACTED, CONTRACTING)):
            function = _library(folder, model, program, further)[global_name(model.c_name, scalar, kernel.name, BATCH)]
            ways.append(_BatchCandidate("symgen", form, "C", scalar, _call(function, given, (STREAMED,), (None,))))
    return ways


def _call(
    function: Any, arrays: Sequence[Any], sizes: Sequence[int] = (), last: Sequence[None] = ()
) -> Callable[[int], None]:
    """The function of a count of states; the arrays are kept, their addresses are looked up once."""
    kept = [ctypes.c_size_t(size) for size in sizes]
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in arrays]

    def run(count: int, _arrays: Sequence[Any] = arrays) -> None:
        function(ctypes.c_size_t(count), *kept, *pointers, *last)

    return run


def _numpy(
    folder: Path, model: Model, programs: Mapping[Scalar, Program], parts: Sequence[Any], parameters: Any
) -> list[_BatchCandidate]:
    program = programs["float64"]
    (kernel,) = program.kernels
    module = PythonModule(next(iter(emit_python(model, program).values()))).module
    p = module.Parameters(*parameters.tolist())
    arrays = _arguments(kernel, parts)
    compiled = getattr(module.Compiled(_library(folder, model, program)), kernel.name)
    plain = getattr(module, kernel.name)

    def whole(count: int) -> None:
        plain(*(array[:count] for array in arrays), p)

    def blocks(count: int) -> None:
        for start in range(0, count, NUMPY_BLOCK):
            plain(*(array[start : min(count, start + NUMPY_BLOCK)] for array in arrays), p)

    def through_c(count: int) -> None:
        compiled(*(array[:count] for array in arrays), p)

    named = {"compile()": through_c, "NumPy, whole arrays": whole, f"NumPy, blocks of {NUMPY_BLOCK}": blocks}
    return [_BatchCandidate("symgen", form, "Python", "float64", run) for form, run in named.items()]


def _in_lanes(
    folder: Path, task: Task, candidates: Sequence[CCandidate], parts: Sequence[Any], parameters: Any
) -> list[_BatchCandidate]:
    """Straight lines of peers as a loop over components that stand side by side, as the batch kernels' do."""
    import numpy as np

    inside = folder / "lanes"
    inside.mkdir()
    rows = [np.ascontiguousarray(part.T) for part in parts]
    result = np.empty((task.size, STREAMED))
    ways = []
    for candidate in candidates:
        assert candidate.straight is not None
        source, target = inside / f"{candidate.entry}.c", inside / f"{candidate.entry}.so"
        source.write_text(candidate.straight.loop(candidate.entry), encoding="utf-8")
        gcc([*FLAGS, *LOOP_FLAGS, "-shared", "-fPIC", "-o", str(target), str(source), "-lm"], candidate.label)
        function = ctypes.CDLL(str(target))[candidate.entry]
        run = _call(function, [*rows, np.array([*parameters, 0.0]), result], (STREAMED,))
        ways.append(_BatchCandidate(candidate.generator, candidate.form + LANES, "C", "float64", run))
    return ways


def _loops(
    folder: Path, model: Model, task: Task, loops: Sequence[CCandidate], parts: Sequence[Any], parameters: Any
) -> list[_BatchCandidate]:
    import numpy as np

    if not loops:
        return []
    inside = folder / "loops"
    inside.mkdir()
    objects = []
    for candidate in loops:
        paths, _ = compile_candidate(inside / candidate.entry, candidate, FLAGS)
        objects += [str(path) for path in paths]
    view = LoopsView(model.n, parts[2].shape[1], task.size, tuple(candidate.entry for candidate in loops))
    (inside / "loops.c").write_text(render("bench/loops.c.jinja", view), encoding="utf-8")
    target = inside / "loops.so"
    gcc([*FLAGS, "-shared", "-fPIC", "-o", str(target), str(inside / "loops.c"), *objects, "-lm"], "the loops")
    library = ctypes.CDLL(str(target))
    result = np.empty((STREAMED, task.size))
    given = [*parts, np.array([*parameters, 0.0]), result]
    return [
        _BatchCandidate(c.generator, c.form + LOOP, "C", "float64", _call(library[f"{c.entry}_loop"], given))
        for c in loops
    ]
