"""C of a model with its batch kernels, compiled and called through arrays."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path
from typing import Any

import numpy as np

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.defaults import default_values
from symgen.backends.locals import array_arguments
from symgen.ir.kernel import Kernel, Program
from symgen.model.model import Model

STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
NATIVE = ["-O3", "-march=native", "-fno-math-errno"]


class Library:
    """Both files of a program, compiled as one library."""

    def __init__(self, folder: Path, model: Model, program: Program, command: list[str]) -> None:
        files = emit_c(model, program) | emit_c_batch(model, program)
        for path, text in files.items():
            (folder / Path(path).name).write_text(text)
        sources = [str(folder / Path(path).name) for path in files if path.endswith(".c")]
        flags = ["-std=c99", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(folder / "lib.so")]
        subprocess.run([*command, *STRICT, *flags, *sources, "-lm"], check=True)
        self._library = ctypes.CDLL(str(folder / "lib.so"))
        self._suffix = "" if program.scalar == "float64" else "_f"
        self.prefix, self.dtype = model.name, np.dtype(program.scalar)
        self.parameters = np.array([float(v) for v in default_values(model).values()] or [0.0], dtype=self.dtype)

    def one(self, kernel: Kernel, rows: dict[str, Any], k: int) -> tuple[int, Any]:
        """Status and entries of state k by the kernel for one state; NaN where there is no result."""
        function = self._library[f"{self.prefix}_{kernel.name}{self._suffix}"]
        arrays = [np.ascontiguousarray(rows[a.name][:, k]) for a in array_arguments(kernel)]
        result = np.full(len(kernel.outputs), np.nan, dtype=self.dtype)
        status = function(*map(pointer, [*arrays, self.parameters, result]))
        return status, result

    def batch(
        self, kernel: Kernel, rows: dict[str, Any], count: int, result: Any = None, with_status: bool = True
    ) -> tuple[int, Any, Any]:
        """The number of refused states, the statuses and the results (size, stride) of `count` states."""
        function = self._library[f"{self.prefix}_{kernel.name}_batch{self._suffix}"]
        function.restype = ctypes.c_size_t
        arrays = [rows[a.name] for a in array_arguments(kernel)]
        stride = arrays[0].shape[1]
        result = np.full((len(kernel.outputs), stride), 7.0, dtype=self.dtype) if result is None else result
        statuses = np.full(stride, 99, dtype=np.uint8)
        status = pointer(statuses) if with_status else None
        sizes = ctypes.c_size_t(count), ctypes.c_size_t(stride)
        refused = function(*sizes, *map(pointer, [*arrays, self.parameters, result]), status)
        return refused, statuses, result


def pointer(array: Any) -> Any:
    return ctypes.c_void_p(array.ctypes.data)
