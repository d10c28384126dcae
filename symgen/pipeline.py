"""The whole way on one page: a model file goes in, every file of its folder comes out, nothing touches the disk.

    load -> derive -> schedule -> emit (C, Python) -> verify -> report

What a run does not need is not imported: the way from model to C uses the standard library, PyYAML, Jinja and
python-flint only, its verification NumPy as well.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from symgen.backends.literals import LiteralRangeError, check_literals
from symgen.backends.operations import count_operations
from symgen.diagnostics import ModelError, Notice
from symgen.generation.draft import Draft, draft_of
from symgen.generation.facts import facts, invalid_methods
from symgen.generation.files import backend_of, files_of, sources_of, verified
from symgen.generation.notices import notices
from symgen.generation.packages import without_report
from symgen.generation.refusals import beyond_range
from symgen.generation.requested import requested_outputs
from symgen.generation.results import LargestError, Options, Result, Summary
from symgen.model.asked_base import with_inertial_base
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.runtime.activity import Work, working

if TYPE_CHECKING:
    from symgen.generation.acceptance.coordinate_bounds import CoordinateBounds
    from symgen.generation.acceptance.parameter_bounds import ParameterBounds
    from symgen.generation.acceptance.trial import Trial
    from symgen.report.facts import ReportFiles
    from symgen.report.proof import ProofFacts
    from symgen.report.targets import TargetCore
    from symgen.runtime.background import Background, Receive
    from symgen.verify.certificate import Certificate
    from symgen.verify.expected import Expected

Progress = Callable[[str], None]
# What a run with verification takes, times its derivation: 5 to 14 for models that were measured, mostly 6 to 11.
WHOLE_PER_DERIVING = 8
# Seconds from which that is told.
WORTH_FORESEEING = 20


def generate(path: Path, options: Options, progress: Progress) -> Result:
    """All files of one model, verified unless told otherwise.

    Closed forms and report are worked out in a process of their own, while this one derives, prints and verifies.
    What verification rejects takes the next valid method, or is left out where none passes.  Raises ModelError for
    mistakes in the file and WrongUseError for outputs that do not exist; verification failures come back in the result.
    """
    with working("") as whole:
        progress("reading the model")
        # nearly all of what takes longer than a moment there
        with working("where its loops close"):
            model = load_model(path)
        return _generated(path, model, options, progress, whole)


def generate_of(path: Path, model: Model, options: Options, progress: Progress) -> Result:
    """The same of a model that was read from the file at `path`, and changed since then if need be."""
    with working("") as whole:
        return _generated(path, model, options, progress, whole)


def _generated(path: Path, model: Model, options: Options, progress: Progress, whole: Work) -> Result:
    """The same; `whole` is told what the run takes as soon as that can be foreseen."""
    options, report_notices = without_report(model, options)
    outputs = requested_outputs(model, options)
    model = with_inertial_base(model, outputs)
    draft: Draft | None = None
    trial: Trial | None = None
    limits: tuple[CoordinateBounds | ParameterBounds, ...] = ()
    while True:
        with _reporting(model, options.verify) if "report" in options.parts else nullcontext() as reporting:
            if draft is None:
                progress("deriving")
                began = time.monotonic()
                draft = _derive(model, outputs, options)
                if options.verify and verified(options):
                    whole.part = _foreseen(time.monotonic() - began)
                    from symgen.generation.acceptance.coordinate_bounds import CoordinateBounds
                    from symgen.generation.acceptance.parameter_bounds import ParameterBounds
                    from symgen.generation.acceptance.trial import Trial

                    with _literals_in_range(path):
                        trial = Trial(path, draft, options, progress)
                    draft, tried = trial.settled(draft)
                    if not draft.program.kernels:
                        return _result(draft, options, {}, replace(tried, left_out=draft.left_out))
                    expected = trial.expected
                    varied = () if options.fixed_parameters else (ParameterBounds(expected),)
                    limits = (CoordinateBounds(expected), *varied)
            if trial is not None:
                with _literals_in_range(path):
                    check_literals(draft.programs)
                draft = trial.ranks.of(draft)
            for limit in limits:
                progress(f"verifying: {limit.WHAT}")
                draft = limit.of(draft)
            if reporting is not None:
                reporting.send(facts(draft))
            progress("writing")
            with _literals_in_range(path):
                sources = sources_of(draft, options)
            certificate = None if trial is None else _verified(draft, sources, options, progress, trial.expected)
            other = None
            if trial is not None and certificate is not None:
                other = trial.fallback.other(draft, certificate, trial.expected)
            if other is None or certificate is None:
                with _literals_in_range(path):
                    files = files_of(draft, options, sources)
                result = _finished(path, draft, options, files, certificate, reporting, progress)
                return replace(result, notices=(*result.notices, *report_notices))
        # again: by other methods for what was rejected, or in the end without these quantities
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
    notices = [*result.notices, *report.notices]
    if report.files and certificate is None and not options.as_recorded:
        remedy = "; `--only c,report` measures it" if options.verify else ""
        notices.append(Notice(f"the report has no PDF: that is made of what verification measures, too{remedy}"))
    return replace(result, files={**result.files, **report.files}, notices=tuple(notices))


def _foreseen(deriving: float) -> str:
    """How long the run takes as a whole, where its derivation took so many seconds; nothing for short ones."""
    seconds = WHOLE_PER_DERIVING * deriving
    return f"about {round(seconds, -1):.0f} s in all" if seconds >= WORTH_FORESEEING else ""


def _derive(model: Model, outputs: tuple[str, ...], options: Options) -> Draft:
    if not options.as_recorded or options.measured is None:
        return draft_of(model, outputs, options)
    from symgen.generation.acceptance.recorded import as_recorded

    return as_recorded(model, outputs, options)


@contextmanager
def _literals_in_range(path: Path) -> Iterator[None]:
    """Numbers of the file that a scalar type does not hold are its author's mistake."""
    try:
        yield
    except LiteralRangeError as error:
        raise ModelError(str(path), "", (beyond_range(error),)) from error


def _verified(
    draft: Draft, sources: Mapping[str, str], options: Options, progress: Progress, expected: Expected
) -> Certificate | None:
    """What is wrong with the sources that are asked for; None where there are none."""
    from symgen.verify.run import verify_expecting
    from symgen.verify.running.sources import generated_sources

    run = {path: text for path, text in sources.items() if backend_of(path) in verified(options)}
    c_sources, python_source = generated_sources(draft.model, run)
    if not c_sources and python_source is None:
        return None
    kernels = {scalar: program.kernels for scalar, program in draft.written.items()}
    certificate = verify_expecting(expected, kernels, c_sources, python_source, progress, options.contract)
    return replace(certificate, left_out=draft.left_out)


def _reporting(model: Model, measured: bool) -> Background[ReportFiles]:
    from symgen.backends import render
    from symgen.runtime.background import Background

    render.load()
    return Background(lambda receive: _report(model, receive, measured))


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
        notices=(*draft.model.notices, *notices(draft, options, certificate)),
        certificate=None if certificate is None else certificate.to_json(),
        failures=() if certificate is None else certificate.failures,
        left_out=draft.left_out,
        programs=draft.written,
    )


def _summary(draft: Draft, certificate: Certificate | None) -> Summary:
    generic, of_u = draft.derivations.generic, draft.derivations.method_of_u
    summary = Summary(
        n=generic.n,
        r=generic.r,
        delta=generic.delta,
        m=generic.m,
        skipped=(
            *((decision.what, decision.why) for decision in draft.structure.decisions),
            *invalid_methods(draft.derivations, () if of_u is None else of_u.failed),
        ),
        operations=tuple((k.name, count_operations(k.statements).total) for k in draft.program.kernels),
    )
    if certificate is None:
        return summary
    from symgen.verify.tolerance import FACTOR

    worst = [certificate.worst(target) for target in certificate.targets]
    errors = tuple(LargestError(w.target, w.quantity, w.largest, FACTOR) for w in worst)
    return replace(summary, errors=errors)
