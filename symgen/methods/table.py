"""The methods of all quantities that have several: the one place where a method gets its name.

Rows are read without loading any method: the command line knows their names.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING

from symgen.model.quantities import GIVEN_MOTIONS, GIVEN_PLACES, MAIN, MOTIONS
from symgen.records import dataclass

if TYPE_CHECKING:
    from symgen.methods.method import Method


class Use(IntEnum):
    """When a method is taken though nobody asks for it by name."""

    CHOSEN = 0
    """Where it is valid and counts least."""
    SPARE = 1
    """Where verification rejects what was chosen."""
    LAST = 2
    """Where verification rejects all others."""
    ASKED = 3
    """By its name alone: without one it comes along the null space of several quantities."""
    COMPARISON = 4
    """By its name alone, to be compared with what is chosen."""


# What readers of names are told of a use.
_LABELS = {Use.LAST: "for comparison and as last resort", Use.COMPARISON: "for comparison"}


@dataclass(frozen=True, slots=True)
class MethodRow:
    """A method by the name that `--method` and derivation.json give it."""

    name: str
    quantities: tuple[str, ...]
    load: Callable[[], Method]
    use: Use = Use.CHOSEN


def _load(place: str, name: str) -> Method:
    method: Method = getattr(import_module(f"symgen.methods.{place}"), name)
    return method


def _method(
    name: str, quantities: tuple[str, ...], place: str, implementation: str, use: Use = Use.CHOSEN
) -> MethodRow:
    return MethodRow(name, quantities, partial(_load, place, implementation), use)


_U, _PROJECTOR = ("inverse_dynamics",), ("nullspace_projector",)
_GRADIENTS = ("inverse_dynamics_gradient", "forward_dynamics_gradient", "inverse_dynamics_hessian_product")
_JACOBIANS = (
    "inverse_dynamics_jacobian", "inverse_dynamics_parameter_jacobian", "forward_dynamics_jacobian",
    "multipliers_jacobian",
)  # fmt: skip
_OF_MOTIONS = ("forward_dynamics_jacobian", "forward_dynamics_gradient", "multipliers_jacobian")
_OF_U = tuple(name for name in (*_JACOBIANS, *_GRADIENTS) if name not in _OF_MOTIONS)
_REGRESSORS = ("regressor", "base_regressor")
_WEIGHTED = ("weighted_pseudoinverse", "weighted_nullspace_projector")

# Of methods that count alike the first is taken.
METHODS: tuple[MethodRow, ...] = (
    _method("elimination", _U, "inverse_dynamics.forces_eliminated", "ELIMINATION"),
    _method("minor", _U, "inverse_dynamics.along_spaces", "MINOR"),
    _method("nullspace", _U, "inverse_dynamics.nullspace", "NULLSPACE"),
    _method("householder", _U, "inverse_dynamics.along_spaces", "HOUSEHOLDER"),
    _method("printed", _U, "comparisons.printed", "PRINTED", Use.COMPARISON),
    _method("printed_fixed", _U, "comparisons.printed", "PRINTED_FIXED", Use.COMPARISON),
    _method("weighted", _U, "comparisons.weighted", "WEIGHTED", Use.COMPARISON),
    _method("kkt", _U, "comparisons.weighted", "KKT", Use.COMPARISON),
    _method("minor", MOTIONS, "forward_dynamics.along_spaces", "MINOR"),
    _method("schur_qr", MOTIONS, "forward_dynamics.along_spaces", "SCHUR_QR"),
    _method("nullspace", MOTIONS, "forward_dynamics.along_spaces", "NULLSPACE"),
    _method("shifted", MOTIONS, "forward_dynamics.shifted", "SHIFTED", Use.LAST),
    _method("kkt", MOTIONS, "comparisons.motions", "KKT", Use.LAST),
    _method("partitioned", MOTIONS, "forward_dynamics.partitioned", "PARTITIONED"),
    _method("articulated", MOTIONS, "forward_dynamics.articulated", "ARTICULATED"),
    _method("schur_qr_refined", MOTIONS, "forward_dynamics.along_spaces", "SCHUR_QR_REFINED", Use.SPARE),
    _method("articulated_refined", MOTIONS, "forward_dynamics.articulated", "BY_COLUMNS", Use.SPARE),
    _method("articulated_by_bodies", MOTIONS, "forward_dynamics.articulated", "BY_BODIES", Use.SPARE),
    _method("minor", _PROJECTOR, "projector", "MINOR", Use.ASKED),
    _method("householder", _PROJECTOR, "projector", "HOUSEHOLDER", Use.ASKED),
    _method("closed", GIVEN_PLACES, "given.closed", "CLOSED"),
    _method("legs", GIVEN_MOTIONS, "given.legs", "BY_LEGS"),
    _method("elimination", _REGRESSORS, "columns_eliminated", "COLUMNS_ELIMINATED"),
    _method("implicit", _OF_U, "derivatives.of_inputs", "IMPLICIT"),
    _method("implicit", _OF_MOTIONS, "derivatives.of_motions", "IMPLICIT"),
    _method("differentiated", _JACOBIANS, "derivatives.differentiated", "DIFFERENTIATED", Use.SPARE),
    _method("weighted_jacobian", _GRADIENTS, "derivatives.differentiated", "DIFFERENTIATED", Use.SPARE),
    _method("schur_qr", _WEIGHTED, "forward_dynamics.weighted_projection", "SCHUR_QR", Use.SPARE),
    _method("articulated", _WEIGHTED, "forward_dynamics.weighted_projection", "ARTICULATED", Use.SPARE),
)
# `--method` takes the methods of these by name.
NAMED = (*MAIN, *_PROJECTOR)


def methods(quantity: str, most: Use = Use.COMPARISON) -> tuple[MethodRow, ...]:
    """The methods of a quantity up to a use, in the order of the table."""
    return tuple(row for row in METHODS if quantity in row.quantities and row.use <= most)


def method(quantity: str, name: str) -> Method:
    """The method of a quantity by its name."""
    return next(row for row in METHODS if quantity in row.quantities and row.name == name).load()


def label(quantity: str, name: str) -> str:
    """What a reader of the name has to know of its use; empty where that is nothing, or there is no such row."""
    uses = (row.use for row in METHODS if quantity in row.quantities and row.name == name)
    return next((_LABELS.get(use, "") for use in uses), "")
