"""The same mechanism with angles in degrees: every angle x is written pi/180 x' in the model's expressions."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.laboratory.stress.variants.by_energies import by_energies, substitute, with_names
from symgen.model.expressions.expression import Binary, Expression, Name, Number, Pi
from symgen.model.model import Model

RADIANS = Binary("/", Pi(), Number(Fraction(180)))
# 180/pi to 70 digits, for states
DEGREES = Fraction("57.2957795130823208767981548141051703324054724665643215491602438612028471")


def in_degrees(model: Model) -> Model:
    """The model in degrees; generalized forces become power per degree/s, inputs and multipliers stay."""
    model = by_energies(model)
    angles = [c for c in model.coordinates if c.is_angle]
    names: dict[str, Expression] = {}
    for c in angles:
        names |= {name: Binary("*", RADIANS, Name(name)) for name in (c.name, c.rate)}
    is_angle = {c.name for c in angles}

    def force(coordinate: str, value: Expression) -> Expression:
        converted = substitute(value, names)
        return Binary("*", RADIANS, converted) if coordinate in is_angle else converted

    written = with_names(model, names)
    return replace(
        written,
        name=f"{model.name}_in_degrees",
        coordinates=tuple(
            replace(
                c,
                unit=None,
                range=(c.range[0] * DEGREES, c.range[1] * DEGREES),
                rate_range=(c.rate_range[0] * DEGREES, c.rate_range[1] * DEGREES),
                acceleration_range=(c.acceleration_range[0] * DEGREES, c.acceleration_range[1] * DEGREES),
            )
            if c.is_angle
            else c
            for c in model.coordinates
        ),
        inputs=tuple(
            replace(i, acts_on=tuple((name, force(name, value)) for name, value in i.acts_on)) for i in model.inputs
        ),
        applied_forces=tuple(replace(f, expression=force(f.coordinate, f.expression)) for f in model.applied_forces),
        configuration=tuple((name, x * DEGREES if name in is_angle else x) for name, x in model.configuration),
        published=(),
        paths=(),
    )
