"""What is wrong with a model that shows only once it is derived and verified, as mistakes of the user."""

from __future__ import annotations

from symgen.backends.literals import LiteralRangeError
from symgen.diagnostics import Mistake
from symgen.model.model import Model

MORE_STATES = "give a start under `configuration` and the ranges of the coordinates"


def beyond_range(error: LiteralRangeError) -> Mistake:
    """That a kernel holds a number that its scalar type does not."""
    remedy = "choose units in which lengths, masses and times are near 1, and look for definitions that are too steep"
    if error.scalar == "float32":
        remedy = f"generate double precision alone, with `--scalar float64`, or {remedy}"
    return Mistake(str(error), remedy)


def no_states(model: Model, why: str) -> Mistake:
    """What verification has no states for, at the first row that they must satisfy."""
    message, _, remedy = why.partition("; ")
    spans = [row.span for row in model.constraints if row.kind == "geometric" and row.span is not None]
    place = next((span for span in spans if not span.file), None)
    return Mistake(message.removeprefix(f"{model.name}: "), remedy or MORE_STATES, place)
