"""The texts of a draft: sources that are run, and the files beside them, made when nothing replaces them any more."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.backends.backend import backend
from symgen.generation.derivation_file import derivation_json
from symgen.generation.draft import Draft
from symgen.generation.results import Options
from symgen.registered import BACKENDS
from symgen.runtime.activity import each, working

# Parts that hold files of a backend, or speak of them: what verification rejects is in neither.
ABOUT = {"package": "c", "proof": "c"}


def verified(options: Options) -> tuple[str, ...]:
    """The backends whose files are run: those that are asked for, or what stands for them."""
    run = {backend(name).verified_as for name in asked_for(options)}
    return tuple(name for name in BACKENDS if name in run)


def sources_of(draft: Draft, options: Options) -> dict[str, str]:
    """What the backends make: those that are asked for, and those that are run."""
    needed = {*asked_for(options), *verified(options)}
    sources: dict[str, str] = {}
    for name in (name for name in BACKENDS if name in needed):
        made = backend(name)
        programs = made.programs(draft.written, options.scalars)
        if made.around is not None:
            sources |= made.around(draft.model, programs)
        for program in programs:
            kind = f" in {program.scalar}" if made.of_each_scalar else ""
            for variant in each(f"{made.language}{kind}", made.variants):
                sources |= variant.emit(draft.model, program)
    return sources


def files_of(draft: Draft, options: Options, sources: Mapping[str, str]) -> dict[str, str | bytes]:
    """The sources as far as they are asked for, and what is made beside them once nothing replaces them any more."""
    files: dict[str, str | bytes] = {}
    programs = backend("c").programs(draft.written, options.scalars)
    files |= {path: text for path, text in sources.items() if backend_of(path) in options.parts}
    if "package" in options.parts:
        from symgen.package.files import emit_package

        with working("packages"):
            c_files = {path: text for path, text in sources.items() if backend_of(path) == "c"}
            files |= emit_package(draft.model, programs, c_files)
    if "proof" in options.parts:
        from symgen.proof.files import emit_proofs

        with working("drivers for proofs"):
            files |= emit_proofs(draft.model, programs)
    files["derivation.json"] = derivation_json(draft)
    return files


def asked_for(options: Options) -> set[str]:
    """The backends whose files are asked for, or a package or proofs of them."""
    return {ABOUT.get(part, part) for part in options.parts}.intersection(BACKENDS)


def backend_of(path: str) -> str:
    """The backend that made a source of a model."""
    return path.partition("/")[0]
