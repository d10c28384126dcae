"""Straight lines of C, each value a constant of its own: a function of one state, or a loop over many in lanes.

No tool's habits stand between an algorithm and its count here: there are no helper functions, no work arrays, and no
names but those of values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

# Compilers make lanes of these where the library has them so (libmvec); as one call for both they have none.
_IN_LANES = """\
__attribute__((simd("notinbranch"))) double sin(double);
__attribute__((simd("notinbranch"))) double cos(double);
"""
# What a loop in lanes is compiled with, beside the flags of all.
LOOP_FLAGS = ("-fopenmp-simd", "-fno-builtin-sin", "-fno-builtin-cos")


@dataclass(frozen=True, slots=True)
class StraightLines:
    """`values` are what the lines assign one by one, `v0` and so on, from entries of the `arrays` and numbers.

    An entry is named as `loaded` tells; the arrays are q, q_dot, the third one and the parameters, by name.
    """

    arrays: tuple[str, ...]
    entries: tuple[tuple[str, int], ...]
    values: tuple[str, ...]
    outputs: tuple[str, ...]

    def function(self, name: str) -> str:
        """C with the signature of all kernels."""
        lines = [f"const REAL {loaded(array, i)} = {array}[{i}];" for array, i in self.entries]
        lines += [*self._assigned(), *(f"y[{k}] = {output};" for k, output in enumerate(self.outputs))]
        head = f"int {name}({', '.join(f'const REAL *{array}' for array in self.arrays)}, REAL *y)"
        body = [f"    {line}" for line in (*lines, "return 0;")]
        return "\n".join(["#include <math.h>", f"{head};", head, "{", *body, "}", ""])

    def loop(self, name: str) -> str:
        """C over states whose components are `stride` apart, with one set of parameters."""
        *moving, parameters = self.arrays
        pointers = [*(f"const double *restrict {array}" for array in self.arrays), "double *restrict y"]
        head = f"void {name}(size_t count, size_t stride, {', '.join(pointers)})"
        lines = [
            f"    const double {loaded(array, i)} = {array}[{i}];" for array, i in self.entries if array == parameters
        ]
        lines += ["#pragma omp simd", "    for (size_t k = 0; k < count; ++k) {"]
        inside = [
            f"const double {loaded(array, i)} = {array}[{i} * stride + k];"
            for array, i in self.entries
            if array in moving
        ]
        inside += [*self._assigned(), *(f"y[{i} * stride + k] = {output};" for i, output in enumerate(self.outputs))]
        body = [*lines, *(f"        {line}" for line in inside), "    }"]
        start = ["#include <math.h>", "#include <stddef.h>", "#define REAL double", _IN_LANES]
        return "\n".join([*start, f"{head};", head, "{", *body, "}", ""])

    def _assigned(self) -> list[str]:
        return [f"const REAL v{k} = {value};" for k, value in enumerate(self.values)]


def loaded(array: str, index: int) -> str:
    """What an entry of an array is called in the lines."""
    return f"{array}_{index}"


def third_of(inputs: Sequence[str]) -> str:
    """The name of the array beside q, q_dot and the parameters."""
    return "qdd" if "qdd" in inputs else "u"
