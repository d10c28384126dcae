"""Straight-line programs over real scalars: the noun between the mathematics and every backend.

One operation per statement, each target assigned once, so that C, Python and the interpreter perform the same IEEE
operations in the same order.  Nothing here knows mechanics.  A program is made for one scalar type: literals, status
thresholds and the sine/cosine function differ between float64 and float32.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum
from fractions import Fraction
from itertools import chain
from typing import Literal as Choice
from typing import TypeAlias

from symgen.model.quantities import Argument as ArgumentName
from symgen.records import dataclass

Scalar: TypeAlias = Choice["float64", "float32"]
UNIT_ROUNDOFF: dict[Scalar, Fraction] = {"float64": Fraction(1, 2**53), "float32": Fraction(1, 2**24)}


class Status(IntEnum):
    """What a kernel reports; the comments of the generated header say what each means (`backends/about.py`)."""

    OK = 0
    NOT_FINITE = 1
    CONSTRAINT_RANK = 2
    ACTUATION_RANK = 3
    ANGLE_RANGE = 4
    MASS_RANK = 5
    PARAMETER_RANGE = 6
    MEASURED_RANK = 7
    NOT_CLOSED = 8
    BRANCH = 9
    TASK_RANK = 10
    LIMITS = 11
    FRICTION_LOCK = 12
    COORDINATE_RANGE = 13


OperationName: TypeAlias = Choice[
    "add",
    "sub",
    "mul",
    "div",
    "neg",
    "abs",
    "sqrt",
    "copysign",  # magnitude of the first operand, sign of the second
    "ratio_or_zero",  # a / b, and 0 where b == 0
    "min",  # a where a < b, else b
    "max",  # a where a > b, else b
    "sincos",  # two targets (sine, cosine); the program's own function
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "exp",
    "log",
    "sinh",
    "cosh",
    "tanh",
    "pow",  # real power with a literal exponent, where products and roots do not serve
    # two targets (value, rest); the operands are pairs of these, too: the functions of `ir/pairs/wide_functions.py`
    "wide_add",
    "wide_sub",
    "wide_mul",
    "wide_div",
    "wide_ratio_or_zero",
    "wide_sqrt",
]


@dataclass(frozen=True, slots=True)
class Local:
    """A value loaded from an argument or assigned by a statement."""

    name: str


@dataclass(frozen=True, slots=True)
class Literal:
    """An exact number, rounded once to the program's scalar type where it is printed."""

    value: Fraction

    @property
    def is_power_of_two(self) -> bool:
        """Whether products with it are exact."""
        parts = abs(self.value.numerator), self.value.denominator
        return all(part > 0 and part & (part - 1) == 0 for part in parts)


Operand: TypeAlias = Local | Literal


@dataclass(frozen=True, slots=True)
class Load:
    """`local = argument[index]`; `member` is the parameter in the struct `p`, the sine or cosine in the struct `sc`.

    `place` is that of the argument (`Argument`), for those that have places.
    """

    local: str
    argument: ArgumentName | Choice["p", "sc"]
    index: int
    member: str = ""
    place: int = -1


@dataclass(frozen=True, slots=True)
class Statement:
    """`targets = operation(operands)`; two targets for `sincos` and operations on pairs of numbers, else one."""

    targets: tuple[str, ...]
    operation: OperationName
    operands: tuple[Operand, ...]


@dataclass(frozen=True, slots=True)
class Block:
    """Statements and the checks on their values, in order."""

    statements: tuple[Statement, ...]
    checks: tuple[Check, ...]

    def all_statements(self) -> Iterator[Statement]:
        """Every statement, those that run only when a check fails included."""
        yield from self.statements
        for check in self.checks:
            if check.first is not None:
                yield from check.first.all_statements()


@dataclass(frozen=True, slots=True)
class Check:
    """Return `status` unless `value > limit` (`>=` if `inclusive`); written so that NaN fails.

    `first` is evaluated only on failure: if one of its checks fails, that status is returned instead (it tells a
    drop of the constraint rank from a drop of the actuation rank without work on the way of a regular state).
    `apart` says that `first` computes all it needs from what is loaded and from the pairs, so that no value of the
    regular way has to wait for it: languages that are compiled keep it in a function of its own.
    """

    status: Status
    value: Operand
    limit: Operand
    inclusive: bool = False
    first: Block | None = None
    apart: bool = False


@dataclass(frozen=True, slots=True)
class Argument:
    """An array argument of a kernel; arrays of length 0 are left out of signatures.

    In trials of a kernel the entries are what stands at `places`: measured values at those of their coordinates.
    """

    name: ArgumentName
    length: int
    places: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Kernel:
    """One quantity: inputs are loaded before anything is stored, outputs are stored only when every check passed.

    Order at run time: loads, then `blocks` one after the other (statements, then their checks), then the test that
    every output is finite (status NOT_FINITE), then the stores.  `outputs` are row-major entries of `shape`.
    `remark` is for the comments of its functions.
    """

    name: str
    arguments: tuple[Argument, ...]
    loads: tuple[Load, ...]
    blocks: tuple[Block, ...]
    outputs: tuple[Operand, ...]
    shape: tuple[int, ...]
    remark: str = ""

    @property
    def statements(self) -> tuple[Statement, ...]:
        """The statements on the way of a regular state."""
        return tuple(chain.from_iterable([block.statements for block in self.blocks]))


@dataclass(frozen=True, slots=True)
class Function:
    """A straight-line helper shared by the kernels of a program: the portable sine and cosine."""

    name: str
    parameters: tuple[str, ...]
    statements: tuple[Statement, ...]
    results: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Program:
    """All kernels of one model for one scalar type.

    `sincos` is the straight-line body of the portable sine/cosine pair, or None where the C library's are called.
    """

    scalar: Scalar
    sincos: Function | None
    kernels: tuple[Kernel, ...]
