"""What stands around the modules: the manifest, and the root of the crate with the statuses."""

from __future__ import annotations

import json
from collections.abc import Sequence

from symgen import __version__
from symgen.backends.about import status_meaning, statuses_of, symbol_lines
from symgen.backends.comments import one_line
from symgen.backends.render import render
from symgen.backends.rust.comments import as_they_stand, prose
from symgen.backends.rust.module import LIBRARY, RUST_TYPE, operations_of
from symgen.backends.rust.reserved import crate_name
from symgen.backends.rust.statements import status_name
from symgen.ir.kernel import Program, Status
from symgen.model.model import Model
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class CrateView:
    """Everything both templates print.

    `standard` says that kernels call functions that only the standard library has, `roots` that they take square roots.
    """

    name: str
    version: str
    model_hash: str
    quoted_description: str
    about: tuple[str, ...]
    standard: bool
    roots: bool
    modules: tuple[tuple[str, str], ...]
    statuses: tuple[tuple[str, int, tuple[str, ...], str], ...]


def emit_crate(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """`rust/Cargo.toml` and `rust/src/lib.rs`, for the modules of all scalar types; nothing without kernels."""
    if not any(program.kernels for program in programs):
        return {}
    operations = frozenset().union(*map(operations_of, programs))
    description = model.description or "constrained mechanical system"
    title = prose(f"{model.name}: {description}")
    source = ("", *prose(f"Source: {model.source}")) if model.source else ()
    refusals = [status for status in statuses_of(model) if status is not Status.OK]
    view = CrateView(
        name=crate_name(model.c_name),
        version=__version__,
        model_hash=model.text_hash,
        quoted_description=json.dumps(one_line(description), ensure_ascii=False),
        about=(*title, *source, "", *as_they_stand(symbol_lines(model))),
        standard=bool(operations.intersection(LIBRARY)),
        roots="sqrt" in operations,
        modules=tuple((program.scalar, RUST_TYPE[program.scalar]) for program in programs),
        statuses=tuple(
            (status_name(one), int(one), prose(status_meaning(one, model)), json.dumps(status_meaning(one, model)))
            for one in refusals
        ),
    )
    files = {"Cargo.toml": "rust/cargo.toml.jinja", "src/lib.rs": "rust/lib.rs.jinja"}
    return {f"rust/{name}": render(template, view) for name, template in files.items()}
