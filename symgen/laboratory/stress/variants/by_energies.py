"""A model by energies whose definitions have plain names, so that they are no components of frames and points."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.model import Model


def by_energies(model: Model) -> Model:
    """The model by energies, without friction of reactions, which energies do not know; itself where it has neither."""
    smooth = replace(model, rough=(), released=(), friction_steps=None, motion_steps=None) if model.rough else model
    given = energy_form(smooth)
    if given is model:
        return model
    taken = {c.name for c in given.coordinates} | {p.name for p in given.parameters} | {i.name for i in given.inputs}
    plain: dict[str, str] = {}
    for definition in given.definitions:
        name = re.sub(r"\W", "_", definition.name)
        while name in taken:
            name += "_"
        taken.add(name)
        plain[definition.name] = name
    renamed = tuple(replace(d, name=plain[d.name]) for d in given.definitions)
    return with_names(replace(given, definitions=renamed), {old: Name(new) for old, new in plain.items()})


def with_names(model: Model, names: Mapping[str, Expression]) -> Model:
    """The model with names replaced in every expression."""

    def at(expression: Expression) -> Expression:
        return substitute(expression, names)

    return replace(
        model,
        definitions=tuple(replace(d, value=at(d.value)) for d in model.definitions),
        kinetic_energy=at(model.kinetic_energy),
        potential_energy=at(model.potential_energy),
        constraints=tuple(replace(c, expression=at(c.expression)) for c in model.constraints),
        task=tuple(replace(x, expression=at(x.expression)) for x in model.task),
        inputs=tuple(replace(i, acts_on=tuple((name, at(value)) for name, value in i.acts_on)) for i in model.inputs),
        applied_forces=tuple(replace(f, expression=at(f.expression)) for f in model.applied_forces),
    )


def substitute(expression: Expression, names: Mapping[str, Expression]) -> Expression:
    """The expression with names replaced."""
    match expression:
        case Name(name=name):
            return names.get(name, expression)
        case Number() | Pi():
            return expression
        case Negation(operand=operand):
            return Negation(substitute(operand, names))
        case Binary(operator=operator, left=left, right=right):
            return Binary(operator, substitute(left, names), substitute(right, names))
        case Power(base=base, exponent=exponent):
            return Power(substitute(base, names), exponent)
        case Call(function=function, arguments=arguments):
            return Call(function, tuple(substitute(a, names) for a in arguments))
