"""A mechanism given by its inertial parameters: energies are linear in the parameters that it gets for them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.combine import times
from symgen.model.expressions.expression import Expression, Name, Number
from symgen.model.inertial_parameters import ELEMENTS, inertial_parameters
from symgen.model.mechanism import NO_VECTOR, ZERO, Body, Inertia
from symgen.model.model import Model, Parameter

HALF, MINUS_HALF = Number(Fraction(1, 2)), Number(Fraction(-1, 2))
ONE, MINUS_ONE = Number(Fraction(1)), Number(Fraction(-1))


def by_inertial_parameters(model: Model) -> Model:
    """The mechanism of a model alone, with a parameter for each of `inertial_parameters` behind those of the model."""
    # no name of a model has a blank
    names = [f"pi {k}" for k, _ in enumerate(inertial_parameters(model.mechanism))]
    mechanism, count = model.mechanism, len(ELEMENTS)
    bodies = tuple(
        part
        for k, body in enumerate(mechanism.bodies)
        for part in _parts(body, [*map(Name, names[count * k : count * (k + 1)])])
    )
    left = names[count * len(mechanism.bodies) :]
    rotors = tuple(
        replace(rotor, inertia=Name(name)) for rotor, name in zip(mechanism.rotor_inertias, left, strict=True)
    )
    return replace(
        model,
        parameters=(*model.parameters, *(Parameter(name, None, "", ZERO, None) for name in names)),
        kinetic_energy=ZERO,
        potential_energy=ZERO,
        applied_forces=(),
        forces=(),
        mechanism=replace(mechanism, bodies=bodies, rotor_inertias=rotors),
    )


def _parts(body: Body, given: Sequence[Expression]) -> Iterator[Body]:
    """A mass at the origin with the inertia about it; a couple of masses, one negative, for each first moment."""
    mass, *moments = given[:4]
    yield Body(body.name, body.frame, mass, NO_VECTOR, Inertia(*given[4:]))
    for k, moment in enumerate(moments):
        for share, place in ((HALF, ONE), (MINUS_HALF, MINUS_ONE)):
            x, y, z = (place if i == k else ZERO for i in range(3))
            yield Body(body.name, body.frame, times(share, moment), (x, y, z), Inertia())
