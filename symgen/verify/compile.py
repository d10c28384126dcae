"""The generated C, compiled and called state by state."""

from __future__ import annotations

import ctypes
import math
import os
import shutil
import signal
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from symgen.emit.locals import array_arguments
from symgen.emit.scalars import SUFFIX
from symgen.ir.kernel import Kernel, Scalar, Status

# -O1 takes half the time of -O2; the bits are the same at every level (tests/verify/test_levels.py).
FLAGS = ("-std=c99", "-O1", "-ffp-contract=off", "-fPIC", "-shared")
LONGEST_COMPILATION = 600.0
C_TYPES: dict[Scalar, Any] = {"float64": ctypes.c_double, "float32": ctypes.c_float}


@dataclass(frozen=True, slots=True)
class CSource:
    """A generated header and source; `stem` names the files without their endings.

    `companions` are further files (name, text) that use the header: kernels over many states, parameters prepared.
    """

    stem: str
    header: str
    source: str
    companions: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a kernel made of one state; entries the kernel did not write are NaN."""

    status: int
    entries: tuple[float, ...]

    @property
    def valid(self) -> bool:
        """Whether the status is 0 and every entry is finite."""
        return self.status == Status.OK and all(map(math.isfinite, self.entries))


class CompilationError(Exception):
    """The compiler refused generated C; the text is its own."""


@dataclass(frozen=True, slots=True)
class Compiler:
    """A C compiler of this machine."""

    command: tuple[str, ...]
    version: str


def find_compiler() -> Compiler | None:
    """The compiler in CC, else cc, else gcc; None when there is none."""
    for command in (os.environ.get("CC", "").split(), ["cc"], ["gcc"]):
        if command and shutil.which(command[0]):
            told = subprocess.run([*command, "--version"], capture_output=True, text=True, check=False)
            return Compiler(tuple(command), (told.stdout.splitlines() or ["unknown"])[0])
    return None


class Compilation:
    """A compiler at work in the background; `library` waits for it."""

    def __init__(self, compiler: Compiler, source: CSource, folder: Path) -> None:
        (folder / f"{source.stem}.h").write_text(source.header, encoding="utf-8")
        paths = [folder / f"{source.stem}.c"]
        paths[0].write_text(source.source, encoding="utf-8")
        for name, text in source.companions:
            (folder / name).write_text(text, encoding="utf-8")
            paths += [folder / name] if name.endswith(".c") else []
        self._target = folder / f"{source.stem}.so"
        command = [*compiler.command, *FLAGS, "-o", str(self._target), *map(str, paths), "-lm"]
        self._log = folder / f"{source.stem}.log"
        with self._log.open("wb") as log:
            # in a group of its own: a driver that is killed alone leaves the compiler proper at work
            self._process = subprocess.Popen(command, stdout=log, stderr=log, process_group=0)

    def library(self) -> ctypes.CDLL:
        """The loaded library; raises CompilationError with the compiler's message."""
        if self._process.wait(LONGEST_COMPILATION) != 0:
            raise CompilationError(self._log.read_text(encoding="utf-8", errors="replace"))
        return ctypes.CDLL(str(self._target))

    def cancel(self) -> None:
        """Stop a compiler that still runs."""
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()


class CFunction:
    """One kernel of a library: arrays, then the parameter struct, then the result."""

    def __init__(self, library: ctypes.CDLL, model: str, kernel: Kernel, scalar: Scalar) -> None:
        self._function = library[f"{model}_{kernel.name}{SUFFIX[scalar]}"]
        self._function.restype = ctypes.c_int
        self._scalar = C_TYPES[scalar]
        self._arguments = tuple(argument.name for argument in array_arguments(kernel))
        self._result = self._scalar * max(1, math.prod(kernel.shape))

    def __call__(self, arrays: dict[str, Any], parameters: Any) -> Outcome:
        """Run on C arrays made by `c_array`."""
        result = self._result(*([math.nan] * self._result._length_))
        status = self._function(*(arrays[name] for name in self._arguments), parameters, result)
        return Outcome(int(status), tuple(result))


def c_array(scalar: Scalar, values: Sequence[Any]) -> Any:
    """Numbers as a C array of the scalar type; a parameter struct has one member at least."""
    return (C_TYPES[scalar] * max(1, len(values)))(*values)
