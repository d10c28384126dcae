"""What a header says of its model beside functions: how many entries arguments have, which is which, and which model.

Both scalar types of a model have it, so it is guarded like the type of statuses.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from symgen import __version__
from symgen.backends.about import symbol_text
from symgen.backends.comments import c_comment
from symgen.ir.kernel import Program
from symgen.model.inertial_parameters import InertialParameter, inertial_parameters
from symgen.model.model import Model
from symgen.model.quantities import REGRESSOR
from symgen.naming import macro_name
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class EntryPlaces:
    """The entries of some arguments or of a result: enumerators with values and what is said of each."""

    arguments: str
    size: str
    entries: tuple[tuple[str, int, str], ...]


@dataclass(frozen=True, slots=True)
class IdentityView:
    """The version of symgen and the model's text by their macros, and the places of coordinates, inputs and others."""

    version_macro: str
    version: str
    hash_macro: str
    model_hash: str
    places: tuple[EntryPlaces, ...]
    text_function: str


def column_view(model: Model, program: Program) -> EntryPlaces | None:
    """The columns of the regressor, where a program has it."""
    if all(kernel.name != REGRESSOR for kernel in program.kernels):
        return None
    prefix = macro_name(model.c_name)
    named = [*map(_named, inertial_parameters(model.mechanism))]
    return _entry_places(prefix, "PI", "inertial parameters (columns of Y)", named)


def _named(parameter: InertialParameter) -> tuple[str, str]:
    return f"{parameter.owner}_{parameter.element}", parameter.name


def _base(model: Model) -> list[tuple[str, str]]:
    """The parameters that stand for all, where quantities of the base are asked for."""
    every = inertial_parameters(model.mechanism)
    return [_named(every[k]) for k in (() if model.inertial_base is None else model.inertial_base.columns)]


def identity_view(model: Model) -> IdentityView:
    """Of a model."""
    prefix = macro_name(model.c_name)
    return IdentityView(
        version_macro=f"{prefix}_SYMGEN_VERSION",
        version=__version__,
        hash_macro=f"{prefix}_MODEL_HASH",
        model_hash=model.text_hash,
        places=tuple(_places(model, prefix)),
        text_function=status_text_name(model),
    )


def status_text_name(model: Model) -> str:
    """The function that says what a status means."""
    return f"{model.c_name}_status_text"


def identity_names(model: Model, program: Program) -> set[str]:
    """The global names of all that."""
    view, columns = identity_view(model), column_view(model, program)
    names = {view.version_macro, view.hash_macro, view.text_function}
    for one in (*view.places, *(() if columns is None else (columns,))):
        names |= {one.size, *(name for name, _, _ in one.entries)}
    return names


def _places(model: Model, prefix: str) -> Iterator[EntryPlaces]:
    coordinates = [(c.name, symbol_text(c.unit, c.description or c.name)) for c in model.coordinates]
    rows = [row.name for kind in ("geometric", "nonholonomic") for row in model.constraints if row.kind == kind]
    by_name = dict(coordinates)
    arguments: tuple[tuple[str, str, Iterable[tuple[str, str]]], ...] = (
        ("Q", "q, qd and qdd", coordinates),
        ("U", "inputs", ((i.name, symbol_text(i.unit, i.description or i.name)) for i in model.inputs)),
        ("LAMBDA", "multipliers", ((name, f"of the row {name}") for name in rows)),
        ("QM", "q_m, qd_m and qdd_m", ((name, by_name[name]) for name in model.measured)),
        ("XT", "x_t, xd_t and xdd_t", ((x.name, x.name) for x in model.task)),
        ("BETA", "base parameters (columns of Y_base)", _base(model)),
    )
    for letter, what, entries in arguments:
        if named := list(entries):
            yield _entry_places(prefix, letter, what, named)


def _entry_places(prefix: str, letter: str, what: str, named: Sequence[tuple[str, str]]) -> EntryPlaces:
    ends = _endings([name for name, _ in named])
    members = ((f"{prefix}_{letter}_{end}", text) for end, (_, text) in zip(ends, named, strict=True))
    places = tuple((name, place, c_comment(text)) for place, (name, text) in enumerate(members))
    return EntryPlaces(what, f"{prefix}_SIZE_{letter}", places)


def _endings(names: Sequence[str]) -> list[str]:
    """Names in capitals; as they stand where two are the same in capitals."""
    counts = Counter(name.upper() for name in names)
    return [name.upper() if counts[name.upper()] == 1 else name for name in names]
