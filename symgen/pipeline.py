"""The whole way on one page: a model file goes in, every file of its folder comes out, nothing touches the disk.

    load -> derive -> schedule -> emit (C, Python, report) -> verify
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from symgen.derivation_file import derivation_json
from symgen.derive.select import Derivations, derive_quantities
from symgen.derive.structure import Structure, analyse
from symgen.diagnostics import Notice
from symgen.emit.c import emit_c
from symgen.emit.operations import count_operations
from symgen.emit.python import emit_python
from symgen.ir.kernel import Program, Scalar
from symgen.ir.schedule import schedule
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.results import Options, Result, Summary

Progress = Callable[[str], None]


def generate(path: Path, options: Options, progress: Progress) -> Result:
    """All files of one model, verified unless told otherwise.

    Raises ModelError for mistakes in the file; verification failures come back in the result.
    """
    progress("reading the model")
    model = load_model(path)
    progress("deriving")
    derivations = derive_quantities(model, options.outputs or model.outputs)
    structure = analyse(derivations.mechanics, derivations.generic)
    programs: dict[Scalar, Program] = {
        scalar: schedule(derivations.mechanics, derivations.quantities, scalar)
        for scalar in dict.fromkeys((*options.scalars, "float64"))
    }
    files: dict[str, str | bytes] = {}
    if "c" in options.parts:
        for scalar in options.scalars:
            files |= emit_c(model, programs[scalar])
    if "python" in options.parts:
        files |= emit_python(model, programs["float64"])
    files["derivation.json"] = derivation_json(model, derivations, structure, programs["float64"])
    summary = _summary(derivations, structure, programs["float64"])
    return Result(model, files, summary, notices=(*model.notices, *_absences(model, derivations, options)))


def _summary(derivations: Derivations, structure: Structure, program: Program) -> Summary:
    generic = derivations.generic
    return Summary(
        n=generic.n,
        r=generic.r,
        delta=generic.delta,
        m=generic.m,
        skipped=tuple((decision.what, decision.why) for decision in structure.decisions),
        operations=tuple((k.name, count_operations(k.statements).total) for k in program.kernels),
    )


def _absences(model: Model, derivations: Derivations, options: Options) -> tuple[Notice, ...]:
    """What was asked for by name and does not exist for this model."""
    asked = options.outputs or model.outputs
    return tuple(
        Notice(f"{name} is not generated: {reason}") for name, reason in derivations.absent if name in asked
    )
