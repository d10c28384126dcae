"""The module of one scalar type: parameters, what its kernels share, and a function for each kernel."""

from __future__ import annotations

import textwrap

from symgen.backends.about import bound_lines, count_lines, parameter_text
from symgen.backends.comments import COMMENT_WIDTH
from symgen.backends.defaults import default_values
from symgen.backends.literals import decimal_text
from symgen.backends.locals import Names, all_statements, array_arguments, names_of, used_locals
from symgen.backends.quantities import meaning
from symgen.backends.render import render
from symgen.backends.rust.comments import as_they_stand, prose
from symgen.backends.rust.reserved import WORDS
from symgen.backends.rust.statements import RustStatements, rust_helper, status_name
from symgen.backends.statements import Helper
from symgen.ir.kernel import Kernel, Local, Program, Scalar, Status
from symgen.ir.pairs.wide_functions import wide_function, wide_operations, with_bodies
from symgen.model.model import Model
from symgen.records import dataclass

RUST_TYPE: dict[Scalar, str] = {"float64": "f64", "float32": "f32"}
# What `core` has not, as methods of the standard library; a number of them takes two operands.
LIBRARY = {
    "tan": "tan", "asin": "asin", "acos": "acos", "atan": "atan", "atan2": "atan2", "exp": "exp", "log": "ln",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "pow": "powf", "sin": "sin", "cos": "cos",
}  # fmt: skip
# Each binding opens a scope inside the one before, and debuggers' tables of thousands of these overflow the stack of
# rustc: longer kernels have one binding for all.
MOST_BINDINGS = 500
_OF_TWO = frozenset({"atan2", "pow"})
_SHARED = ("sincos", "ratio_or_zero", "sqrt", "abs", "copysign", *LIBRARY)


@dataclass(frozen=True, slots=True)
class RustFunctionView:
    """One kernel: comment, name, signature, body lines, the result as an expression, and whether it may be no number.

    `unread` are arguments that the body does not read.
    """

    comment: tuple[str, ...]
    name: str
    arguments: tuple[str, ...]
    unread: tuple[str, ...]
    body: tuple[str, ...]
    result: str
    type: str
    outputs: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RustModuleView:
    """Everything the template prints; `fields` are names, defaults and comments of the parameters."""

    about: tuple[str, ...]
    kind: str
    bits: str
    digits: int
    exponent_bias: int
    fields: tuple[tuple[str, str, tuple[str, ...]], ...]
    operations: frozenset[str]
    library: tuple[tuple[str, str, bool], ...]
    sincos: Helper | None
    wide: tuple[tuple[str, Helper], ...]
    not_finite: str
    functions: tuple[RustFunctionView, ...]


def emit_rust(model: Model, program: Program) -> dict[str, str]:
    """`rust/src/float64.rs` or `rust/src/float32.rs`."""
    own = {"Parameters", "Status", *_SHARED, *(kernel.name for kernel in program.kernels)}
    names = names_of(model, program, WORDS.is_taken, own)
    used = operations_of(program)
    statements = [statement for kernel in program.kernels for statement in all_statements(kernel)]
    values, single = default_values(model), program.scalar == "float32"
    pair = program.sincos if "sincos" in used else None
    view = RustModuleView(
        about=(
            f"Kernels in {RUST_TYPE[program.scalar]}.",
            "",
            *as_they_stand((*count_lines(program), *bound_lines(model, program))),
        ),
        kind=RUST_TYPE[program.scalar],
        bits="u32" if single else "u64",
        digits=24 if single else 53,
        exponent_bias=127 if single else 1023,
        fields=tuple(
            (names.members[one.name], decimal_text(program.scalar, values[one.name]), prose(parameter_text(one)))
            for one in model.parameters
        ),
        operations=used,
        library=tuple((name, method, name in _OF_TWO) for name, method in LIBRARY.items() if name in used),
        sincos=None if pair is None else rust_helper(program.scalar, pair),
        wide=tuple(
            (name, rust_helper(program.scalar, wide_function(name, program.scalar)))
            for name in wide_operations(statements)
        ),
        not_finite=status_name(Status.NOT_FINITE),
        functions=tuple(_function(program, kernel, names) for kernel in program.kernels),
    )
    return {f"rust/src/{program.scalar}.rs": render("rust/module.rs.jinja", view)}


def operations_of(program: Program) -> frozenset[str]:
    """What the kernels of a program compute with; `sin` and `cos` where these are the library's."""
    statements = [statement for kernel in program.kernels for statement in all_statements(kernel)]
    operations: set[str] = {statement.operation for statement in with_bodies(statements)}
    if "sincos" in operations and program.sincos is not None:
        operations |= {statement.operation for statement in program.sincos.statements}
    elif "sincos" in operations:
        operations = operations - {"sincos"} | {"sin", "cos"}
    return frozenset(operations)


def _function(program: Program, kernel: Kernel, names: Names) -> RustFunctionView:
    used, kind = used_locals(kernel), RUST_TYPE[program.scalar]
    targets = [target for statement in all_statements(kernel) for target in statement.targets if target in used]
    long = len(targets) > MOST_BINDINGS
    printer = RustStatements(program.scalar, names.locals, used, program.sincos is not None, long)
    loads = [load for load in kernel.loads if load.local in used]
    body = _declared([names.locals[target] for target in targets]) if long else []
    for load in loads:
        place = f"p.{names.members[load.member]}" if load.argument == "p" else f"{load.argument}[{load.index}]"
        body.append(f"let {names.locals[load.local]} = {place};")
    body += [line for block in kernel.blocks for line in printer.block(block)]
    entries = [printer.argument(operand) for operand in kernel.outputs]
    arrays = array_arguments(kernel)
    read = {load.argument for load in loads}
    return RustFunctionView(
        comment=prose(meaning(kernel)),
        name=kernel.name,
        arguments=(*(f"{array.name}: &[{kind}; {array.length}]" for array in arrays), "p: &Parameters"),
        unread=tuple(name for name in (*(array.name for array in arrays), "p") if name not in read),
        body=tuple(body),
        result=nested(entries, kernel.shape),
        type=array_type(kind, kernel.shape),
        outputs=tuple(dict.fromkeys(names.locals[o.name] for o in kernel.outputs if isinstance(o, Local))),
    )


def _declared(targets: list[str]) -> list[str]:
    """One pattern of all names."""
    lines = textwrap.wrap(", ".join(dict.fromkeys(targets)), COMMENT_WIDTH)
    return ["let (", *(f"    {line}" for line in lines), ");"]


def array_type(kind: str, shape: tuple[int, ...]) -> str:
    """The type of an array of arrays."""
    for extent in reversed(shape):
        kind = f"[{kind}; {extent}]"
    return kind


def nested(entries: list[str], shape: tuple[int, ...]) -> str:
    """Row-major entries as an array of arrays."""
    for extent in reversed(shape[1:]):
        entries = [f"[{', '.join(entries[at : at + extent])}]" for at in range(0, len(entries), extent)]
    return f"[{', '.join(entries)}]"
