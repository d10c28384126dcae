"""The methods of all quantities that have several: the one place where a method gets its name.

Rows are read without loading any method: the command line knows their names.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING

from symgen.records import dataclass

if TYPE_CHECKING:
    from symgen.methods.method import Method


class Use(IntEnum):
    """When a method is taken though nobody asks for it by name."""

    CHOSEN = 0
    """Where it is valid and counts least."""
    SPARE = 1
    """Where verification rejects what was chosen."""
    COMPARISON = 2
    """Where verification rejects all others: it squares the condition of B, or is long."""


@dataclass(frozen=True, slots=True)
class Row:
    """A method by the name that `--form` and derivation.json give it."""

    name: str
    quantities: tuple[str, ...]
    load: Callable[[], Method]
    use: Use = Use.CHOSEN


def _load(place: str, name: str) -> Method:
    method: Method = getattr(import_module(f"symgen.methods.{place}"), name)
    return method


def _method(name: str, quantities: tuple[str, ...], place: str, implementation: str, use: Use = Use.CHOSEN) -> Row:
    return Row(name, quantities, partial(_load, place, implementation), use)


_U = ("inverse_dynamics",)

# Of methods that count alike the first is taken.
METHODS: tuple[Row, ...] = (
    _method("elimination", _U, "inverse_dynamics.forces_eliminated", "ELIMINATION"),
    _method("minor", _U, "inverse_dynamics.along_spaces", "MINOR"),
    _method("nullspace", _U, "inverse_dynamics.nullspace", "NULLSPACE"),
    _method("householder", _U, "inverse_dynamics.along_spaces", "HOUSEHOLDER"),
    _method("printed", _U, "inverse_dynamics.printed", "PRINTED", Use.COMPARISON),
    _method("weighted", _U, "inverse_dynamics.weighted", "WEIGHTED", Use.COMPARISON),
    _method("kkt", _U, "inverse_dynamics.weighted", "KKT", Use.COMPARISON),
)


def methods(quantity: str, most: Use = Use.COMPARISON) -> tuple[Row, ...]:
    """The methods of a quantity up to a use, in the order of the table."""
    return tuple(row for row in METHODS if quantity in row.quantities and row.use <= most)


def method(quantity: str, name: str) -> Method:
    """The method of a quantity by its name."""
    return next(row for row in METHODS if quantity in row.quantities and row.name == name).load()
