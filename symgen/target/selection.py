"""Which kernels a build holds: compilers take most of the time of a measurement, and large kernels most of that.

With portable sine and cosine every kernel is built at gcc -O2 and -Os and clang -O2; elsewhere u and small ones.
In float64 on a core without a unit for it every number is a pair of words, and the registers of thousands of pairs
take gcc half a minute a build: there gcc builds large kernels at -Os only, which tells bytes, stack and instructions,
and very large ones not at all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from symgen.emit.operations import count_operations
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.library_trig import with_library_trig
from symgen.target.cores import Compiler, Core

PORTABLE, LIBM = "portable", "libm"
FAST, SMALL = "-O2", "-Os"
WITH_ALL: tuple[tuple[Compiler, str], ...] = (("gcc", FAST), ("gcc", SMALL), ("clang", FAST))
MOST_OPERATIONS, MOST_OF_U = 150, 2000
MOST_IN_PAIRS = 3000

# All kernels; without float64 ones too large for pairs; with small float64 ones only; small ones only.
WHOLE, IN_PAIRS, SINGLE, PART = "whole", "in_pairs", "single", "part"
WITH_COMPANIONS = (WHOLE, IN_PAIRS, SINGLE)


def selection(core: Core | None, compiler: Compiler, level: str, trig: str) -> str:
    """The name of what is built for a core (None: the host)."""
    if trig == LIBM:
        return LIBM
    if (compiler, level) not in WITH_ALL:
        return PART
    if compiler == "clang" or has_unit(core):
        return WHOLE
    return IN_PAIRS if level == SMALL else SINGLE


def has_unit(core: Core | None) -> bool:
    """Whether a core computes in float64 itself."""
    return core is None or "float64" in core.native


def selected(programs: Mapping[Scalar, Program]) -> dict[str, dict[Scalar, Program]]:
    """The kernels of every selection, by scalar type."""
    double, single = programs["float64"], programs["float32"]
    small = {scalar: small_kernels(program) for scalar, program in programs.items()}
    fitting = tuple(kernel for kernel in double.kernels if kernel not in beyond_pairs(double))
    return {
        WHOLE: {"float64": double, "float32": single},
        IN_PAIRS: {"float64": replace(double, kernels=fitting or small["float64"].kernels), "float32": single},
        SINGLE: {"float64": small["float64"], "float32": single},
        PART: small,
        LIBM: {scalar: with_library_trig(program) for scalar, program in small.items()},
    }


def beyond_pairs(double: Program) -> tuple[Kernel, ...]:
    """Kernels in float64 that gcc does not build for a core without a unit for it."""
    return tuple(kernel for kernel in double.kernels if count_operations(kernel.statements).total > MOST_IN_PAIRS)


def small_kernels(program: Program) -> Program:
    """The program without its largest kernels; one at least stays."""
    sizes = {k.name: count_operations(k.statements).total for k in program.kernels}
    most = {name: MOST_OF_U if name == "inverse_dynamics" else MOST_OPERATIONS for name in sizes}
    kept = [k for k in program.kernels if sizes[k.name] <= most[k.name]]
    return replace(program, kernels=tuple(kept or [min(program.kernels, key=lambda k: sizes[k.name])]))
