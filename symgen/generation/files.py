"""The texts of a draft: sources that are run, and the files beside them, made when nothing replaces them any more."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.generation.derivation_file import derivation_json
from symgen.generation.draft import Draft
from symgen.generation.results import Options
from symgen.ir.kernel import Program
from symgen.runtime.activity import each, working


def sources_of(draft: Draft, options: Options) -> dict[str, str]:
    """What is run: C, for a package alone, too, and Python."""
    sources: dict[str, str] = {}
    if {"c", "package"} & {*options.parts}:
        for program in _programs(draft, options):
            for emit in each(f"C in {program.scalar}", (emit_c, emit_c_batch, emit_c_prepared, emit_c_sc)):
                sources |= emit(draft.model, program)
    if "python" in options.parts:
        from symgen.backends.python.module import emit_python

        with working("Python"):
            sources |= emit_python(draft.model, draft.program)
    return sources


def _programs(draft: Draft, options: Options) -> list[Program]:
    """Those of the scalar types that C is made of."""
    return [program for scalar in options.scalars if (program := draft.programs[scalar]).kernels]


def files_of(draft: Draft, options: Options, sources: Mapping[str, str]) -> dict[str, str | bytes]:
    """The sources as far as they are asked for, and what is made beside them once nothing replaces them any more."""
    files: dict[str, str | bytes] = {}
    programs, c_files = _programs(draft, options), {path: text for path, text in sources.items() if is_c(path)}
    if "c" in options.parts:
        files |= c_files
    if "package" in options.parts:
        from symgen.package.files import emit_package

        with working("packages"):
            files |= emit_package(draft.model, programs, c_files)
    if "proof" in options.parts:
        from symgen.proof.files import emit_proofs

        with working("drivers for proofs"):
            files |= emit_proofs(draft.model, programs)
    files |= {path: text for path, text in sources.items() if not is_c(path)}
    files["derivation.json"] = derivation_json(draft.model, draft.derivations, draft.structure, draft.program)
    return files


def is_c(path: str) -> bool:
    """Whether a file of a model is C that is run."""
    return path.startswith("c/")
