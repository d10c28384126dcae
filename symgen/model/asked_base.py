"""The base of inertial parameters, found for those who ask for quantities that are made of it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from symgen.model.model import Model
from symgen.model.quantities import ROWS


def with_inertial_base(model: Model, outputs: Collection[str]) -> Model:
    """The model with its base, where any of the outputs is made of that and it is not known yet."""
    asked = any(name in ROWS and ROWS[name].is_of_base for name in outputs)
    if not asked or model.inertial_base is not None or not model.mechanism.has_mass:
        return model
    from symgen.model.combinations.inertial_base import inertial_base  # takes a second, and few models name these

    return replace(model, inertial_base=inertial_base(model))
