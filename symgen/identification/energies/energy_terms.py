"""What identification estimates of a model of energies: monomials of the parameters that are not its geometry."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from symgen.diagnostics import Span
from symgen.identification.acting import acting
from symgen.identification.arrays import Array
from symgen.model.combinations.geometry import geometric_expressions, names_reached
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.monomials import Monomial, NotInProductsError, monomials
from symgen.model.expressions.units import Unit, parse_unit
from symgen.model.file.source import ScalarNode
from symgen.model.model import Model, Parameter
from symgen.records import dataclass

# Where a unit counts kilograms.
_KILOGRAM = 0


@dataclass(frozen=True, slots=True)
class EnergyTerms:
    """Monomials of `names`, in which energies are linear; `geometry` are other parameters of energies, taken for known.

    The geometry `is_said` by the file, or follows from units.
    """

    model: Model
    names: tuple[str, ...]
    geometry: tuple[str, ...]
    monomials: tuple[Monomial, ...]
    is_said: bool

    @property
    def labels(self) -> tuple[str, ...]:
        """As `m*l**2`."""
        return tuple(map(label, self.monomials))

    def at(self, numbers: Mapping[str, float]) -> Array:
        """Their values (k) for values of parameters."""
        return np.array([math.prod(numbers[name] ** power for name, power in one) for one in self.monomials])


def energy_terms(model: Model) -> EnergyTerms:
    """The monomials of a model of energies; none where all of its parameters are geometry."""
    energies = (model.kinetic_energy, model.potential_energy)
    # parameters in definitions count where these stand in an energy
    used = names_reached(model, energies)
    bound = names_reached(model, [*geometric_expressions(model), *acting(model)])
    free = [p for p in model.parameters if p.name in used and p.name not in bound and isinstance(p.value, Number)]
    said = model.identify
    if said is None or not said.is_said:
        chosen = {p.name for p in free if not _is_kinematic(p)}
    else:
        chosen = {p.name for p in free} - {*said.geometry, *said.fixed}
    terms = _polynomial(energies, chosen, dict(_meanings(model)))
    names = tuple(p.name for p in model.parameters if p.name in chosen)
    geometry = tuple(p.name for p in model.parameters if p.name in used and p.name not in chosen)
    return EnergyTerms(model, names, geometry, tuple(one for one in terms if one), said is not None and said.is_said)


def _polynomial(
    energies: Iterable[Expression], chosen: set[str], meanings: Mapping[str, Expression]
) -> tuple[Monomial, ...]:
    """Monomials of the chosen names; those in which energies are no polynomials are taken out."""
    while True:
        try:
            return monomials(energies, frozenset(chosen), meanings)
        except NotInProductsError as wrong:
            chosen -= wrong.names


def _meanings(model: Model) -> Iterator[tuple[str, Expression]]:
    for definition in model.definitions:
        yield definition.name, definition.value
    for parameter in model.parameters:
        if not isinstance(parameter.value, Number):
            yield parameter.name, parameter.value


def _is_kinematic(parameter: Parameter) -> bool:
    """Whether its unit has no mass: a length, an angle, an acceleration, a ratio that says so."""
    if parameter.unit is None:
        return False
    unit = parse_unit(ScalarNode(parameter.unit, Span(1, 1, 2), parameter.unit, False))
    return isinstance(unit, Unit) and unit.exponents[_KILOGRAM] == 0


def label(monomial: Monomial) -> str:
    """As a product of the model language."""
    return "*".join(name if power == 1 else f"{name}**{power}" for name, power in monomial)
