"""The same mechanism with one constraint more, which follows from the others.

On V the rows depend on each other; off V they are independent by as much as the configuration has drifted.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.laboratory.stress.variants.by_energies import by_energies
from symgen.model.expressions.expression import Binary, Expression, Name, Number
from symgen.model.model import ConstraintRow, Model

ROW = "redundant_row"
ONE = Number(Fraction(1))


def with_redundant_row(model: Model) -> Model | None:
    """The model with the row (1 + sum of q) g_1 + g_2 + ...; None without geometric constraints.

    The gradient of the first factor turns the row by g_1, which vanishes on V.
    """
    model = by_energies(model)
    residuals = [row.expression for row in model.constraints if row.kind == "geometric"]
    if not residuals:
        return None
    factor: Expression = ONE
    for coordinate in model.coordinates:
        factor = Binary("+", factor, Name(coordinate.name))
    total: Expression = Binary("*", factor, residuals[0])
    for residual in residuals[1:]:
        total = Binary("+", total, residual)
    geometric = [row for row in model.constraints if row.kind == "geometric"]
    others = [row for row in model.constraints if row.kind != "geometric"]
    assembly = model.assembly
    if assembly is not None and assembly.units:
        units = (*assembly.units[: len(geometric)], assembly.units[0], *assembly.units[len(geometric) :])
        assembly = replace(assembly, units=units)
    return replace(
        model,
        assembly=assembly,
        name=f"{model.name}_with_a_redundant_row",
        constraints=(*geometric, ConstraintRow(ROW, "geometric", total), *others),
        published=(),
        paths=(),
    )
