"""The generated C, compiled and called state by state."""

from __future__ import annotations

import ctypes
import math
import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel, Scalar, Status
from symgen.runtime.activity import working
from symgen.runtime.processes import ToolError, ended, run, start, stop

if TYPE_CHECKING:
    import subprocess

# -O1 takes half the time of -O2; the bits are the same at every level (tests/verify/test_levels.py).
FLAGS = ("-std=c99", "-O1", "-ffp-contract=off", "-fPIC", "-shared")
# Characters of a model's C in one scalar type.  At -O1 a megabyte takes 4 s and 130 MB, several times as much where it
# is one function: registers for 0.4 MB of one take 15 s and 470 MB.  Beyond this it is translated as it stands, a
# megabyte in 0.5 s and 50 MB, and one type after the other.
LARGE = 500_000
PLAIN = ("-O0",)
# Seconds for a megabyte, on a machine of 2020 that does nothing else.
USUAL, USUAL_PLAIN = 4.0, 0.5
# gcc keeps whatever it has parsed, unless it is told to look for what it no longer needs.
SPARING = ("--param", "ggc-min-expand=20", "--param", "ggc-min-heapsize=32768")
# Seconds: a megabyte of source takes two on a fast machine; beyond that a compiler hangs.
LONGEST_ANSWER = 20.0
# Seconds after which a compilation is ended, and those for each megabyte of source beside.
LONGEST_COMPILATION, LONGEST_FOR_A_MEGABYTE = 60.0, 120.0
REMEDY = "name a working C compiler of this machine in CC"
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

    @property
    def large(self) -> bool:
        """Whether optimising it would take more time or memory than there is."""
        return self.characters > LARGE

    @property
    def characters(self) -> int:
        """The length of all of it."""
        return len(self.header) + len(self.source) + sum(len(text) for _, text in self.companions)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a kernel made of one state; entries the kernel did not write are NaN."""

    status: int
    entries: tuple[float, ...]

    @property
    def valid(self) -> bool:
        """Whether the status is 0 and every entry is finite."""
        return self.status == Status.OK and all(map(math.isfinite, self.entries))


class CompilationError(ToolError):
    """The compiler refused generated C (the text is its own), hangs, or made nothing that runs here."""


@dataclass(frozen=True, slots=True)
class Compiler:
    """A C compiler of this machine."""

    command: tuple[str, ...]
    version: str
    gnu: bool = False

    def flags(self, source: CSource) -> tuple[str, ...]:
        """How a source is compiled here: optimised, unless that would take too much."""
        if not source.large:
            return FLAGS
        return (*FLAGS, *PLAIN, *(SPARING if self.gnu else ()))


def find_compiler() -> Compiler | None:
    """The compiler in CC, else cc, else gcc; None when there is none. Raises CompilationError when it hangs."""
    for command in (os.environ.get("CC", "").split(), ["cc"], ["gcc"]):
        if command and shutil.which(command[0]):
            try:
                answer = run([*command, "--version"], LONGEST_ANSWER)
            except ToolError as error:
                raise CompilationError(f"{error}; {REMEDY}") from error
            lines = answer.stdout.splitlines() if answer.returncode == 0 else []
            gnu = "Free Software Foundation" in answer.stdout
            return Compiler(tuple(command), (lines or ["unknown"])[0], gnu)
    return None


class Compilation:
    """A compiler at work in the background; `library` waits for it.

    With `later` it is set to work when the library is asked for.  `target` is where that is, beside the sources.
    """

    def __init__(self, compiler: Compiler, source: CSource, folder: Path, later: bool = False) -> None:
        texts = {f"{source.stem}.h": source.header, f"{source.stem}.c": source.source, **dict(source.companions)}
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        paths = [str(folder / name) for name in texts if name.endswith(".c")]
        self._limit = LONGEST_COMPILATION + LONGEST_FOR_A_MEGABYTE * sum(map(len, texts.values())) / 1e6
        self._tool = compiler.command[0]
        self.target = folder / f"{source.stem}.so"
        self._log = folder / f"{source.stem}.log"
        self._command = [*compiler.command, *compiler.flags(source), "-o", str(self.target), *paths, "-lm"]
        self._folder = folder
        self._megabytes = source.characters / 1e6
        self._usual = self._megabytes * (USUAL_PLAIN if source.large else USUAL)
        self._process: subprocess.Popen[bytes] | None = None
        if not later:
            self.start()

    def start(self) -> subprocess.Popen[bytes]:
        """Sets the compiler to work, once."""
        if self._process is None:
            with self._log.open("wb") as log:
                self._process = start(self._command, output=log, complaints=log, temporary=self._folder)
        return self._process

    def library(self) -> ctypes.CDLL:
        """The loaded library; raises CompilationError with the compiler's message, or with a remedy."""
        try:
            with working(f"compiling {self._megabytes:.1f} MB of C", seconds=self._usual):
                code = ended(self.start(), self._limit)
        except ToolError as error:
            raise CompilationError(f"{error}; {REMEDY}") from error
        said = self._log.read_text(encoding="utf-8", errors="replace").strip()
        if code != 0:
            raise CompilationError(said or f"{self._tool} ended with {code} and no word; {REMEDY}")
        if not self.target.is_file():
            raise CompilationError(f"{self._tool} ended with 0 and made no file; {REMEDY}")
        try:
            return ctypes.CDLL(str(self.target))
        except OSError as error:
            raise CompilationError(f"{self._tool} made no library that loads here ({error}); {REMEDY}") from error

    def cancel(self) -> None:
        """Stop a compiler that still runs."""
        if self._process is not None:
            stop(self._process)


class CFunction:
    """One kernel of a library: arrays, then the parameter struct, then the result."""

    def __init__(self, library: ctypes.CDLL, model: str, kernel: Kernel, scalar: Scalar) -> None:
        name = global_name(model, scalar, kernel.name)
        try:
            self._function = library[name]
        except AttributeError as error:
            raise CompilationError(f"the compiler made a library without {name}; {REMEDY}") from error
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
