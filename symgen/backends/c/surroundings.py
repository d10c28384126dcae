"""What stands in a C file before its kernels: the header they need, macros for what is rare, the library's pair."""

from __future__ import annotations

from symgen.backends.c.bodies.steps import step_names
from symgen.backends.locals import all_statements, used_locals
from symgen.backends.scalars import C_TYPE, SUFFIX
from symgen.ir.kernel import Kernel, Local, Program
from symgen.ir.pairs.wide_functions import with_bodies
from symgen.naming import macro_name
from symgen.records import dataclass

_WITHOUT_LIBRARY = frozenset({"add", "sub", "mul", "div", "neg", "ratio_or_zero", "min", "max"})


@dataclass(frozen=True, slots=True)
class LibraryPair:
    """A function `name(angle, &sine, &cosine)` over the C library's `sine` and `cosine`, or its `library` pair."""

    name: str
    scalar: str
    sine: str
    cosine: str
    library: str


def uses_library(program: Program) -> bool:
    """Whether a file with these kernels needs math.h: for a function, or to test whether results are finite."""
    if any(isinstance(output, Local) for kernel in program.kernels for output in kernel.outputs):
        return True
    own = () if program.sincos is None else program.sincos.statements
    free = _WITHOUT_LIBRARY if program.sincos is None else _WITHOUT_LIBRARY | {"sincos"}
    statements = [*own, *(statement for kernel in program.kernels for statement in all_statements(kernel))]
    return any(statement.operation not in free for statement in with_bodies(statements))


def rare_macro(name: str, program: Program) -> str:
    """The macro around conditions that regular states do not meet; empty where no kernel has a test."""
    return rare_name(name, SUFFIX[program.scalar]) if any(map(_is_tested, program.kernels)) else ""


def apart_macro(name: str, program: Program) -> str:
    """The macro before functions that only a failure calls; empty where there are none."""
    kept = any(check.apart for kernel in program.kernels for block in kernel.blocks for check in block.checks)
    return apart_name(name, SUFFIX[program.scalar]) if kept else ""


def library_pair(name: str, program: Program) -> LibraryPair | None:
    """The pair of a file whose names begin with `name`; None where sine and cosine are portable or never both used."""
    if program.sincos is not None or not any(map(_uses_both, program.kernels)):
        return None
    tail = "f" if program.scalar == "float32" else ""
    own = both_name(name, SUFFIX[program.scalar])
    return LibraryPair(own, C_TYPE[program.scalar], f"sin{tail}", f"cos{tail}", f"sincos{tail}")


def rare_name(name: str, suffix: str) -> str:
    """The macro of a file whose names begin with `name`."""
    return macro_name(name) + f"_rarely{suffix}".upper()


def apart_name(name: str, suffix: str) -> str:
    """The macro before functions that only a failure calls, of a file whose names begin with `name`."""
    return macro_name(name) + f"_apart{suffix}".upper()


def both_name(name: str, suffix: str) -> str:
    """The function over the library's sine and cosine of a file whose names begin with `name`."""
    return f"{name}_libm{suffix}"


def surrounding_names(name: str, suffix: str) -> set[str]:
    """Every name that stands before the kernels of a file."""
    macros = {rare_name(name, suffix), apart_name(name, suffix), both_name(name, suffix)}
    return macros | step_names(name, suffix)


def _is_tested(kernel: Kernel) -> bool:
    return any(block.checks for block in kernel.blocks) or any(isinstance(o, Local) for o in kernel.outputs)


def _uses_both(kernel: Kernel) -> bool:
    used = used_locals(kernel)
    return any(s.operation == "sincos" and used.issuperset(s.targets) for s in all_statements(kernel))
