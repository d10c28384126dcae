"""Constraint rows in units of ordinary size: a row times 1e8 is the same row, but products of its minors overflow.

Systems are derived with rows times powers of 2, which change no digit; what depends on the units of rows is given in
those of the file in the end: g and B as they are, B^+ and lambda the other way round.  Where rows depend on each other
the smallest multipliers are meant, in the units of the file, so that these rows have one factor
(`model/configurations/branches.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from symgen.methods.quantity import Quantity
from symgen.model.expressions.expression import Binary, Number
from symgen.model.model import Model
from symgen.symbolic.scalar import Graph

# Units are powers of this, so that nothing is rounded.
UNIT_BASE = Fraction(2)

Exponent: TypeAlias = Callable[[tuple[int, ...], int, int], int]
"""Of the factor of an entry, from the exponents of the rows, the number of the entry, and the length of a row."""

# by quantity: the entry belongs to a row of B, or to a column of B^+
BACK: dict[str, Exponent] = {
    "constraint_residual": lambda units, entry, _: -units[entry],
    "constraint_jacobian": lambda units, entry, length: -units[entry // length],
    "constraint_jacobian_dot": lambda units, entry, length: -units[entry // length],
    "constraint_pseudoinverse": lambda units, entry, length: units[entry % length],
    "weighted_pseudoinverse": lambda units, entry, length: units[entry % length],
    "multipliers": lambda units, entry, _: units[entry],
    "multipliers_jacobian": lambda units, entry, length: units[entry // length],
}


def in_ordinary_units(model: Model) -> Model:
    """The model with rows times powers of 2 where they are in units of their own; the same model where none is."""
    assembly = model.assembly
    if assembly is None or model.row_units or not any(assembly.units):
        return model
    units = assembly.units
    rows = tuple(
        replace(row, expression=Binary("*", Number(UNIT_BASE**unit), row.expression)) if unit else row
        for row, unit in zip(model.constraints, units, strict=True)
    )
    return replace(model, constraints=rows, row_units=units)


def in_units_of_the_file(graph: Graph, model: Model, derived: Quantity) -> Quantity:
    """A quantity of such a model as it is for the rows of the file."""
    exponent = BACK.get(derived.name)
    if exponent is None or not any(model.row_units):
        return derived
    length = derived.shape[-1]
    factors = [UNIT_BASE ** exponent(model.row_units, entry, length) for entry in range(len(derived.outputs))]
    outputs = tuple(graph.const(factor) * x for factor, x in zip(factors, derived.outputs, strict=True))
    return replace(derived, outputs=outputs)
