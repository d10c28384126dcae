"""By what inputs and gravity act: inputs are linear in nothing that stands there."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.model.expressions.expression import Expression
from symgen.model.model import Model


def acting(model: Model) -> Iterator[Expression]:
    """Gravity, and the directions and rates of inputs."""
    yield from model.mechanism.gravity
    for one in model.inputs:
        yield from (expression for _, expression in one.acts_on)
        if one.velocity is not None:
            yield one.velocity
