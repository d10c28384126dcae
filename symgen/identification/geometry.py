"""Which parameters say where bodies are: those that frames, points and constraints hold."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.mechanism import Quaternion
from symgen.model.model import Model


def geometry_values(model: Model) -> dict[str, Fraction]:
    """Parameters of the geometry that are numbers of the file, with these numbers; those that are 0 are left out.

    Of parameters that follow from others those others count; what is made of pi or roots stays as it is.
    """
    read = {p.name: p.value for p in model.parameters} | {d.name: d.value for d in model.definitions}
    reached: dict[str, None] = {}
    pending = [name for expression in _geometric(model) for name in _names(expression)]
    while pending:
        name = pending.pop()
        if name in read and name not in reached:
            reached[name] = None
            pending += _names(read[name])
    given = {p.name: exact_value(p.value) for p in model.parameters if p.name in reached}
    return {name: value for name, value in given.items() if value}


def _geometric(model: Model) -> Iterator[Expression]:
    mechanism = model.mechanism
    for frame in mechanism.frames:
        yield from frame.translation
        if isinstance(frame.rotation, Quaternion):
            yield from frame.rotation.parts
        else:
            for turn in frame.rotation:
                yield from (*turn.axis, turn.angle)
    for point in mechanism.points:
        yield from point.at
    yield from (row.expression for row in model.constraints)


def _names(expression: Expression) -> Iterable[str]:
    return (name.name for name in names_in(expression))
