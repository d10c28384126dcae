"""The whole way on one page: a model file goes in, every file of its folder comes out, nothing touches the disk.

    load -> derive -> schedule -> emit (C, Python) -> verify -> report

What a run does not need is not imported: the way from model to C uses the standard library, PyYAML and Jinja only.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from symgen.derivation_file import derivation_json
from symgen.diagnostics import ModelError, Notice
from symgen.dynamics.catalogue import BY_NAME
from symgen.dynamics.forms.motions import BY_FRAMES
from symgen.dynamics.inverse import FormChoice
from symgen.dynamics.select import Derivations, NoSuchFormError, derive_quantities, short_of_inputs
from symgen.dynamics.structure import Structure, analyse
from symgen.emit.c import emit_c
from symgen.emit.c_batch import emit_c_batch
from symgen.emit.c_prepared import emit_c_prepared
from symgen.emit.c_sc import emit_c_sc
from symgen.emit.operations import count_operations
from symgen.ir.kernel import Program, Scalar
from symgen.ir.library_trig import with_library_trig
from symgen.ir.schedule import schedule
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.model.names import did_you_mean
from symgen.records import dataclass
from symgen.results import FORMS, LargestError, Options, Result, Summary, WrongUseError

if TYPE_CHECKING:
    from symgen.background import Background, Receive
    from symgen.report.facts import Facts, ReportFiles
    from symgen.report.proof import ProofFacts
    from symgen.report.targets import TargetCore
    from symgen.verify.certificate import Certificate

# Measured on a chain of 16 links: 6336 operations in 45.6 kB with the single precision of a Cortex-M4, gcc -O2.
BYTES_AN_OPERATION = 7
LARGEST_CODE = 64_000

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class _Derived:
    """A model on its way: derived, scheduled, nothing printed yet."""

    model: Model
    derivations: Derivations
    structure: Structure
    programs: dict[Scalar, Program]

    @property
    def program(self) -> Program:
        """The float64 program, which Python, the counts and the report are made from."""
        return self.programs["float64"]


def generate(path: Path, options: Options, progress: Progress) -> Result:
    """All files of one model, verified unless told otherwise.

    Closed forms and report are worked out in a process of their own, while this one derives, prints and verifies.
    Raises ModelError for mistakes in the file and WrongUseError for outputs that do not exist; verification failures
    come back in the result.
    """
    progress("reading the model")
    model = load_model(path)
    outputs = _outputs(model, options)
    wanted = "report" in options.parts
    with _reporting(model, options.verify) if wanted else nullcontext() as reporting:
        progress("deriving")
        derived = _derive(model, outputs, options)
        if reporting is not None:
            reporting.send(_facts(derived))
        files = _code(derived, options)
        certificate = _verified(derived, files, options.states, progress) if options.verify else None
        result = _result(derived, options, files, certificate)
        if reporting is None or result.failures:
            return result
        progress("closed forms and report")
        reporting.send(certificate)
        reporting.send(_targets(derived.model, files, options))
        reporting.send(_proof(derived.model, files, options))
        report = reporting.answer()
    if report.mistakes:
        raise ModelError(str(path), path.read_text(encoding="utf-8"), report.mistakes)
    return replace(result, files={**result.files, **report.files}, notices=(*result.notices, *report.notices))


def explain(path: Path, quantity: str | None, progress: Progress, forms: Mapping[str, str] | None = None) -> str:
    """Structure and closed forms as text for the terminal; of one quantity when it is named.

    `forms` are those whose validity is told, by quantity.
    """
    from symgen.closedform.limits import TooLargeError
    from symgen.explain import forms_text, overview, quantity_text
    from symgen.report.gather import gather

    if quantity is not None and quantity not in BY_NAME:
        raise _unknown_quantity(quantity)
    progress("reading the model")
    model = load_model(path)
    if quantity is not None:
        model = replace(model, outputs=(*model.outputs, quantity))
    progress("deriving")
    derived = _derive(model, ("all",), Options(scalars=("float64",), forms=forms or {}))
    progress("closed forms")
    try:
        report = gather(model, _facts(derived))
    except TooLargeError as large:
        return f"closed forms are left out: {large}"
    text = overview(report) if quantity is None else quantity_text(report, quantity)
    told = dict.fromkeys(("inverse_dynamics", *(forms or ())) if quantity is None else (quantity,))
    compared = ((name, _compared(derived, name)) for name in told)
    return "\n".join([text, *(forms_text(name, choice) for name, choice in compared if choice is not None)])


def _compared(derived: _Derived, quantity: str) -> FormChoice | None:
    """What is known of the forms of a quantity; of the one asked for alone, where one was asked for."""
    derivations = derived.derivations
    if quantity == "inverse_dynamics":
        return derivations.form
    from symgen.dynamics.by_name import forms_compared

    taken = {choice.quantity: choice.form for choice in derivations.choices}
    named = dict(derivations.named)
    if quantity in named or quantity not in FORMS or quantity not in taken:
        return named.get(quantity)
    return forms_compared(derived.model, derivations.generic, quantity, taken[quantity])


def _outputs(model: Model, options: Options) -> tuple[str, ...]:
    outputs = options.outputs or model.outputs
    if unknown := [name for name in outputs if name != "all" and name not in BY_NAME]:
        raise _unknown_quantity(unknown[0])
    return outputs


def _unknown_quantity(name: str) -> WrongUseError:
    remedy = did_you_mean(name, [*BY_NAME], "symgen explain MODEL.yaml lists those of a model")
    return WrongUseError(f"unknown quantity {name!r}; {remedy}")


def _derive(model: Model, outputs: tuple[str, ...], options: Options) -> _Derived:
    try:
        derivations = derive_quantities(model, outputs, options.forms)
    except NoSuchFormError as reason:
        raise WrongUseError(f"{model.name} has {reason}") from reason
    structure = analyse(derivations.mechanics, derivations.generic)
    scalars: tuple[Scalar, ...] = ("float64", *(s for s in options.scalars if s != "float64"))
    programs = schedule(derivations.mechanics, derivations.quantities, scalars)
    if options.trig == "libm":
        programs = {scalar: with_library_trig(program) for scalar, program in programs.items()}
    return _Derived(model, derivations, structure, programs)


def _code(derived: _Derived, options: Options) -> dict[str, str | bytes]:
    files: dict[str, str | bytes] = {}
    sources: dict[str, str] = {}
    programs = [derived.programs[scalar] for scalar in options.scalars]
    if {"c", "package"} & {*options.parts}:
        for program in programs:
            for emit in (emit_c, emit_c_batch, emit_c_prepared, emit_c_sc):
                sources |= emit(derived.model, program)
    if "c" in options.parts:
        files |= sources
    if "package" in options.parts:
        from symgen.package.files import emit_package

        files |= emit_package(derived.model, programs, sources)
    if "proof" in options.parts:
        from symgen.proof.files import emit_proofs

        files |= emit_proofs(derived.model, programs)
    if "python" in options.parts:
        from symgen.emit.python import emit_python

        files |= emit_python(derived.model, derived.program)
    files["derivation.json"] = derivation_json(derived.model, derived.derivations, derived.structure, derived.program)
    return files


def _verified(derived: _Derived, files: dict[str, str | bytes], states: int, progress: Progress) -> Certificate | None:
    """What is wrong with the files just made; None when there is no code among them."""
    from symgen.verify.run import generated_sources, verify

    c_sources, python_source = generated_sources(derived.model, files)
    if not c_sources and python_source is None:
        return None
    return verify(derived.model, derived.program.kernels, c_sources, python_source, states, progress)


def _facts(derived: _Derived) -> Facts:
    from symgen.report.facts import Facts

    operations = {kernel.name: count_operations(kernel.statements) for kernel in derived.program.kernels}
    decisions = tuple((decision.what, decision.why) for decision in derived.structure.decisions)
    return Facts(operations, (*decisions, *derived.derivations.absent, *_failing_forms(derived)))


def _failing_forms(derived: _Derived) -> tuple[tuple[str, str], ...]:
    """Where what is generated is not valid if a form was asked for, and which forms are left to be asked for and where
    they fail."""
    derivations = derived.derivations
    form, inverse = derivations.form, derivations.inverse
    told = list(_forms(derivations, ()))
    if form is not None and inverse is not None and form.verdict.admitted:
        others = inverse.failing() or form.failed
        told += ((f"form {name} of u", f"{why}; it is made if asked for (--form {name})") for name, why in others)
    # articulated inertias are taken only where G is definite, and then no form fails
    moving = [choice.quantity for choice in derivations.choices if choice.form not in ("", BY_FRAMES)]
    if moving:
        from symgen.dynamics.by_name import failing_motions

        for name, why in failing_motions(derivations.mechanics):
            asked = " ".join(f"--form {quantity}={name}" for quantity in moving)
            told.append((f"form {name} of {' and '.join(moving)}", f"{why}; it is made if asked for ({asked})"))
    return tuple(told)


def _reporting(model: Model, measured: bool) -> Background[ReportFiles]:
    from symgen.background import Background
    from symgen.emit import render

    render.load()
    return Background(lambda receive: _report(model, receive, measured))


def _forms(derivations: Derivations, failed: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
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
    derived: _Derived, options: Options, files: dict[str, str | bytes], certificate: Certificate | None
) -> Result:
    if certificate is not None:
        files = {**files, "certificate.json": json.dumps(certificate.to_json(), indent=2, ensure_ascii=False) + "\n"}
    return Result(
        model=derived.model,
        files=files,
        summary=_summary(derived, certificate),
        notices=(*derived.model.notices, *_notices(derived, options, certificate)),
        certificate=None if certificate is None else certificate.to_json(),
        failures=() if certificate is None else certificate.failures,
    )


def _summary(derived: _Derived, certificate: Certificate | None) -> Summary:
    generic, form = derived.derivations.generic, derived.derivations.form
    summary = Summary(
        n=generic.n,
        r=generic.r,
        delta=generic.delta,
        m=generic.m,
        skipped=(
            *((decision.what, decision.why) for decision in derived.structure.decisions),
            *_forms(derived.derivations, () if form is None else form.failed),
        ),
        operations=tuple((k.name, count_operations(k.statements).total) for k in derived.program.kernels),
    )
    if certificate is None:
        return summary
    from symgen.verify.tolerance import FACTOR

    worst = [certificate.worst(target) for target in certificate.targets]
    errors = tuple(LargestError(w.target, w.quantity, w.largest, FACTOR) for w in worst)
    return replace(summary, errors=errors)


def _size(derived: _Derived, options: Options) -> tuple[Notice, ...]:
    """How much machine code the C takes, where small targets do not hold it; code is written out, never looped."""
    counts = {kernel.name: count_operations(kernel.statements).total for kernel in derived.program.kernels}
    size = BYTES_AN_OPERATION * sum(counts.values())
    if size <= LARGEST_CODE or "c" not in options.parts:
        return ()
    each = ", ".join(f"{name} {round(BYTES_AN_OPERATION * count / 1000)} kB" for name, count in counts.items())
    return (
        Notice(
            f"the C takes about {round(size / 1000)} kB of machine code on a Cortex-M4 ({sum(counts.values())} "
            f"operations written out: {each}); where that is too much, name fewer with --outputs"
        ),
    )


def _notices(derived: _Derived, options: Options, certificate: Certificate | None) -> tuple[Notice, ...]:
    """Quantities asked for by name that this model does not have, and what could not be verified."""
    asked = options.outputs or derived.model.outputs
    absent = [Notice(f"{n} is not generated: {why}") for n, why in derived.derivations.absent if n in asked]
    kernels = {kernel.name for kernel in derived.program.kernels}
    idle = [Notice(f"--form {n}={form}: {n} is not generated") for n, form in options.forms.items() if n not in kernels]
    unverified = () if certificate is None else certificate.notes
    return (*absent, *_short(derived), *_size(derived, options), *idle, *map(Notice, unverified))


def _short(derived: _Derived) -> tuple[Notice, ...]:
    """That u cannot produce every motion."""
    generic = derived.derivations.generic
    asked = any(kernel.name == "inverse_dynamics" for kernel in derived.program.kernels)
    return (Notice(f"inverse_dynamics: {short_of_inputs(generic)}"),) if asked and not generic.full_actuation else ()
