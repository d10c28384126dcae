"""A header and a source of C99 for one scalar type, with the kernels for one state or a variant of them."""

from __future__ import annotations

from symgen.backends.c.bodies.functions import CFunctionView
from symgen.backends.c.bodies.pairs import PairsView, pairs_view
from symgen.backends.c.bodies.steps import StepsView, steps_view
from symgen.backends.c.identity import EntryPlaces, IdentityView
from symgen.backends.c.names import guard
from symgen.backends.c.surroundings import LibraryPair, apart_macro, library_pair, rare_macro, uses_library
from symgen.backends.render import render
from symgen.backends.scalars import C_TYPE, SUFFIX, file_stem
from symgen.ir.kernel import Program
from symgen.model.model import Model
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class StructView:
    """A struct of numbers: its name, its members as they are declared, and what is said of it."""

    name: str
    members: tuple[str, ...]
    comment: str = ""


@dataclass(frozen=True, slots=True)
class StatusView:
    """The type of statuses: what guards its definition, its name, and enumerators with values and meanings.

    `identity` is what else the files of a model have in common.
    """

    guard: str
    name: str
    values: tuple[tuple[str, int, str], ...]
    identity: IdentityView


@dataclass(frozen=True, slots=True)
class FileView:
    """Everything the templates of a header and its source print."""

    stem: str
    guard: str
    scalar: str
    about: tuple[str, ...]
    includes: tuple[str, ...]
    functions: tuple[CFunctionView, ...]
    struct: StructView | None
    statuses: StatusView | None
    columns: EntryPlaces | None
    includes_math: bool
    pairs: PairsView | None
    both: LibraryPair | None
    steps: StepsView | None
    rare: str
    apart: str


def file_view(
    model: Model,
    program: Program,
    ending: str,
    about: tuple[str, ...],
    functions: tuple[CFunctionView, ...],
    struct: StructView | None = None,
    statuses: StatusView | None = None,
    columns: EntryPlaces | None = None,
) -> FileView:
    """The files of a variant, whose header includes that of the kernels for one state; of these without `ending`.

    `program` holds the kernels that the functions are made of.
    """
    prefix, suffix = model.c_name, SUFFIX[program.scalar]
    stem = file_stem(prefix, program.scalar, ending)
    return FileView(
        stem=stem,
        guard=guard(stem),
        scalar=C_TYPE[program.scalar],
        about=about,
        includes=(f'"{file_stem(prefix, program.scalar)}.h"',) if ending else (),
        functions=functions,
        struct=struct,
        statuses=statuses,
        columns=columns,
        includes_math=uses_library(program),
        pairs=pairs_view(prefix, suffix, program),
        both=library_pair(prefix, program),
        steps=steps_view(prefix, suffix, program),
        rare=rare_macro(prefix, program),
        apart=apart_macro(prefix, program),
    )


def files(header: FileView, source: object = None, template: str = "c/source.c.jinja") -> dict[str, str]:
    """Both, by path; a `source` of another kind has a view and a template of its own."""
    return {
        f"c/{header.stem}.h": render("c/header.h.jinja", header),
        f"c/{header.stem}.c": render(template, source or header),
    }
