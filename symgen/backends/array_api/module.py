"""A module of pure functions on the array API standard: `function(xp, q, ...)` for arrays of the namespace `xp`."""

from __future__ import annotations

from symgen.backends.about import array_line, module_lines, parameter_text, status_meaning, statuses_of
from symgen.backends.array_api.reserved import WORDS
from symgen.backends.array_api.statements import ArrayStatements, array_helper
from symgen.backends.comments import docstring_lines
from symgen.backends.defaults import default_values
from symgen.backends.literals import in_range
from symgen.backends.locals import Names, all_statements, array_arguments, names_of, used_locals
from symgen.backends.render import render
from symgen.backends.scalars import file_stem
from symgen.backends.statements import Helper
from symgen.ir.kernel import Kernel, Program, Scalar, Status
from symgen.ir.pairs.wide_functions import wide_function, wide_operations, with_bodies
from symgen.model.model import Model
from symgen.records import dataclass

# Names inside of functions.
_INSIDE = ("xp", "status", "like", "entries")


@dataclass(frozen=True, slots=True)
class ArrayFunctionView:
    """One quantity: names and lengths of its arrays, docstring, body lines, entries of the result and its shape."""

    name: str
    arguments: tuple[tuple[str, int], ...]
    docstring: tuple[str, ...]
    body: tuple[str, ...]
    entries: tuple[str, ...]
    shape: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ModuleView:
    """Everything the template prints; `fields` are names, defaults and comments of the parameters."""

    about: tuple[str, ...]
    scalar: Scalar
    other: str
    statuses: tuple[tuple[str, int, str], ...]
    not_finite: int
    fields: tuple[tuple[str, str, str], ...]
    functions: tuple[ArrayFunctionView, ...]
    needs_ratio: bool
    wide: tuple[tuple[str, Helper], ...]


def emit_array_api(model: Model, program: Program) -> dict[str, str]:
    """`array_api/<model>.py` (float64) or `array_api/<model>_f.py`; it imports nothing but the standard library."""
    own = {kernel.name for kernel in program.kernels} | {"Parameters", "PARAMETERS", "Status"}
    names = names_of(model, program, WORDS.is_taken, own, _INSIDE)
    statements = [statement for kernel in program.kernels for statement in all_statements(kernel)]
    other: Scalar = "float32" if program.scalar == "float64" else "float64"
    values, wide = default_values(model), wide_operations(statements)
    view = ModuleView(
        about=module_lines(model, program),
        scalar=program.scalar,
        other=file_stem(model.c_name, other),
        statuses=tuple((status.name, int(status), status_meaning(status, model)) for status in statuses_of(model)),
        not_finite=int(Status.NOT_FINITE),
        fields=tuple(
            (one.name, repr(in_range(program.scalar, values[one.name])), parameter_text(one))
            for one in model.parameters
        ),
        functions=tuple(_function(program, kernel, names) for kernel in program.kernels),
        needs_ratio="ratio_or_zero" in {statement.operation for statement in with_bodies(statements)},
        wide=tuple((name, array_helper(program.scalar, wide_function(name, program.scalar))) for name in wide),
    )
    return {f"array_api/{file_stem(model.c_name, program.scalar)}.py": render("array_api/module.py.jinja", view)}


def _function(program: Program, kernel: Kernel, names: Names) -> ArrayFunctionView:
    used = used_locals(kernel)
    printer = ArrayStatements(program.scalar, names.locals, used)
    body = []
    for load in kernel.loads:
        if load.local in used:
            place = f"_real(xp, p.{load.member})" if load.argument == "p" else f"{load.argument}[..., {load.index}]"
            body.append(f"{names.locals[load.local]} = {place}")
    body += [line for block in kernel.blocks for line in printer.block(block)]
    arguments = tuple((argument.name, argument.length) for argument in array_arguments(kernel))
    return ArrayFunctionView(
        name=kernel.name,
        arguments=arguments,
        docstring=docstring_lines(f"{array_line(kernel)}, and the status of each state."),
        body=tuple(body),
        entries=tuple(map(printer.argument, kernel.outputs)),
        shape=kernel.shape,
    )
