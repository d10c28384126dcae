"""NumPy module of a model: vectorised over leading axes, the same operations in the same order as the C."""

from __future__ import annotations

from symgen import __version__
from symgen.backends.about import array_line, module_lines, parameter_text, status_meaning, statuses_of
from symgen.backends.c.endings import BATCH
from symgen.backends.c.reserved import is_taken as is_taken_in_c
from symgen.backends.comments import docstring_lines
from symgen.backends.defaults import default_values
from symgen.backends.literals import decimal_text
from symgen.backends.locals import Names, all_statements, array_arguments, names_of, used_locals
from symgen.backends.python.reserved import WORDS
from symgen.backends.python.statements import NumpyStatements, numpy_helper
from symgen.backends.quantities import BATCHED
from symgen.backends.render import render
from symgen.backends.scalars import file_stem
from symgen.backends.statements import Helper
from symgen.ir.kernel import Kernel, Program
from symgen.ir.pairs.wide_functions import wide_function, wide_operations, with_bodies
from symgen.model.inertial_parameters import inertial_parameters
from symgen.model.model import Model
from symgen.model.quantities import REGRESSOR
from symgen.records import dataclass

_SINCOS = "_sincos"
# Names inside of functions.
_INSIDE = ("np", "status", "batch", "entries")


@dataclass(frozen=True, slots=True)
class FieldView:
    """One parameter: field name, member of the C struct, default, comment."""

    name: str
    member: str
    default: str
    comment: str


@dataclass(frozen=True, slots=True)
class NumpyFunctionView:
    """One quantity: name, argument names and lengths, docstring, body lines and entries of the result."""

    name: str
    arguments: tuple[tuple[str, int], ...]
    signature: str
    unpacked: str
    lengths: tuple[int, ...]
    docstring: tuple[str, ...]
    body: tuple[str, ...]
    entries: tuple[str, ...]
    shape: tuple[int, ...]
    batched: bool


@dataclass(frozen=True, slots=True)
class PythonView:
    """Everything the Python template prints."""

    model: str
    stem: str
    about: tuple[str, ...]
    version: str
    model_hash: str
    columns: tuple[str, ...]
    statuses: tuple[tuple[str, int, str], ...]
    fields: tuple[FieldView, ...]
    functions: tuple[NumpyFunctionView, ...]
    sincos: Helper | None
    needs_ratio: bool
    wide: tuple[tuple[str, Helper], ...]
    c_files: tuple[str, ...]
    batch: str


def emit_python(model: Model, program: Program) -> dict[str, str]:
    """`python/<model>.py` from the float64 program; it needs NumPy only."""
    own = {kernel.name for kernel in program.kernels} | {"Parameters", "ArrayLike", "NDArray", "compile"}
    names = names_of(model, program, _is_taken, own, _INSIDE)
    statements = [statement for kernel in program.kernels for statement in all_statements(kernel)]
    operations = {statement.operation for statement in with_bodies(statements)}
    pair = program.sincos if "sincos" in operations else None
    operations |= set() if pair is None else {statement.operation for statement in pair.statements}
    view = PythonView(
        model=model.c_name,
        stem=model.c_name,
        about=module_lines(model, program),
        version=__version__,
        model_hash=model.text_hash,
        columns=_columns(model, program),
        statuses=tuple((status.name, int(status), status_meaning(status, model)) for status in statuses_of(model)),
        fields=_fields(model, names),
        functions=tuple(_kernel(kernel, names, None if pair is None else _SINCOS) for kernel in program.kernels),
        sincos=None if pair is None else numpy_helper(pair),
        needs_ratio="ratio_or_zero" in operations,
        wide=tuple((name, numpy_helper(wide_function(name))) for name in wide_operations(statements)),
        c_files=_c_files(model, program),
        batch=BATCH,
    )
    return {f"python/{view.stem}.py": render("python/module.py.jinja", view)}


def _is_taken(name: str) -> bool:
    """In C too, which the module compiles: a value has one name in both."""
    return WORDS.is_taken(name) or is_taken_in_c(name)


def _fields(model: Model, names: Names) -> tuple[FieldView, ...]:
    values = default_values(model)
    return tuple(
        FieldView(
            name=parameter.name,
            member=names.members[parameter.name],
            default=decimal_text("float64", values[parameter.name]),
            comment=parameter_text(parameter),
        )
        for parameter in model.parameters
    )


def _kernel(kernel: Kernel, names: Names, sincos: str | None) -> NumpyFunctionView:
    used = used_locals(kernel)
    printer = NumpyStatements(names.locals, used, sincos)
    body = []
    for load in kernel.loads:
        if load.local in used:
            place = f"np.float64(p.{load.member})" if load.argument == "p" else f"{load.argument}[..., {load.index}]"
            body.append(f"{names.locals[load.local]} = {place}")
    body += [line for block in kernel.blocks for line in printer.block(block)]
    arguments = tuple((argument.name, argument.length) for argument in array_arguments(kernel))
    return NumpyFunctionView(
        name=kernel.name,
        arguments=arguments,
        signature=", ".join([*(f"{name}: ArrayLike" for name, _ in arguments), "p: Parameters = PARAMETERS"]),
        unpacked=", ".join([*(name for name, _ in arguments), "batch"]),
        lengths=tuple(length for _, length in arguments),
        docstring=docstring_lines(f"{array_line(kernel)}."),
        body=tuple(body),
        entries=tuple(printer.operand(operand).strip("()") for operand in kernel.outputs),
        shape=kernel.shape,
        batched=kernel.name in BATCHED,
    )


def _columns(model: Model, program: Program) -> tuple[str, ...]:
    """What the columns of the regressor are called, where the program has it."""
    if all(kernel.name != REGRESSOR for kernel in program.kernels):
        return ()
    return tuple(one.name for one in inertial_parameters(model.mechanism))


def _c_files(model: Model, program: Program) -> tuple[str, ...]:
    """What `compile()` builds: the float64 kernels for one state and for many."""
    stem = model.c_name
    many = [file_stem(stem, program.scalar, BATCH)] if any(kernel.name in BATCHED for kernel in program.kernels) else []
    return tuple(name + extension for name in (stem, *many) for extension in (".h", ".c"))
