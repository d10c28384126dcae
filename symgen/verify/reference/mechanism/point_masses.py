"""Point masses in the place of bodies: a model whose frames carry ten each, alone and unheld."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.expression import Number
from symgen.model.mechanism import ZERO, Body, Inertia
from symgen.model.model import Model

# Where they stand in the axes of their frame: what is quadratic in the place is known from values there.
PLACES = (
    (0, 0, 0),
    (1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1),
    (1, 1, 0), (1, 0, 1), (0, 1, 1),
)  # fmt: skip


def frames_with_bodies(model: Model) -> list[str]:
    """Those that carry bodies, each once, in the order of these."""
    return list(dict.fromkeys(body.frame for body in model.mechanism.bodies))


def with_point_masses(model: Model) -> Model:
    """Its frames and gravity with masses of 1 at each of `PLACES`, frame by frame; no constraints, no other forces."""
    masses = tuple(
        Body(f"{frame} {k}", frame, _number(1), (_number(x), _number(y), _number(z)), Inertia())
        for frame in frames_with_bodies(model)
        for k, (x, y, z) in enumerate(PLACES)
    )
    return replace(
        model,
        kinetic_energy=ZERO,
        potential_energy=ZERO,
        constraints=(),
        inputs=(),
        applied_forces=(),
        forces=(),
        rough=(),
        released=(),
        mechanism=replace(model.mechanism, bodies=masses, rotor_inertias=()),
        assembly=None,
        allocation=None,
        task=(),
        measured=(),
    )


def _number(value: int) -> Number:
    return Number(Fraction(value))
