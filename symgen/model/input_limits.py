"""What drives can do at least and at most, in numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping

from symgen.model.model import Model


def input_limits(model: Model, values: Mapping[str, float]) -> list[tuple[float, float]]:
    """Of each input the least and the largest value, for values of parameters; infinite where the model has none."""
    limits = () if model.allocation is None else model.allocation.limits
    stated = {limit.input: (values[limit.lower], values[limit.upper]) for limit in limits}
    return [stated.get(one.name, (-math.inf, math.inf)) for one in model.inputs]
