"""Inputs as firmware with single precision makes them: states and parameters rounded, and every operation."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from symgen.backends.c.endings import BATCH
from symgen.backends.c.names import global_name
from symgen.backends.locals import array_arguments
from symgen.generation.results import Result
from symgen.verify.running.compile import CSource
from symgen.verify.running.sources import generated_sources

QUANTITY = "inverse_dynamics"
Array = NDArray[np.float64]


class Float32Inputs:
    """The kernel of a result for many states in float32, made by `compiled`."""

    def __init__(self, result: Result, compiled: Callable[[CSource], ctypes.CDLL]) -> None:
        program = result.programs["float32"]
        self._kernel = next(kernel for kernel in program.kernels if kernel.name == QUANTITY)
        source = generated_sources(result.model, result.files)[0]["float32"]
        batch = tuple((name, text) for name, text in source.companions if BATCH in name)
        self._library = compiled(CSource(source.stem, source.header, source.source, batch))
        self._function = self._library[global_name(result.model.c_name, "float32", QUANTITY, BATCH)]
        self._function.restype = ctypes.c_size_t

    def over(self, parts: Mapping[str, Array], group: NDArray[np.uintp], p: Array) -> Array:
        """Inputs at the states of some points (points x m x states), as `StudyKernels.over`; NaN without a result."""
        arguments = [np.ascontiguousarray(parts[a.name], dtype=np.float32) for a in array_arguments(self._kernel)]
        parameters = np.ascontiguousarray(p, dtype=np.float32)
        count = parts["q"].shape[-1]
        made = np.empty((len(group), *self._kernel.shape, count), dtype=np.float32)
        for point, place in enumerate(group):
            rows = (*(argument[place] for argument in arguments), parameters[point], made[point])
            pointers = (ctypes.c_void_p(row.ctypes.data) for row in rows)
            self._function(ctypes.c_size_t(count), ctypes.c_size_t(count), *pointers, None)
        return made.astype(np.float64)
