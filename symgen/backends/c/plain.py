"""C99 for microcontrollers: the kernels for one state, one header and one source file for each scalar type."""

from __future__ import annotations

from fractions import Fraction

from symgen.backends.about import (
    bound_lines,
    count_lines,
    renaming_lines,
    shape_text,
    status_meaning,
    statuses_of,
    symbol_lines,
    symbol_text,
)
from symgen.backends.c.bodies.functions import CFunctionView, kernel_function
from symgen.backends.c.file import StatusView, StructView, file_view, files
from symgen.backends.c.identity import column_view, identity_view
from symgen.backends.c.names import c_names, defined_macro, global_name, status_name
from symgen.backends.c.statements import c_literal
from symgen.backends.comments import c_comment, c_comment_lines, indent_of
from symgen.backends.defaults import default_values
from symgen.backends.locals import Names
from symgen.backends.quantities import meaning
from symgen.ir.kernel import Program
from symgen.model.model import Model
from symgen.records import dataclass

_RULES = (
    "Every function returns a status. On a status other than 0 its outputs are untouched. Outputs may alias inputs."
)


@dataclass(frozen=True, slots=True)
class _Member:
    """One member of the parameter struct and its default."""

    name: str
    comment: str
    default: str


def emit_c(model: Model, program: Program) -> dict[str, str]:
    """Header and source of the program's scalar type: `c/<model>.h`, `.c` (float64) or `c/<model>_f.h`, `_f.c`."""
    names = c_names(model, program)
    params = global_name(model.c_name, program.scalar, "params")
    members = _members(model, program, names)
    default = CFunctionView(
        ("The values of the model file.",),
        f"{params} {global_name(model.c_name, program.scalar, 'default_params')}(void)",
        (f"{params} p;", *(f"p.{member.name} = {member.default};" for member in members), "return p;"),
    )
    given = {"p": f"const {params} *p"}
    functions = (
        kernel_function(model, program, kernel, names, f"{meaning(kernel)}; {shape_text(kernel)}", given)
        for kernel in program.kernels
    )
    view = file_view(
        model,
        program,
        "",
        (*_about(model, program, names), "", _RULES),
        (default, *functions),
        StructView(params, tuple(f"{member.name}; /**< {member.comment} */" for member in members), "Parameters."),
        StatusView(
            defined_macro(model),
            f"{model.c_name}_status",
            tuple((status_name(model, s), int(s), status_meaning(s, model)) for s in statuses_of(model)),
            identity_view(model),
        ),
        column_view(model, program),
    )
    return files(view)


def _about(model: Model, program: Program, names: Names) -> tuple[str, ...]:
    kind = "double precision" if program.scalar == "float64" else "single precision"
    lines = list(c_comment_lines(f"{model.name}: {model.description or 'constrained mechanical system'} ({kind})"))
    if model.source:
        lines += c_comment_lines(f"Source: {model.source}")
    for group in (symbol_lines(model), renaming_lines(names), count_lines(program), bound_lines(model, program)):
        wrapped = [part for line in group for part in _comment_line(line)]
        lines += ["", *wrapped] if wrapped else []
    return tuple(lines)


def _comment_line(line: str) -> tuple[str, ...]:
    """A prepared line, escaped; tables keep their columns, long lines are wrapped."""
    indent = indent_of(line)
    if indent:
        return tuple(indent + wrapped for wrapped in c_comment_lines(line, "    "))
    return (line,)


def _members(model: Model, program: Program, names: Names) -> tuple[_Member, ...]:
    values = default_values(model)
    members = []
    for parameter in model.parameters:
        default = c_literal(program.scalar, values[parameter.name]).strip("()")
        about = symbol_text(parameter.unit, parameter.description)
        comment = c_comment(f"{about}; default {default}" if about else f"default {default}")
        members.append(_Member(names.members[parameter.name], comment, default))
    zero = c_literal(program.scalar, Fraction(0))
    return tuple(members) or (_Member("unused", "this model has no parameters", zero),)
