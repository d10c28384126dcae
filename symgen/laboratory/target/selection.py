"""Which kernels a build holds: compilers take most of the time of a measurement, and large kernels most of that.

u of up to a thousand operations is in every build, and every kernel on every core at gcc -Os, which tells bytes,
stack and instructions; small ones at gcc -O2 as well.  Of other kernels and builds each core has its share: with
six cores every kernel is built at every level with both compilers on two of them, and every core has something of
every build.  With up to three cores each of them has everything at every level.

In float64 on a core without a unit for it every number is a pair of words, and the registers of thousands of pairs
take gcc half a minute a build: there it builds large kernels at -Os only, and very large ones not at all.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from symgen.backends.operations import count_operations
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.library_trig import with_library_trig
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.laboratory.target.cores import Compiler, Core

PORTABLE, LIBM = "portable", "libm"
FAST, SMALL = "-O2", "-Os"
# Large kernels are built with these only, and beside them there are prepared kernels and those that take sines.
WITH_LARGE: tuple[tuple[Compiler, str], ...] = (("gcc", FAST), ("gcc", SMALL), ("clang", FAST))
MOST_OPERATIONS, MOST_OF_U = 150, 1000
MOST_IN_PAIRS = 3000
# With twice the digits a kernel is a table, which compilers have done with at once: it is the emulator that takes time.
MOST_IN_TABLES = 100_000
CORES_OF_A_BUILD = 2

Share: TypeAlias = tuple[int, int]  # kernels whose number is the first modulo the second
ALL: Share = (0, 1)


@dataclass(frozen=True, slots=True)
class BuildSelection:
    """Shares of the small and the large kernels; `pairs` are the large ones in float64, `companions` other forms."""

    small: Share
    large: Share | None = None
    pairs: Literal["all", "fitting", "none"] = "all"
    companions: bool = False
    library: bool = False


def selection(core: Core | None, compiler: Compiler, level: str, trig: str, share: Share) -> BuildSelection:
    """What is built for a core (None: the host) that has this share."""
    if trig == LIBM:
        return BuildSelection(share, library=True)
    alone = core is not None and share == ALL
    if (compiler, level) not in WITH_LARGE and not alone:
        return BuildSelection(share)
    if core is None:
        return BuildSelection(ALL, ALL, companions=True)
    if compiler == "clang":
        return BuildSelection(share, share, companions=True)
    if level == SMALL or alone:
        return BuildSelection(ALL, ALL, "all" if has_unit(core) else "fitting", companions=True)
    return BuildSelection(ALL, share, "all" if has_unit(core) else "none", companions=True)


def share(build: int, core: int, cores: int) -> Share:
    """The share of core number `core` of `cores` in build number `build`."""
    parts = max(1, cores // CORES_OF_A_BUILD)
    return (build + core) % parts, parts


def has_unit(core: Core | None) -> bool:
    """Whether a core computes in float64 itself."""
    return core is None or "float64" in core.native


def selected(chosen: BuildSelection, programs: Mapping[Scalar, Program]) -> dict[Scalar, Program]:
    """The kernels of a selection by scalar type, where there are any."""
    kept = {scalar: replace(program, kernels=tuple(_kept(chosen, scalar, program)))
             for scalar, program in programs.items()}
    return {scalar: with_library_trig(program) if chosen.library else program
            for scalar, program in kept.items() if program.kernels}


def small_kernels(program: Program) -> Program:
    """The program without its large kernels."""
    return replace(program, kernels=tuple(kernel for kernel in program.kernels if _is_small(kernel)))


def beyond_pairs(double: Program) -> tuple[Kernel, ...]:
    """Kernels in float64 that gcc does not build for a core without a unit for it."""
    return tuple(kernel for kernel in double.kernels if not _fits(kernel))


def _kept(chosen: BuildSelection, scalar: Scalar, program: Program) -> Iterator[Kernel]:
    # where all are large the smallest stands for the small ones
    smallest = min(program.kernels, key=_size)
    for number, kernel in enumerate(program.kernels):
        if _is_small(kernel) or kernel is smallest:
            if (_is_small(kernel) and kernel.name == "inverse_dynamics") or _falls_into(chosen.small, number):
                yield kernel
        elif chosen.large is not None and _falls_into(chosen.large, number):
            fits = chosen.pairs == "all" or (chosen.pairs == "fitting" and _fits(kernel))
            if scalar == "float32" or fits:
                yield kernel


def _falls_into(part: Share, number: int) -> bool:
    turn, parts = part
    return number % parts == turn


def _fits(kernel: Kernel) -> bool:
    return _size(kernel) <= (MOST_IN_TABLES if works_with_pairs(kernel) else MOST_IN_PAIRS)


def _is_small(kernel: Kernel) -> bool:
    return _size(kernel) <= (MOST_OF_U if kernel.name == "inverse_dynamics" else MOST_OPERATIONS)


def _size(kernel: Kernel) -> int:
    return count_operations(kernel.statements).total
