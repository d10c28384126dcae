"""The whole way on one page: a model file goes in, every file of its folder comes out, nothing touches the disk.

    load -> derive -> schedule -> emit (C, Python) -> verify -> report

What a run does not need is not imported: the way from model to C uses the standard library, PyYAML and Jinja only.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Container, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from symgen.backends.literals import LiteralRangeError
from symgen.backends.operations import count_operations
from symgen.diagnostics import ModelError, Notice
from symgen.generation.dense_motion import dense_motions
from symgen.generation.draft import Draft, draft_of
from symgen.generation.files import backend_of, files_of, sources_of, verified
from symgen.generation.refusals import beyond_range, no_states
from symgen.generation.results import FORMS, LargestError, Options, Result, Summary, WrongUseError
from symgen.ir.kernel import Kernel, Program, Scalar
from symgen.ir.wide_functions import works_with_pairs
from symgen.methods.forward_dynamics.motions import BY_FRAMES
from symgen.methods.selection import MethodChoice
from symgen.model.expressions.names import did_you_mean
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.quantities.catalogue import BY_NAME
from symgen.quantities.everything import OF_ALL
from symgen.quantities.finish import short_of_inputs
from symgen.quantities.select import Selection
from symgen.runtime.activity import working
from symgen.runtime.garbage import let_go_and_keep

if TYPE_CHECKING:
    from symgen.generation.fallback import Fallback
    from symgen.report.facts import Facts, ReportFiles
    from symgen.report.proof import ProofFacts
    from symgen.report.targets import TargetCore
    from symgen.runtime.background import Background, Receive
    from symgen.verify.certificate import Certificate
    from symgen.verify.expected import Expected

# Measured on a chain of 16 links: 6336 operations in 45.6 kB with the single precision of a Cortex-M4, gcc -O2.
BYTES_AN_OPERATION = 7
# What a step of `backends/c/steps.py` takes in its table.
BYTES_A_STEP = 14
LARGEST_CODE = 64_000
# Scalars, at half a kilobyte each: derivations of fewer leave little behind.
LARGE_GRAPH = 100_000
# Statements of all kernels in all scalar types: trying them is nothing beside writing and compiling their C.
LONG = 50_000

Progress = Callable[[str], None]


def generate(path: Path, options: Options, progress: Progress) -> Result:
    """All files of one model, verified unless told otherwise.

    Closed forms and report are worked out in a process of their own, while this one derives, prints and verifies.
    What verification rejects takes the next valid way, or is left out where none passes.  Raises ModelError for
    mistakes in the file and WrongUseError for outputs that do not exist; verification failures come back in the result.
    """
    progress("reading the model")
    model = load_model(path)
    outputs = _outputs(model, options)
    draft: Draft | None = None
    expected: Expected | None = None
    fallback: Fallback | None = None
    while True:
        with _reporting(model, options.verify) if "report" in options.parts else nullcontext() as reporting:
            if draft is None:
                progress("deriving")
                draft = _derive(model, outputs, options)
                if len(draft.derivations.mechanics.graph) > LARGE_GRAPH:
                    let_go_and_keep()
                if options.verify and verified(options) and _is_long(draft.programs):
                    from symgen.generation.trial import Trial

                    with _literals_in_range(path):
                        trial = Trial(path, draft, options, progress)
                    fallback, expected = trial.fallback, trial.expected
                    draft, tried = trial.settled(draft)
                    if not draft.program.kernels:
                        return _result(draft, options, {}, replace(tried, left_out=draft.left_out))
            if reporting is not None:
                reporting.send(_facts(draft))
            progress("writing")
            with _literals_in_range(path):
                sources = sources_of(draft, options)
            certificate, expected = _verified(draft, sources, options, progress, expected)
            if certificate is not None and expected is None and certificate.faults:
                raise ModelError(str(path), path.read_text(encoding="utf-8"), (no_states(draft.model, certificate),))
            other = None
            if certificate is not None and expected is not None:
                from symgen.generation.fallback import Fallback

                fallback = fallback or Fallback(options, progress)
                other = fallback.other(draft, certificate, expected)
            if other is None or certificate is None:
                with _literals_in_range(path):
                    files = files_of(draft, options, sources)
                return _finished(path, draft, options, files, certificate, reporting, progress)
        # again: with other ways for what was rejected, or in the end without these quantities
        draft = other
        if not draft.program.kernels:
            return _result(draft, options, {}, replace(certificate, left_out=draft.left_out))


def _finished(
    path: Path,
    draft: Draft,
    options: Options,
    files: dict[str, str | bytes],
    certificate: Certificate | None,
    reporting: Background[ReportFiles] | None,
    progress: Progress,
) -> Result:
    """The result of a draft that nothing replaces any more, with the report where one is made."""
    result = _result(draft, options, files, certificate)
    if reporting is None or result.failures:
        return result
    progress("closed forms and report")
    reporting.send(certificate)
    reporting.send(_targets(draft.model, files, options))
    reporting.send(_proof(draft.model, files, options))
    with working("typesetting"):
        report = reporting.answer()
    if report.mistakes:
        raise ModelError(str(path), path.read_text(encoding="utf-8"), report.mistakes)
    return replace(result, files={**result.files, **report.files}, notices=(*result.notices, *report.notices))


def explain(
    path: Path,
    quantity: str | None,
    progress: Progress,
    forms: Mapping[str, str] | None = None,
    out: Path | None = None,
) -> str:
    """Structure and closed forms as text for the terminal; of one quantity when it is named.

    `forms` are those whose validity is told, by quantity.  Kernels are those of OUT/<model>, where a run has verified
    some.
    """
    from symgen.closedform.algebra.limits import TooLargeError
    from symgen.generation.explain import forms_text, overview, quantity_text
    from symgen.report.gather import gather

    if quantity is not None and quantity not in BY_NAME:
        raise _unknown_quantity(quantity)
    progress("reading the model")
    model = load_model(path)
    if quantity is not None:
        model = replace(model, outputs=(*model.outputs, quantity))
    progress("deriving")
    from symgen.generation.recorded import as_recorded

    draft = as_recorded(model, ("all",), Options(scalars=("float64",), forms=forms or {}, measured=out))
    progress("closed forms")
    try:
        report = gather(model, _facts(draft))
    except TooLargeError as large:
        return f"closed forms are left out: {large}"
    text = overview(report) if quantity is None else quantity_text(report, quantity)
    names = dict.fromkeys(("inverse_dynamics", *(forms or ())) if quantity is None else (quantity,))
    compared = ((name, _compared(draft, name)) for name in names)
    parts = [text, *(forms_text(name, choice) for name, choice in compared if choice is not None)]
    notices = [*draft.notes, *(notice.message for notice in _replaced(draft, None if quantity is None else names))]
    return "\n".join([*parts, *(f"\n{notice}" for notice in notices)])


def _compared(draft: Draft, quantity: str) -> MethodChoice | None:
    """What is known of the forms of a quantity; of the one asked for alone, where one was asked for."""
    derivations = draft.derivations
    if quantity == "inverse_dynamics":
        return derivations.form
    taken = {choice.quantity: choice.form for choice in derivations.choices}
    named = dict(derivations.named)
    if quantity in named or quantity not in FORMS or quantity not in taken:
        return named.get(quantity)
    methods = derivations.methods
    return None if methods is None else methods.compared(quantity, taken[quantity])


def _outputs(model: Model, options: Options) -> tuple[str, ...]:
    outputs = options.outputs or model.outputs
    if unknown := [name for name in outputs if name != "all" and name not in BY_NAME]:
        raise _unknown_quantity(unknown[0])
    return outputs


def _unknown_quantity(name: str) -> WrongUseError:
    remedy = did_you_mean(name, [*BY_NAME], "symgen explain MODEL.yaml lists those of a model")
    return WrongUseError(f"unknown quantity {name!r}; {remedy}")


def _derive(model: Model, outputs: tuple[str, ...], options: Options) -> Draft:
    if not options.as_recorded or options.measured is None:
        return draft_of(model, outputs, options)
    from symgen.generation.recorded import as_recorded

    return as_recorded(model, outputs, options)


def _is_long(programs: Mapping[Scalar, Program]) -> bool:
    every = (kernel for program in programs.values() for kernel in program.kernels)
    return sum(len(block.statements) for kernel in every for block in kernel.blocks) > LONG


@contextmanager
def _literals_in_range(path: Path) -> Iterator[None]:
    """Numbers of the file that a scalar type does not hold are its author's mistake."""
    try:
        yield
    except LiteralRangeError as error:
        raise ModelError(str(path), "", (beyond_range(error),)) from error


def _verified(
    draft: Draft,
    sources: Mapping[str, str],
    options: Options,
    progress: Progress,
    expected: Expected | None,
) -> tuple[Certificate | None, Expected | None]:
    """What is wrong with the sources that are asked for, and what is expected at the states; None where there are none,
    or without verification."""
    if not options.verify:
        return None, None
    from symgen.verify.run import generated_sources, verify_expecting

    run = {path: text for path, text in sources.items() if backend_of(path) in verified(options)}
    c_sources, python_source = generated_sources(draft.model, run)
    if not c_sources and python_source is None:
        return None, None
    kernels = {scalar: program.kernels for scalar, program in draft.programs.items()}
    found = verify_expecting(draft.model, kernels, c_sources, python_source, options.states, progress, expected)
    return replace(found[0], left_out=draft.left_out), found[1]


def _facts(draft: Draft) -> Facts:
    from symgen.report.facts import Facts

    operations = {kernel.name: count_operations(kernel.statements) for kernel in draft.program.kernels}
    decisions = tuple((decision.what, decision.why) for decision in draft.structure.decisions)
    derivations = draft.derivations
    rejected = ((f"form {r.way} of {r.quantity}", f"verification rejects it: {r.why}") for r in derivations.rejected)
    return Facts(operations, (*decisions, *derivations.absent, *rejected, *_failing_forms(draft)))


def _failing_forms(draft: Draft) -> tuple[tuple[str, str], ...]:
    """Where what is generated is not valid if a form was asked for, and which forms are left to be asked for and where
    they fail."""
    derivations = draft.derivations
    form, methods = derivations.form, derivations.methods
    remarks = list(_forms(derivations, ()))
    if form is not None and methods is not None and form.verdict.admitted:
        others = methods.failing() or form.failed
        remarks += ((f"form {name} of u", f"{why}; it is made if asked for (--form {name})") for name, why in others)
    # articulated inertias are taken only where G is definite, and then no form fails
    moving = [choice.quantity for choice in derivations.choices if choice.form not in ("", BY_FRAMES)]
    if moving:
        from symgen.methods.forward_dynamics.motions import failing_motions

        for name, why in failing_motions(derivations.mechanics):
            asked = " ".join(f"--form {quantity}={name}" for quantity in moving)
            remarks.append((f"form {name} of {' and '.join(moving)}", f"{why}; it is made if asked for ({asked})"))
    return tuple(remarks)


def _reporting(model: Model, measured: bool) -> Background[ReportFiles]:
    from symgen.backends import render
    from symgen.runtime.background import Background

    render.load()
    return Background(lambda receive: _report(model, receive, measured))


def _forms(derivations: Selection, failed: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
    """Whether forms that were asked for are not valid at every regular state; if not, those of u that `failed`."""
    form = derivations.form
    asked = ((("u", form),) if form is not None else ()) + derivations.named
    return (
        *(
            (f"validity of {quantity} at every regular state", f"form {one.way}: {one.verdict.explanation}")
            for quantity, one in asked
            if not one.verdict.admitted
        ),
        *((f"form {name} of u", why) for name, why in failed if form is not None and form.verdict.admitted),
    )


def _targets(model: Model, files: dict[str, str | bytes], options: Options) -> tuple[TargetCore, ...]:
    """What was measured on targets with these very files."""
    from symgen.report.targets import read_targets

    return () if options.measured is None else read_targets(options.measured / model.name / "target.json", files)


def _proof(model: Model, files: dict[str, str | bytes], options: Options) -> ProofFacts | None:
    """What was proved about these very files."""
    from symgen.report.proof import read_proof

    return None if options.measured is None else read_proof(options.measured / model.name / "proof.json", files)


def _report(model: Model, receive: Receive, measured: bool) -> ReportFiles:
    from symgen.report.files import report_files

    return report_files(model, receive, measured)


def _result(
    draft: Draft, options: Options, files: dict[str, str | bytes], certificate: Certificate | None
) -> Result:
    if certificate is not None:
        files = {**files, "certificate.json": json.dumps(certificate.to_json(), indent=2, ensure_ascii=False) + "\n"}
    return Result(
        model=draft.model,
        files=files,
        summary=_summary(draft, certificate),
        notices=(*draft.model.notices, *_notices(draft, options, certificate)),
        certificate=None if certificate is None else certificate.to_json(),
        failures=() if certificate is None else certificate.failures,
        left_out=draft.left_out,
        programs=draft.programs,
    )


def _summary(draft: Draft, certificate: Certificate | None) -> Summary:
    generic, form = draft.derivations.generic, draft.derivations.form
    summary = Summary(
        n=generic.n,
        r=generic.r,
        delta=generic.delta,
        m=generic.m,
        skipped=(
            *((decision.what, decision.why) for decision in draft.structure.decisions),
            *_forms(draft.derivations, () if form is None else form.failed),
        ),
        operations=tuple((k.name, count_operations(k.statements).total) for k in draft.program.kernels),
    )
    if certificate is None:
        return summary
    from symgen.verify.tolerance import FACTOR

    worst = [certificate.worst(target) for target in certificate.targets]
    errors = tuple(LargestError(w.target, w.quantity, w.largest, FACTOR) for w in worst)
    return replace(summary, errors=errors)


def _size(draft: Draft, options: Options) -> tuple[Notice, ...]:
    """How much machine code the C takes, where small targets do not hold it: all but steps of tables is written out."""
    sizes = {kernel.name: _bytes(kernel) for kernel in draft.program.kernels}
    size = sum(sizes.values())
    if size <= LARGEST_CODE or "c" not in options.parts:
        return ()
    each = ", ".join(f"{name} {round(count / 1000)} kB" for name, count in sizes.items())
    return (
        Notice(
            f"the C takes about {round(size / 1000)} kB of machine code on a Cortex-M4 ({each}); where that is too "
            "much, name fewer with --outputs"
        ),
    )


def _bytes(kernel: Kernel) -> int:
    if works_with_pairs(kernel):
        return BYTES_A_STEP * len(kernel.statements)
    return BYTES_AN_OPERATION * count_operations(kernel.statements).total


def _notices(draft: Draft, options: Options, certificate: Certificate | None) -> tuple[Notice, ...]:
    """Quantities asked for by name that this model does not have, and what could not be verified."""
    asked = options.outputs or draft.model.outputs
    left_out = {one.quantity for one in draft.left_out}
    known = [(n, why) for n, why in draft.derivations.absent if n in asked and n not in left_out]
    absent = [Notice(f"{n} is not generated: {why}") for n, why in known]
    of_all = ((n, why) for n, why in draft.derivations.absent if why.startswith(OF_ALL))
    absent += [Notice(f"{n}: {why}") for n, why in of_all]
    kernels = {kernel.name for kernel in draft.program.kernels}
    idle = [Notice(f"--form {n}={form}: {n} is not generated") for n, form in options.forms.items() if n not in kernels]
    unverified = () if certificate is None else certificate.notes
    ways = (*_replaced(draft), *_short(draft), *dense_motions(draft, options))
    recorded = draft.notes if options.as_recorded else ()
    notices = (*absent, *ways, *_size(draft, options), *idle, *map(Notice, (*unverified, *recorded)))
    return (*_renamed(draft.model), *notices)


def _renamed(model: Model) -> tuple[Notice, ...]:
    """That files and functions are not called as the model."""
    if model.c_name == model.name:
        return ()
    why = f"`{model.name}` clashes with a header, a library, a macro or what another model's files are called"
    return (Notice(f"its files and functions are called {model.c_name}: {why}"),)


def _replaced(draft: Draft, quantities: Container[str] | None = None) -> tuple[Notice, ...]:
    """The quantities (None: all) that take another way than the cheapest, because verification rejected that."""
    found = []
    left_out = {one.quantity for one in draft.left_out}
    for choice in draft.derivations.choices:
        if choice.quantity in left_out or (quantities is not None and choice.quantity not in quantities):
            continue
        tried = [f"{r.way} ({r.why})" for r in draft.derivations.rejected if r.quantity == choice.quantity]
        if tried:
            others = ", ".join(tried)
            way = choice.way + choice.digits
            found.append(Notice(f"{choice.quantity} takes {way}: verification speaks against {others}"))
    return tuple(found)


def _short(draft: Draft) -> tuple[Notice, ...]:
    """That u cannot produce every motion."""
    generic = draft.derivations.generic
    asked = any(kernel.name == "inverse_dynamics" for kernel in draft.program.kernels)
    return (Notice(f"inverse_dynamics: {short_of_inputs(generic)}"),) if asked and not generic.full_actuation else ()
