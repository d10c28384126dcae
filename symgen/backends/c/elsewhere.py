"""The C for one state in the folder of another backend, which so builds by itself, and what code around it calls."""

from __future__ import annotations

from collections.abc import Iterable

from symgen.backends.about import symbol_lines
from symgen.backends.backend import Emit
from symgen.backends.c.identity import status_text_name
from symgen.backends.c.names import global_name
from symgen.backends.c.plain import emit_c
from symgen.backends.comments import c_comment_lines, one_line
from symgen.backends.locals import array_arguments
from symgen.backends.scalars import file_stem
from symgen.ir.kernel import Kernel, Program
from symgen.model.model import Model
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class CallerNames:
    """What code around the C includes and declares: the stem of its files, and names of the model."""

    source: str
    params: str
    defaults: str
    status: str
    status_text: str


@dataclass(frozen=True, slots=True)
class KernelCall:
    """A kernel as code around the C calls it: its name, that in C, arrays with their lengths, the shape."""

    name: str
    c_function: str
    arguments: tuple[tuple[str, int], ...]
    rows: int
    columns: int


def emit_c_into(folder: str) -> Emit:
    """What prints `<folder>/<model>.h` and `.c`, with the text of those in `c/`."""

    def emit(model: Model, program: Program) -> dict[str, str]:
        return {f"{folder}/{path.rpartition('/')[2]}": text for path, text in emit_c(model, program).items()}

    return emit


def caller_names(model: Model, program: Program) -> CallerNames:
    """Those of the scalar type of a program."""
    return CallerNames(
        source=file_stem(model.c_name, program.scalar),
        params=global_name(model.c_name, program.scalar, "params"),
        defaults=global_name(model.c_name, program.scalar, "default_params"),
        status=f"{model.c_name}_status",
        status_text=status_text_name(model),
    )


def kernel_call(model: Model, program: Program, kernel: Kernel) -> KernelCall:
    """A kernel of a program."""
    rows, columns = (*kernel.shape, 1)[:2]
    arguments = tuple((argument.name, argument.length) for argument in array_arguments(kernel))
    return KernelCall(
        kernel.name, global_name(model.c_name, program.scalar, kernel.name), arguments, rows, columns
    )


def titled(model: Model, role: str = "") -> str:
    """A line that says what a model is, and what about it."""
    return one_line(f"{model.name}: {model.description or 'constrained mechanical system'}{role}")


def heading(model: Model, title: str) -> tuple[str, ...]:
    """Lines of a comment in C: the title, and what symbols mean."""
    lines: Iterable[str] = (title, *symbol_lines(model))
    return tuple(part for line in lines for part in c_comment_lines(line))
