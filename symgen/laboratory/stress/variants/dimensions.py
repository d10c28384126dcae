"""Declared units as exponents of mass, length and time."""

from __future__ import annotations

from fractions import Fraction
from typing import TypeAlias

from symgen.diagnostics import Mistake
from symgen.model.expressions.units import parse_unit
from symgen.model.file.source import START, ScalarNode
from symgen.model.model import Model

Dimension: TypeAlias = tuple[Fraction, Fraction, Fraction]
NUMBER: Dimension = (Fraction(0), Fraction(0), Fraction(0))


def dimension(unit: str | None) -> Dimension | None:
    """Exponents of kg, m and s of a declared unit; None where none is declared."""
    if unit is None:
        return None
    parsed = parse_unit(ScalarNode(unit, START, unit, False))
    if isinstance(parsed, Mistake):
        return None
    mass, length, time = parsed.exponents[:3]
    return (mass, length, time)


def parameter_dimensions(model: Model) -> tuple[Dimension | None, ...]:
    """Dimensions of the parameters, in their order."""
    return tuple(dimension(parameter.unit) for parameter in model.parameters)


def coordinate_dimensions(model: Model) -> tuple[Dimension, ...]:
    """Dimensions of the coordinates; those without a unit are numbers."""
    return tuple(dimension(coordinate.unit) or NUMBER for coordinate in model.coordinates)
