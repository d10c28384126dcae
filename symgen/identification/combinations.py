"""What inputs are linear in beside friction and springs: base parameters of bodies, or products of energies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Protocol

import numpy as np

from symgen.identification.acting import acting
from symgen.identification.arrays import Array
from symgen.identification.text import combination
from symgen.model.combinations.base_parameters import BaseParameters
from symgen.model.combinations.geometry import geometric_expressions, names_reached
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.walk import evaluate
from symgen.model.inertial_parameters import expressions, values
from symgen.model.model import Model
from symgen.records import dataclass


class Combinations(Protocol):
    """Numbers (b) that inputs are linear in, for a geometry that is known."""

    @property
    def labels(self) -> tuple[str, ...]:
        """What they are called."""

    @property
    def reached(self) -> set[str]:
        """Parameters of the file that they are made of."""

    @property
    def held(self) -> set[str]:
        """Parameters of the file that are taken for known."""

    def at(self, numbers: Mapping[str, float]) -> Array:
        """Their values (b) for values of all parameters of the file."""


@dataclass(frozen=True, slots=True)
class BodyCombinations:
    """Base parameters of bodies, by the matrix `base_map`; those with numbers in `known` are taken as in the file."""

    base: BaseParameters
    known: tuple[int, ...] = ()

    @property
    def kept(self) -> list[int]:
        """The numbers of those that are not known."""
        return [k for k in range(len(self.base.base)) if k not in self.known]

    @property
    def matrix(self) -> Array:
        """Those that are not known (b) from inertial parameters (p)."""
        return base_map(self.base)[self.kept]

    @property
    def labels(self) -> tuple[str, ...]:
        """Sums of inertial parameters."""
        return tuple(combination(self.base.base[k]) for k in self.kept)

    @property
    def reached(self) -> set[str]:
        """What bodies and rotors are made of."""
        return names_reached(self.base.model, _of_bodies(self.base.model))

    @property
    def held(self) -> set[str]:
        """What the file says is fixed."""
        said = self.base.model.identify
        return set() if said is None else {*said.fixed}

    def at(self, numbers: Mapping[str, float]) -> Array:
        """Base parameters (b)."""
        return np.asarray(self.matrix @ inertial_values(self.base.model, numbers), dtype=np.float64)

    def as_numbers_say(self) -> BodyCombinations:
        """The same, where sums of what the file gives as numbers other than 0, or holds, are known."""
        model = self.base.model
        bound = names_reached(model, [*geometric_expressions(model), *acting(model)]) | self.held
        free = {p.name for p in model.parameters if isinstance(p.value, Number) and p.name not in bound}
        given = np.array([not free & names_reached(model, [one]) for one in expressions(model.mechanism)])
        parts = base_map(self.base) != 0
        values = inertial_values(model, default_values(model.parameters))
        known = np.all(given | ~parts, axis=1) & np.any(parts & (values != 0), axis=1)
        return replace(self, known=tuple(map(int, np.flatnonzero(known))))


def inertial_values(model: Model, numbers: Mapping[str, float]) -> Array:
    """The inertial parameters (p) for values of the parameters of the file."""
    known = dict(numbers)
    for definition in model.definitions:
        try:
            known[definition.name] = evaluate(definition.value, known)
        except KeyError:  # made of coordinates, which inertias are not
            continue
    return np.array(values(model.mechanism, lambda expression: evaluate(expression, known)))


def default_like(model: Model, known: Mapping[str, float], changed: Mapping[str, float]) -> dict[str, float]:
    """All values, where some are changed; others that are expressions of these follow."""
    numbers: dict[str, float] = {}
    for p in model.parameters:
        if p.name in changed:
            numbers[p.name] = changed[p.name]
        else:
            numbers[p.name] = known[p.name] if isinstance(p.value, Number) else evaluate(p.value, numbers)
    return numbers


def base_map(base: BaseParameters) -> Array:
    """Base parameters (b) from inertial parameters (p): a matrix (b, p) of numbers at this geometry."""
    made = np.zeros((len(base.base), len(base.parameters)))
    places = {one.name: k for k, one in enumerate(base.parameters)}
    for row, one in zip(made, base.base, strict=True):
        row[places[one.stays.name]] = 1.0
        for other, form in one.added:
            row[places[other.name]] = form.value
    return made


def _of_bodies(model: Model) -> Iterator[Expression]:
    for body in model.mechanism.bodies:
        yield body.mass
        yield from body.com
        yield from (entry for row in body.inertia.rows for entry in row)
    yield from (rotor.inertia for rotor in model.mechanism.rotor_inertias)
