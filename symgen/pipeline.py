"""The whole way on one page: a model file goes in, every file of its folder comes out, nothing touches the disk.

    load -> derive -> schedule -> emit (C, Python) -> verify -> report

What a run does not need is not imported: the way from model to C uses the standard library, PyYAML and Jinja only.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from symgen.derivation_file import derivation_json
from symgen.diagnostics import ModelError, Notice
from symgen.dynamics.catalogue import BY_NAME
from symgen.dynamics.select import Derivations, derive_quantities
from symgen.dynamics.structure import Structure, analyse
from symgen.emit.c import emit_c
from symgen.emit.operations import count_operations
from symgen.emit.python import emit_python
from symgen.ir.kernel import Program, Scalar
from symgen.ir.schedule import schedule
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.naming import file_stem
from symgen.results import LargestError, Options, Result, Summary, WrongUseError

if TYPE_CHECKING:
    from symgen.report.content import ReportInput
    from symgen.verify.certificate import Certificate

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

    Raises ModelError for mistakes in the file and WrongUseError for outputs that do not exist; verification failures
    come back in the result.
    """
    derived = _derive(path, options, progress)
    files = _code(derived, options)
    certificate = _verified(derived, options, files, progress) if options.verify else None
    notices = _notices(derived, options, certificate)
    if "report" in options.parts and (certificate is None or certificate.passed):
        progress("closed forms and report")
        report = _gathered(derived)
        if isinstance(report, Notice):
            notices += (report,)
        else:
            notices += _integrable_rows(report)
            files |= _report(path, report, certificate)
    if certificate is not None:
        files["certificate.json"] = json.dumps(certificate.to_json(), indent=2, ensure_ascii=False) + "\n"
    return Result(
        model=derived.model,
        files=files,
        summary=_summary(derived, certificate),
        notices=(*derived.model.notices, *notices),
        certificate=None if certificate is None else certificate.to_json(),
        failures=() if certificate is None else certificate.failures,
    )


def explain(path: Path, quantity: str | None, progress: Progress) -> str:
    """Structure and closed forms as text for the terminal; of one quantity when it is named."""
    from symgen.explain import overview, quantity_text

    if quantity is not None and quantity not in BY_NAME:
        raise WrongUseError(f"unknown quantity {quantity!r}; symgen explain MODEL.yaml lists them")
    derived = _derive(path, Options(outputs=("all",), scalars=("float64",)), progress)
    progress("closed forms")
    report = _gathered(derived)
    if isinstance(report, Notice):
        return report.message
    return overview(report) if quantity is None else quantity_text(report, quantity)


def _derive(path: Path, options: Options, progress: Progress) -> _Derived:
    progress("reading the model")
    model = load_model(path)
    outputs = options.outputs or model.outputs
    if unknown := [name for name in outputs if name != "all" and name not in BY_NAME]:
        raise WrongUseError(f"unknown quantity {unknown[0]!r}; symgen explain {path} lists those of this model")
    progress("deriving")
    derivations = derive_quantities(model, outputs)
    structure = analyse(derivations.mechanics, derivations.generic)
    scalars: tuple[Scalar, ...] = ("float64", *(s for s in options.scalars if s != "float64"))
    programs = schedule(derivations.mechanics, derivations.quantities, scalars)
    return _Derived(model, derivations, structure, programs)


def _code(derived: _Derived, options: Options) -> dict[str, str | bytes]:
    files: dict[str, str | bytes] = {}
    if "c" in options.parts:
        for scalar in options.scalars:
            files |= emit_c(derived.model, derived.programs[scalar])
    if "python" in options.parts:
        files |= emit_python(derived.model, derived.program)
    files["derivation.json"] = derivation_json(
        derived.model, derived.derivations, derived.structure, derived.program
    )
    return files


def _verified(
    derived: _Derived, options: Options, files: dict[str, str | bytes], progress: Progress
) -> Certificate | None:
    """What is wrong with the files just made; None when there is no code among them."""
    from symgen.verify.run import generated_sources, verify

    c_sources, python_source = generated_sources(derived.model, files)
    if not c_sources and python_source is None:
        return None
    return verify(derived.model, derived.program.kernels, c_sources, python_source, options.states, progress)


def _gathered(derived: _Derived) -> ReportInput | Notice:
    """What the report says, or why B or M are too long to be written out at all."""
    from symgen.closedform.limits import TooLargeError
    from symgen.report.gather import gather

    try:
        return gather(derived.model, derived.derivations, derived.structure, derived.program)
    except TooLargeError as large:
        return Notice(f"closed forms and report are left out: {large}")


def _integrable_rows(report: ReportInput) -> tuple[Notice, ...]:
    return tuple(
        Notice(f"the non-holonomic row {row.row} is integrable: {row.explanation}")
        for row in report.integrability
        if row.verdict == "integrable"
    )


def _report(path: Path, report: ReportInput, certificate: Certificate | None) -> dict[str, str | bytes]:
    """HTML and LaTeX are functions of the model; a verified run adds the PDF, which says what it measured."""
    from symgen.report.compose import compose
    from symgen.report.gather import path_charts, with_measurements
    from symgen.report.html import render_html
    from symgen.report.latex import render_latex

    model, stem = report.model, file_stem(report.model.name)
    document = compose(report)
    files: dict[str, str | bytes] = {
        f"report/{stem}.html": render_html(document),
        f"report/{stem}.tex": render_latex(document),
    }
    if certificate is None:
        return files
    from symgen.paths.path_equations import PathError
    from symgen.report.pdf import render_pdf

    try:
        charts = path_charts(model)
    except PathError as error:
        raise ModelError(str(path), path.read_text(encoding="utf-8"), (error.mistake,)) from error
    return {**files, f"report/{stem}.pdf": render_pdf(compose(with_measurements(report, certificate, charts)))}


def _summary(derived: _Derived, certificate: Certificate | None) -> Summary:
    generic = derived.derivations.generic
    summary = Summary(
        n=generic.n,
        r=generic.r,
        delta=generic.delta,
        m=generic.m,
        skipped=tuple((decision.what, decision.why) for decision in derived.structure.decisions),
        operations=tuple((k.name, count_operations(k.statements).total) for k in derived.program.kernels),
    )
    if certificate is None:
        return summary
    from symgen.verify.tolerance import FACTOR

    worst = [certificate.worst(target) for target in certificate.targets]
    errors = tuple(LargestError(w.target, w.quantity, w.largest, FACTOR) for w in worst)
    return replace(summary, errors=errors)


def _notices(derived: _Derived, options: Options, certificate: Certificate | None) -> tuple[Notice, ...]:
    """Quantities asked for by name that this model does not have, and what could not be verified."""
    asked = options.outputs or derived.model.outputs
    absent = [Notice(f"{n} is not generated: {why}") for n, why in derived.derivations.absent if n in asked]
    return (*absent, *(Notice(note) for note in (() if certificate is None else certificate.notes)))
