"""What stands around the C: a gateway, a function with help for each quantity, what builds them, a Simulink block."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence

from symgen.backends.about import shape_text, status_meaning, statuses_of, symbol_lines, symbol_text
from symgen.backends.c.elsewhere import CallerNames, KernelCall, caller_names, kernel_call, titled
from symgen.backends.c.names import c_members, status_name
from symgen.backends.comments import c_comment, one_line
from symgen.backends.locals import names_of
from symgen.backends.matlab.reserved import LONGEST_NAME, WORDS
from symgen.backends.quantities import meaning
from symgen.backends.render import render
from symgen.ir.kernel import Kernel, Program
from symgen.model.model import Model
from symgen.naming import identifiers
from symgen.records import dataclass

# Characters of a line of help behind its indentation.
HELP_WIDTH = 96
# The quantity that a block of Simulink has: what a controller works out.
BLOCK = "inverse_dynamics"
# What the files of a model have before or behind its name.
ENDINGS = ("_mex", "_sfun", "build_")


@dataclass(frozen=True, slots=True)
class MatlabFunctionView:
    """One quantity: how it is called, what its result is called, help."""

    call: KernelCall
    result: str
    about: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MatlabView:
    """Everything the templates print; `fields` are names of parameters, those in C, and what each is."""

    name: str
    c: CallerNames
    gateway: str
    title: str
    about: tuple[str, ...]
    fields: tuple[tuple[str, str, str], ...]
    statuses: tuple[tuple[str, str, str], ...]
    functions: tuple[MatlabFunctionView, ...]
    most_arguments: int
    most_outputs: int


@dataclass(frozen=True, slots=True)
class OneFunctionView:
    """A function beside what all of them share."""

    model: MatlabView
    function: MatlabFunctionView


def emit_functions(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """`matlab/+<model>/*.m`, the gateway, what stands for it until it is built, what builds it, and the block.

    Nothing without kernels.
    """
    (program,) = programs
    if not program.kernels:
        return {}
    view = _view(model, program)
    files = {
        f"{view.gateway}.c": render("matlab/gateway.c.jinja", view),
        f"{view.gateway}.m": render("matlab/unbuilt.m.jinja", view),
        f"build_{view.name}.m": render("matlab/build.m.jinja", view),
        f"+{view.name}/parameters.m": render("matlab/parameters.m.jinja", view),
    }
    for function in view.functions:
        one = OneFunctionView(view, function)
        files[f"+{view.name}/{function.call.name}.m"] = render("matlab/function.m.jinja", one)
        if function.call.name == BLOCK:
            files[f"{view.name}_sfun.c"] = render("matlab/block.c.jinja", one)
    return {f"matlab/{path}": text for path, text in files.items()}


def matlab_fields(model: Model) -> dict[str, str]:
    """What fields of the struct of parameters are called, by parameter."""
    return identifiers((parameter.name for parameter in model.parameters), WORDS.is_taken)


def _view(model: Model, program: Program) -> MatlabView:
    members, fields = c_members(model, program), matlab_fields(model)
    outputs = names_of(model, program, WORDS.is_taken, {"p", "status"}).outputs
    functions = tuple(_function(model, program, kernel, outputs[kernel.name]) for kernel in program.kernels)
    short = model.c_name[: LONGEST_NAME - max(map(len, ENDINGS))]
    name = identifiers((short,), WORDS.is_taken)[short]
    return MatlabView(
        name=name,
        c=caller_names(model, program),
        gateway=f"{name}_mex",
        title=c_comment(titled(model)),
        about=tuple(help_lines(symbol_lines(model))),
        fields=tuple(
            (fields[one.name], members[one.name], one_line(symbol_text(one.unit, one.description)))
            for one in model.parameters
        ),
        statuses=tuple(
            (status_name(model, one), one.name, one_line(status_meaning(one, model)).replace('"', "'"))
            for one in statuses_of(model)
        ),
        functions=functions,
        most_arguments=max(1, *(len(function.call.arguments) for function in functions)),
        most_outputs=max(function.call.rows * function.call.columns for function in functions),
    )


def _function(model: Model, program: Program, kernel: Kernel, result: str) -> MatlabFunctionView:
    about = tuple(help_lines([f"{meaning(kernel)}; {shape_text(kernel)}"]))
    return MatlabFunctionView(kernel_call(model, program, kernel), result, about)


def help_lines(lines: Iterator[str] | Sequence[str]) -> Iterator[str]:
    """Wrapped, so that each stands in a comment of MATLAB."""
    for line in lines:
        indent = line[: len(line) - len(line.lstrip())]
        yield from textwrap.wrap(
            one_line(line), HELP_WIDTH, initial_indent=indent, subsequent_indent=indent + "  ", break_long_words=False
        )
