"""The base of inertial parameters, as far as quantities that are asked for are made of it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from symgen.model.inertial_base import NOT_NAMED
from symgen.model.model import Model
from symgen.model.quantities import BASE_PARAMETERS, ROWS


def with_inertial_base(model: Model, outputs: Collection[str]) -> Model:
    """The model with its base, where any of the outputs is made of that and it is not known yet."""
    asked, with_values = any(name in ROWS and ROWS[name].is_of_base for name in outputs), BASE_PARAMETERS in outputs
    known = model.inertial_base is not None and not (with_values and model.inertial_base.why == NOT_NAMED)
    if not asked or known or not model.mechanism.has_mass:
        return model
    from symgen.model.combinations.inertial_base import inertial_base  # takes a second, and few models name these

    return replace(model, inertial_base=inertial_base(model, with_values))
