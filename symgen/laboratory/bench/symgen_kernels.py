"""symgen's own candidates: every valid method, with portable sine and cosine and with the C library's, C and Python."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from symgen.backends.c.bodies.causes import cause_names
from symgen.backends.c.bodies.pairs import pair_names
from symgen.backends.c.bodies.steps import TABLE, step_names
from symgen.backends.c.names import global_name
from symgen.backends.c.plain import emit_c
from symgen.backends.operations import count_operations
from symgen.backends.python.module import emit_python
from symgen.backends.scalars import SUFFIX, file_stem
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.draft import Draft
from symgen.generation.results import Options
from symgen.ir.kernel import Kernel, Literal, Program, Scalar
from symgen.ir.library_trig import with_library_trig
from symgen.laboratory.bench.candidate import CCandidate, CUnit, PythonCandidate, Task, adaptor
from symgen.lowering.schedule import schedule
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.methods.selection import every_method
from symgen.model.model import Model
from symgen.quantities.candidates import ABSOLUTE
from symgen.verify.running.python_module import PythonModule

PORTABLE, LIBRARY = "portable", "libm"


def generated(model: Model, task: Task, scalars: Sequence[Scalar], out: Path | None) -> Draft:
    """The task's kernel as a verified run left it in OUT/<model>; without one, or `out`, as derivation chooses it."""
    return as_recorded(model, (task.quantity,), Options(scalars=tuple(scalars), measured=out))


def programs_of(
    model: Model, task: Task, scalars: Sequence[Scalar], draft: Draft | None = None
) -> dict[str, Mapping[Scalar, Program]]:
    """The task's kernel alone, by method; first the `draft` that symgen generates, then what it did not take."""
    draft = draft or generated(model, task, scalars, None)
    choice = draft.choice(task.quantity)
    absolute = " in absolute angles" if choice.method and choice.title == ABSOLUTE else ""
    name = (choice.method or choice.title) + absolute + choice.digits
    by_method: dict[str, Mapping[Scalar, Program]] = {name: draft.written}
    for method, (mechanics, quantity) in _methods(model, task.quantity):
        if method not in by_method:
            programs = schedule(mechanics, [quantity], scalars)
            if not any(map(_never_valid, programs.values())):
                by_method[method] = programs
    return by_method


def _never_valid(program: Program) -> bool:
    """Whether a method divides by 0 at every state: one through the inverse of G, where a coordinate has no mass."""
    statements = (statement for kernel in program.kernels for statement in kernel.statements)
    divisors = (statement.operands[1] for statement in statements if statement.operation == "div")
    return any(isinstance(divisor, Literal) and divisor.value == 0 for divisor in divisors)


def _methods(model: Model, quantity: str) -> Iterator[tuple[str, tuple[System, Quantity]]]:
    """Every method by name, each on a graph of its own."""
    for method, mechanics, (derived,) in every_method(model, (quantity,)):
        yield method, (mechanics, derived)


def symgen_candidates(
    model: Model, programs: Mapping[str, Mapping[Scalar, Program]], scalar: Scalar
) -> tuple[CCandidate, ...]:
    """The C of every method for one scalar type."""
    candidates = []
    for number, (method, by_scalar) in enumerate(programs.items()):
        portable = by_scalar[scalar]
        trigonometric = any(s.operation == "sincos" for kernel in portable.kernels for s in kernel.statements)
        variants = {PORTABLE: portable} | ({LIBRARY: with_library_trig(portable)} if trigonometric else {})
        candidates += [
            replace(_candidate(model, program, method, trig), chosen=number == 0) for trig, program in variants.items()
        ]
    return tuple(candidates)


def symgen_python(
    model: Model, programs: Mapping[str, Mapping[Scalar, Program]], task: Task
) -> tuple[PythonCandidate, ...]:
    """The NumPy modules of every method, first the one that symgen generates."""
    return tuple(
        _python(model, by_scalar["float64"], method, task, number == 0)
        for number, (method, by_scalar) in enumerate(programs.items())
    )


def _python(model: Model, program: Program, method: str, task: Task, chosen: bool) -> PythonCandidate:
    (source,) = emit_python(model, program).values()
    module = PythonModule(str(source)).module
    function = getattr(module, task.quantity)

    def batch(q: Any, qd: Any, third: Any, p: Any) -> Any:
        return function(*_arrays(program.kernels[0], q, qd, third), p=module.Parameters(*p.T))

    def single(q: Sequence[float], qd: Sequence[float], third: Sequence[float], p: Sequence[float]) -> Any:
        return function(*_arrays(program.kernels[0], q, qd, third), p=module.Parameters(*p))

    return PythonCandidate("symgen", f"{method}, Python", batch, single, chosen)


def _arrays(kernel: Kernel, q: Any, qd: Any, third: Any) -> list[Any]:
    """The arguments the kernel has; those of length 0 are left out of signatures."""
    given = {"q": q, "qd": qd, "qdd": third, "u": third}
    return [given[argument.name] for argument in kernel.arguments if argument.length]


def _candidate(model: Model, program: Program, method: str, trig: str) -> CCandidate:
    kernel = program.kernels[0]
    files = emit_c(model, program)
    suffix = SUFFIX[program.scalar]
    stem = file_stem(model.c_name, program.scalar)
    function = global_name(model.c_name, program.scalar, kernel.name)
    entry = re.sub(r"\W", "_", f"symgen_{method}_{trig}_{program.scalar}")
    defaults = global_name(model.c_name, program.scalar, "default_params")  # every variant brings its own
    headers = {f"{stem}.h": str(files[f"c/{stem}.h"])}
    source = str(files[f"c/{stem}.c"])
    places = {"q": "q", "qd": "qd", "qdd": "x", "u": "x"}
    given = [places[argument.name] for argument in kernel.arguments if argument.length]
    if given == ["q", "qd", "x"]:
        units: tuple[CUnit, ...] = (CUnit(source, headers, {function: entry, defaults: f"{entry}_defaults"}),)
    else:
        # what the kernel does not depend on is left out of its signature
        own = f"{entry}_function"
        kept = CUnit(source, headers, {function: own, defaults: f"{entry}_defaults"})
        units = (kept, adaptor(entry, own, given))
    helpers = pair_names(model.c_name, suffix) | step_names(model.c_name, suffix) | {TABLE}
    functions = (function, *cause_names(kernel, function), *sorted(helpers))
    operations = {kind: count for kind, count in asdict(count_operations(kernel.statements)).items() if count}
    return CCandidate("symgen", f"{method}, {trig}", program.scalar, entry, units, functions, operations)
