"""Constraint rows in units of ordinary size: a row times 1e8 is the same row, but products of its minors overflow.

Systems are derived with rows times powers of 2, which change no digit; what depends on the units of rows is given in
those of the file in the end: g and B as they are, B^+ and lambda the other way round.  Where rows depend on each other
the smallest multipliers are meant, in the units of the file.  Of rows that are sums of others everywhere they are made
so in the end, by exact numbers; rows that depend on each other on the constraints alone have one factor
(`model/configurations/branches.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity
from symgen.model.configurations.assembly import Assembly
from symgen.model.expressions.expression import Binary, Number
from symgen.model.model import Model
from symgen.quantities.constant_dependence import Numbers, numbers_of_dependent_rows, projector
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, matmul, transpose
from symgen.symbolic.scalar import Scalar

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
# by quantity that is the smallest where rows depend on each other: the rows of B are its columns, or its rows
SMALLEST_ALONG_COLUMNS = {
    "constraint_pseudoinverse": True,
    "weighted_pseudoinverse": True,
    "multipliers": False,
    "multipliers_jacobian": False,
}


def in_ordinary_units(model: Model) -> Model:
    """The model with rows times powers of 2 where they are in units of their own; the same model where none is."""
    assembly = model.assembly
    if assembly is None or model.row_units or not any(assembly.own_units):
        return model
    units = assembly.own_units if _depend_everywhere(model, assembly) else assembly.units
    if not any(units):
        return model
    rows = tuple(
        replace(row, expression=Binary("*", Number(UNIT_BASE**unit), row.expression)) if unit else row
        for row, unit in zip(model.constraints, units, strict=True)
    )
    return replace(model, constraints=rows, row_units=units)


def _depend_everywhere(model: Model, assembly: Assembly) -> bool:
    """Whether rows that share a factor with others are sums of these everywhere; so are rows none of which shares."""
    if assembly.units == assembly.own_units:
        return True
    rows = System(model).constraint_jacobian
    return len(numbers_of_dependent_rows(rows, [Fraction(1)] * model.r)) == model.r - assembly.ranks.constraints


def in_units_of_the_file(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """A quantity of such a model as it is for the rows of the file."""
    graph, units = mechanics.graph, mechanics.model.row_units
    exponent = BACK.get(derived.name)
    if exponent is None or not any(units):
        return derived
    if derived.name in SMALLEST_ALONG_COLUMNS and (smallest := _smallest(mechanics, generic)):
        numbers = tuple(
            tuple(x * UNIT_BASE**unit for x, unit in zip(row, units, strict=True)) for row in smallest
        )
        outputs = _projected(graph, numbers, derived.outputs, SMALLEST_ALONG_COLUMNS[derived.name])
        return replace(derived, outputs=outputs)
    length = derived.shape[-1]
    factors = [UNIT_BASE ** exponent(units, entry, length) for entry in range(len(derived.outputs))]
    outputs = tuple(graph.const(factor) * x for factor, x in zip(factors, derived.outputs, strict=True))
    return replace(derived, outputs=outputs)


def _smallest(mechanics: System, generic: Genericity) -> tuple[Numbers, ...]:
    """The projector that leaves of multipliers the smallest; none where factors of dependent rows do not differ."""
    units = mechanics.model.row_units
    if generic.rank == generic.r:
        return ()
    basis = numbers_of_dependent_rows(mechanics.constraint_jacobian, [UNIT_BASE**unit for unit in units])
    taking_part = [{unit for unit, x in zip(units, vector, strict=True) if x} for vector in basis]
    if len(basis) != generic.r - generic.rank or all(len(of_vector) == 1 for of_vector in taking_part):
        return ()
    return projector(basis)


def _projected(
    graph: Graph, numbers: tuple[Numbers, ...], outputs: tuple[Scalar, ...], along_columns: bool
) -> tuple[Scalar, ...]:
    """These numbers times a matrix with a row for each row of B; their transpose behind one with a column for each."""
    length = len(numbers) if along_columns else len(outputs) // len(numbers)
    rows: Matrix = tuple(outputs[start : start + length] for start in range(0, len(outputs), length))
    weights: Matrix = tuple(tuple(map(graph.const, row)) for row in numbers)
    behind = transpose(weights, length)
    made = matmul(graph, rows, behind, length) if along_columns else matmul(graph, weights, rows, length)
    return tuple(entry for row in made for entry in row)
