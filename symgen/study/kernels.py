"""The kernels of a study: verified once, derived again by whoever works on it, compiled with loops around them."""

from __future__ import annotations

import ctypes
import hashlib
import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import local
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symgen.backends.c.batch import VECTOR
from symgen.backends.locals import array_arguments
from symgen.backends.quantities import BATCHED
from symgen.diagnostics import SymgenBug
from symgen.generation.results import Options, Result, WrongUseError
from symgen.ir.kernel import Kernel, Scalar
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.study.float32_inputs import QUANTITY as SINGLE_INPUTS
from symgen.study.float32_inputs import Float32Inputs
from symgen.study.loops import loops_source, over_name, reduced_name, walk_name
from symgen.study.neighbours.hops import hops_name, hops_source
from symgen.verify.running.compile import Compilation, CompilationError, Compiler, CSource, find_compiler
from symgen.verify.running.sources import generated_sources

Array = NDArray[np.float64]
Codes = NDArray[np.uint8]
Progress = Callable[[str], None]
RECORD_FILE = "derivation.json"
# Those of the generated Python's `compile()`; without those for this machine where the compiler knows none.
PORTABLE_FLAGS = ("-std=c99", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-shared")
MACHINE_FLAGS = (("-march=native", "-mprefer-vector-width=512"), ("-march=native",), ())


@dataclass(frozen=True, slots=True)
class MachineCompiler(Compiler):
    """A compiler that makes vectors of this machine, but of sources that would take it too long."""

    machine: tuple[str, ...] = ()

    def flags(self, source: CSource) -> tuple[str, ...]:
        """How a source is compiled here."""
        return Compiler.flags(self, source) if source.large else (*PORTABLE_FLAGS, *self.machine)


class NoKernelsError(Exception):
    """Verification rejects a kernel of the study, or a worker makes other ones; the text says why."""


def verified_result(
    path: Path,
    quantities: Sequence[str],
    record: Path | None,
    progress: Progress,
    scalars: tuple[Scalar, ...] = ("float64",),
) -> Result:
    """The C of the quantities, verified; what verification led to is taken from `record`/<model> where that is given.

    In float32 only the inputs are needed, whatever becomes of others there.
    Raises ModelError, NoKernelsError where a kernel is rejected, WrongUseError where the model does not have one.
    """
    options = Options(
        outputs=tuple(quantities),
        scalars=scalars,
        parts=("c",),
        verify=record is None,
        measured=record,
        as_recorded=record is not None,
    )
    result = generate(path, options, progress)
    lacking = (one for one in result.left_out if "float64" in one.scalars or one.quantity == SINGLE_INPUTS)
    reasons = [*result.failures, *(f"{one.quantity}: {one.remedy}" for one in lacking)]
    if reasons:
        raise NoKernelsError("\n  ".join(("verification rejects what the study needs", *reasons)))
    made = {kernel.name for kernel in result.programs["float64"].kernels}
    for name in quantities:
        if name not in made:
            why = [one.message for one in result.notices if one.message.startswith(name)]
            raise WrongUseError(f"{result.model.name}: {why[0] if why else f'it has no {name}'}")
    return result


def kernels_hash(result: Result) -> str:
    """SHA-256 of the C of a result."""
    content = sorted((name, text) for name, text in result.files.items() if name.startswith("c/"))
    return hashlib.sha256(repr(content).encode()).hexdigest()


class StudyKernels:
    """The kernels of a model, compiled; arrays are `[point][component][state]`, statuses `[point][state]`."""

    def __init__(self, result: Result) -> None:
        self.model: Model = result.model
        program = result.programs["float64"]
        self._kernels: Mapping[str, Kernel] = {kernel.name: kernel for kernel in program.kernels}
        source = generated_sources(self.model, result.files)[0]["float64"]
        written = loops_source(self.model, program.kernels) + hops_source(self.model, program.kernels)
        loops = (f"{source.stem}_study.c", written)
        used = [(name, text) for name, text in source.companions if "_batch" in name]
        self._rooms = local()
        self.float32_inputs = Float32Inputs(result, _compiled) if "float32" in result.programs else None
        """Where the study is made in both types."""
        self._library = _compiled(CSource(source.stem, source.header, source.source, (*used, loops)))

    def over(self, name: str, parts: Mapping[str, Array], group: NDArray[np.uintp], p: Array) -> tuple[Array, Codes]:
        """A quantity at the states of some points: entries (points x size x states) and statuses.

        `parts` are q, qd, ... (groups x length x states), `group` says which of them a point has, `p` (points x
        parameters) are its parameters.  Entries without a result are NaN.  What is returned holds until this thread
        asks for the same quantity again.
        """
        kernel = self._kernels[name]
        arguments = [_contiguous(parts[argument.name]) for argument in array_arguments(kernel)]
        points, count = len(group), arguments[0].shape[-1]
        result = self._room(name, np.dtype(np.float64), (points, math.prod(kernel.shape), count))
        status = self._room(name, np.dtype(np.uint8), (points, count))
        self._call(over_name(name), (points, count), (group, *arguments, p, result, status))
        return result, status

    def reduced_over(
        self, name: str, parts: Mapping[str, Array], group: NDArray[np.uintp], p: Array, smallest: bool = False
    ) -> tuple[Array, NDArray[np.int64], Codes | None]:
        """What `reduced` makes of the entries that `over` returns, and the statuses, if one of them is not 0."""
        kernel = self._kernels[name]
        given = [parts[argument.name] for argument in array_arguments(kernel)]
        points, count, size = len(group), given[0].shape[-1], math.prod(kernel.shape)
        stride = -(-count // VECTOR) * VECTOR if name in BATCHED else count
        arguments = [_padded(one, stride) for one in given]
        room = self._room(name, np.dtype(np.float64), (size, stride))
        figures, places = np.empty((points * size, 6)), np.empty(points * size, dtype=np.int64)
        status = self._room(name, np.dtype(np.uint8), (points, stride))
        arrays = (group, *arguments, p, room, figures, places, status)
        self._call(reduced_name(name), (points, count, stride, int(smallest)), arrays)
        return figures, places, status[:, :count] if status.any() else None

    def _room(self, name: str, dtype: np.dtype[Any], shape: tuple[int, ...]) -> NDArray[Any]:
        """Memory that this thread has written before: what is new has to be mapped by the system, which takes longer
        than a kernel does."""
        rooms: dict[tuple[str, str], NDArray[Any]] = self._rooms.__dict__.setdefault("by_use", {})
        size = math.prod(shape)
        if (name, dtype.char) not in rooms or rooms[name, dtype.char].size < size:
            rooms[name, dtype.char] = np.empty(size, dtype=dtype)
        return rooms[name, dtype.char][:size].reshape(shape)

    def walked(
        self, name: str, start: tuple[Array, Array, Array], p: Array, given: Array
    ) -> tuple[Array, Codes]:
        """Configurations (points x n x states) for what is `given` (points x states x k), from `start`: p, x and q."""
        points, count = given.shape[:2]
        q = np.empty((points, self.model.n, count))
        status = np.empty((points, count), dtype=np.uint8)
        p_start, x_start, q_start = map(_contiguous, start)
        arrays = (p_start, p, x_start, _contiguous(given), q_start, q, status)
        self._call(walk_name(name), (points, count), arrays)
        return q, status

    def hopped(self, name: str, start: tuple[Array, Array, Array], p: Array, given: Array) -> Array:
        """Configurations (places x n, NaN where there is none) at parameters `p` for what is `given` (places x ...),
        on the straight way from a `start` each: p, x and q of as many places."""
        q = np.empty((len(p), self.model.n))
        p_start, x_start, q_start = map(_contiguous, start)
        arrays = (p_start, _contiguous(p), x_start, _contiguous(given), q_start, q)
        self._call(hops_name(name), (len(p),), arrays)
        return q

    def reduced(self, values: Array, smallest: bool = False) -> tuple[Array, NDArray[np.int64]]:
        """Of rows of values: largest, smallest, sum, sum of squares, number, and the largest magnitude, or the smallest
        (rows x 6); and where that is (rows)."""
        rows, count = values.shape
        figures, places = np.empty((rows, 6)), np.empty(rows, dtype=np.int64)
        self._call("study_reduced", (rows, count, count, int(smallest)), (values, figures, places))
        return figures, places

    def quantiles(self, values: Array, figures: Array, levels: Sequence[float]) -> Array:
        """Quantiles of rows of values at some levels (rows x levels)."""
        rows, count = values.shape
        result = np.empty((rows, len(levels)))
        level = np.array(levels)
        self._call("study_quantiles", (rows, count), (values, figures), (len(levels),), (level, result))
        return result

    def _call(
        self,
        name: str,
        sizes: Sequence[int],
        arrays: Sequence[NDArray[np.generic]],
        more_sizes: Sequence[int] = (),
        more: Sequence[NDArray[np.generic]] = (),
    ) -> None:
        """ctypes lets go of Python's lock while the function runs."""
        function = self._library[name]
        function.restype = None
        pointers = [ctypes.c_void_p(array.ctypes.data) for array in arrays]
        further = [ctypes.c_void_p(array.ctypes.data) for array in more]
        function(*map(ctypes.c_size_t, sizes), *pointers, *map(ctypes.c_size_t, more_sizes), *further)


def _contiguous(array: Array) -> Array:
    return np.ascontiguousarray(array, dtype=np.float64)


def _padded(array: Array, stride: int) -> Array:
    """With so many states in all, the last one again: the kernel for many states copies what fills no vector."""
    more = stride - array.shape[-1]
    return _contiguous(np.concatenate((array, np.repeat(array[..., -1:], more, axis=-1)), axis=-1) if more else array)


def _compiled(source: CSource) -> ctypes.CDLL:
    compiler = find_compiler()
    if compiler is None:
        raise WrongUseError("a study needs a C compiler: install gcc or clang, or name one in CC")
    problem: CompilationError | None = None
    with tempfile.TemporaryDirectory(prefix="symgen-study-") as folder:
        for machine in MACHINE_FLAGS:
            made = MachineCompiler(compiler.command, compiler.version, compiler.gnu, machine)
            try:
                return Compilation(made, source, Path(folder)).library()
            except CompilationError as error:
                problem = problem or error
    raise problem or SymgenBug("no flags to compile with")
