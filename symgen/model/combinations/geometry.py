"""Which parameters say where bodies are: those that frames, points and constraints hold."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction

from symgen.model.expressions.expression import Binary, Expression, Name, Negation, Power
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.mechanism import Quaternion
from symgen.model.model import Model


def geometry_values(model: Model) -> dict[str, Fraction]:
    """Parameters of the geometry that are numbers of the file, with these numbers; those that are 0 are left out.

    Of parameters that follow from others those others count; what is made of pi or roots stays as it is.
    """
    reached = names_reached(model, geometric_expressions(model))
    given = {p.name: exact_value(p.value) for p in model.parameters if p.name in reached}
    return {name: value for name, value in given.items() if value}


def names_reached(
    model: Model, expressions: Iterable[Expression], names: Callable[[Expression], Iterable[str]] | None = None
) -> set[str]:
    """Parameters and definitions in some expressions, and those that these are made of; `names` says what they hold,
    every name unless given."""
    held = names or _names
    read = {p.name: p.value for p in model.parameters} | {d.name: d.value for d in model.definitions}
    reached: set[str] = set()
    pending = [name for expression in expressions for name in held(expression)]
    while pending:
        name = pending.pop()
        if name in read and name not in reached:
            reached.add(name)
            pending += held(read[name])
    return reached


def angular_parameters(model: Model) -> frozenset[str]:
    """Parameters of the geometry that stand in functions alone, as angles do: what depends on them is no polynomial."""
    frames = model.mechanism.frames
    turns = [turn.angle for frame in frames if not isinstance(frame.rotation, Quaternion) for turn in frame.rotation]
    plain = (one for one in geometric_expressions(model) if not any(one is turn for turn in turns))
    return frozenset(geometry_values(model).keys() - names_reached(model, plain, _names_outside_functions))


def geometric_expressions(model: Model) -> Iterator[Expression]:
    """What frames, points and constraints are given by."""
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


def _names_outside_functions(expression: Expression) -> Iterator[str]:
    """Of roots and the like, too, nothing inside counts."""
    match expression:
        case Name(name=name):
            yield name
        case Negation(operand=inner) | Power(base=inner):
            yield from _names_outside_functions(inner)
        case Binary(left=left, right=right):
            yield from _names_outside_functions(left)
            yield from _names_outside_functions(right)
