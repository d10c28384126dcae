"""Parameters that are taken as their numbers: the model with these in place of the names."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any

from symgen.diagnostics import Span
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.expression import Expression, Name, Number
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.model import Model, Parameter

# what a model is made of that may name a parameter
PARTS = (
    "parameters", "definitions", "kinetic_energy", "potential_energy", "constraints", "task", "inputs",
    "applied_forces", "forces", "rough", "published", "paths", "mechanism",
)  # fmt: skip


def with_numbers(model: Model, names: Collection[str], defaults: Mapping[str, float]) -> Model:
    """The model without these parameters; their default values, exact where they are rational, stand in every place."""
    numbers = {name: Number(value) for name, value in _values(model.parameters, defaults).items() if name in names}
    given = {part: _placed(getattr(model, part), numbers) for part in PARTS}
    given["parameters"] = tuple(p for p in given["parameters"] if p.name not in names)
    taken = tuple((p.name, numbers[p.name].value) for p in model.parameters if p.name in numbers)
    return replace(model, **given, taken=(*model.taken, *taken))


def with_numbers_by_default(model: Model) -> Model:
    """The model whose parameters follow from none of the others: kernels are given each of them by itself."""
    parameters = model.parameters
    values = _values(parameters, default_values(parameters))
    # what is no fraction stays what it is: an angle of pi/2 is a right one
    own = (Number(values[p.name]) if any(names_in(p.value)) else p.value for p in parameters)
    return replace(model, parameters=tuple(replace(p, value=x) for p, x in zip(parameters, own, strict=True)))


def _values(parameters: Sequence[Parameter], defaults: Mapping[str, float]) -> dict[str, Fraction]:
    """The default values of all parameters."""
    values: dict[str, Fraction] = {}
    for parameter in parameters:
        known = {name.name: Number(values[name.name]) for name in names_in(parameter.value)}
        value: Expression = _placed(parameter.value, known)
        exact = exact_value(value)
        values[parameter.name] = Fraction(defaults[parameter.name]) if exact is None else exact
    return values


def _placed(part: Any, numbers: Mapping[str, Number]) -> Any:
    match part:
        case Name(name=name):
            return numbers.get(name, part)
        case tuple():
            return tuple(_placed(one, numbers) for one in part)
    if is_dataclass(part) and not isinstance(part, (type, Span, Number)):
        given = {field.name: getattr(part, field.name) for field in fields(part)}
        return replace(part, **{key: _placed(one, numbers) for key, one in given.items()})
    return part
