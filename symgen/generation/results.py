"""What a run of symgen is asked for and what it hands back: the nouns between pipeline and command line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from symgen.diagnostics import Notice
from symgen.ir.kernel import Scalar
from symgen.methods.table import NAMED, methods
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.registered import BACKENDS, USUAL

if TYPE_CHECKING:
    from symgen.ir.kernel import Program
    from symgen.verify.certificate import LeftOut

_BESIDE = ("report", "package", "proof")
# What can be made, and what is made as a rule.
ALL_PARTS = (*BACKENDS, *_BESIDE)
PARTS = (*USUAL, *_BESIDE)
# States at which a run verifies, unless told otherwise.
DEFAULT_STATES = 64
AUTO = "auto"
# By quantity, the methods that may be asked for.
NAMED_METHODS: Mapping[str, tuple[str, ...]] = {
    quantity: tuple(row.name for row in methods(quantity)) for quantity in NAMED
}
# What stands in the place of a quantity for `explain`: the machine at rest as a linear system.
LINEARIZATION = "linearization"
Trig: TypeAlias = Literal["portable", "libm"]
TRIG: tuple[Trig, ...] = ("portable", "libm")


class WrongUseError(Exception):
    """The command line asks for something that does not exist, such as an unknown quantity; exit code 2."""


@dataclass(frozen=True, slots=True)
class Options:
    """What to generate; `outputs` None takes the model's own list, `states` is the number of states to verify.

    `measured` is where an earlier run may have left measurements (`<model>/target.json`), for the PDF.
    `trig` says whose sine and cosine the code calls: its own, with the same bits everywhere, or the library's.
    `as_recorded` takes over what the earlier run's verification led to, see `symgen.generation.acceptance.recorded`.
    With `contract` batches are verified with products and sums contracted, too.
    With `fixed_parameters` functions are called with those of the file: how far others may be is not looked for.
    Without packages that the report needs it is left out where `parts` are those made as a rule (`usual`).
    """

    outputs: tuple[str, ...] | None = None
    scalars: tuple[Scalar, ...] = ("float64", "float32")
    parts: tuple[str, ...] = PARTS
    verify: bool = True
    trig: Trig = "portable"
    states: int = DEFAULT_STATES
    measured: Path | None = None
    as_recorded: bool = False
    usual: bool = False
    contract: bool = False
    fixed_parameters: bool = False
    # by quantity, of NAMED_METHODS; without one the cheapest valid
    methods: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class LargestError:
    """The worst error of one target (`C float64`, ...) in units of d + eps |y|, and how many units are allowed.

    d is how far the exact result moves when the inputs are rounded; see `symgen.verify.tolerance`.
    """

    target: str
    quantity: str
    error: float
    tolerance: float


@dataclass(frozen=True, slots=True)
class Summary:
    """The table at the end of a run: sizes, what the system does not need and why, operations, largest errors."""

    n: int
    r: int
    delta: int
    m: int
    skipped: tuple[tuple[str, str], ...]
    operations: tuple[tuple[str, int], ...]
    errors: tuple[LargestError, ...] = ()


@dataclass(frozen=True, slots=True)
class Result:
    """All files of one model in memory (paths relative to its folder), and what to tell the user.

    `failures` are verification failures: with any, nothing is written and the exit code is 1.  `left_out` are
    quantities that verification rejects by every method: the rest is written, the exit code is 1.  `programs` are what
    the files hold.
    """

    model: Model
    files: Mapping[str, str | bytes]
    summary: Summary
    notices: tuple[Notice, ...] = ()
    certificate: Mapping[str, Any] | None = None
    failures: tuple[str, ...] = field(default=())
    left_out: tuple[LeftOut, ...] = ()
    programs: Mapping[Scalar, Program] = field(default_factory=dict)
