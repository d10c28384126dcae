"""What is measured: one quantity by one method, as C that is compiled and linked or as a Python function."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from symgen.ir.kernel import Scalar
from symgen.laboratory.bench.peers.engines.straight import StraightLines

Third: TypeAlias = Literal["qdd", "u"]


@dataclass(frozen=True, slots=True)
class Task:
    """A quantity to compute from q, q̇, a third array and the parameters; `size` entries result."""

    quantity: str
    third: Third
    size: int


@dataclass(frozen=True, slots=True)
class CUnit:
    """One source file of a candidate; headers by file name; `renamed` symbols get a name of their own when compiled."""

    source: str
    headers: Mapping[str, str] = field(default_factory=dict)
    renamed: Mapping[str, str] = field(default_factory=dict)
    is_adaptor: bool = False


@dataclass(frozen=True, slots=True)
class CCandidate:
    """C for one scalar type: `entry` has the signature (q, qd, third, p, result) with pointers to `REAL`.

    `form` is the method with what else tells kernels apart.  The sources are the same for both scalar types but for
    `REAL`, except symgen's own.  `functions` are the symbols whose code and stack count; `operations` is known for
    symgen's kernels only.
    """

    generator: str
    form: str
    scalar: Scalar
    entry: str
    units: tuple[CUnit, ...]
    functions: tuple[str, ...]
    operations: Mapping[str, int] | None = None
    flags: tuple[str, ...] = ()  # beside those of all candidates
    chosen: bool = False  # what symgen generates, up to the sine and cosine
    straight: StraightLines | None = None  # what its one unit consists of, where that is straight lines

    @property
    def label(self) -> str:
        """The name in tables and charts, without the scalar type."""
        return f"{self.generator} {self.form}"


def adaptor(entry: str, own: str, given: Sequence[str]) -> CUnit:
    """The signature of all kernels for a function `own` of some of the arrays q, qd and x, and of the parameters."""
    arguments = "const REAL *q, const REAL *qd, const REAL *x, const REAL *p, REAL *y"
    unused = "".join(f"    (void){name};\n" for name in ("q", "qd", "x") if name not in given)
    text = (
        f"int {own}({'const REAL *, ' * len(given)}const REAL *, REAL *);\nint {entry}({arguments});\n"
        f"int {entry}({arguments})\n{{\n{unused}    return {own}({', '.join([*given, 'p'])}, y);\n}}\n"
    )
    return CUnit(text, is_adaptor=True)


def straight_candidate(generator: str, form: str, entry: str, lines: StraightLines) -> CCandidate:
    """Straight lines as a candidate in float64."""
    unit = CUnit(lines.function(entry))
    return CCandidate(generator, form, "float64", entry, (unit,), (entry,), straight=lines)


@dataclass(frozen=True, slots=True)
class PythonCandidate:
    """A function of arrays (states, n), parameters (states, P) that returns (states, size); single states likewise."""

    generator: str
    form: str
    batch: Callable[[Any, Any, Any, Any], Any]
    single: Callable[[Sequence[float], Sequence[float], Sequence[float], Sequence[float]], Any]
    chosen: bool = False

    @property
    def label(self) -> str:
        """The name in tables and charts."""
        return f"{self.generator} {self.form}"
