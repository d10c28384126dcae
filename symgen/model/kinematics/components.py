"""Which components of points and frames a model's formulas use, and in which order names can be worked out."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import names_in
from symgen.model.mechanism import is_component
from symgen.model.model import Definition, Model
from symgen.model.published import Published, PublishedEquations, PublishedMatrix, PublishedSingularSet


def formulas(model: Model) -> Iterator[Expression]:
    """Every formula of the motion equations and of the task, but for those that place frames and points."""
    yield from (definition.value for definition in model.definitions)
    yield model.kinetic_energy
    yield model.potential_energy
    yield from (row.expression for row in model.constraints)
    yield from (x.expression for x in model.task)
    for control in model.inputs:
        yield from (entry for _, entry in control.acts_on)
        if control.velocity is not None:
            yield control.velocity
    yield from (force.expression for force in model.applied_forces)
    for element in model.forces:
        yield element.magnitude
        yield element.velocity
    yield from (place.velocity for place in model.rough)


def printed_formulas(published: tuple[Published, ...]) -> Iterator[Expression]:
    """Every formula that was printed somewhere, and its correction."""
    for one in published:
        match one:
            case PublishedMatrix():
                yield from (entry for matrix in (one.value, one.corrected or ()) for row in matrix for entry in row)
                yield from (value for _, value in one.where)
            case PublishedEquations():
                yield from (side for pair in (*one.equations, *one.corrected) for side in pair)
                yield from (value for _, value in one.where)
            case PublishedSingularSet():
                yield one.where_zero
                if one.corrected is not None:
                    yield one.corrected


def components_in(model: Model) -> tuple[str, ...]:
    """The components used anywhere, in order of reading."""
    if not (model.mechanism.points or model.mechanism.frames):
        return ()
    names = (name.name for formula in formulas(model) for name in names_in(formula))
    return tuple(dict.fromkeys(name for name in names if is_component(name)))


def definitions_before_frames(model: Model) -> tuple[Definition, ...]:
    """The definitions that use no component, directly or through others: those that may place frames."""
    return without_components(model.definitions) if model.mechanism.frames else ()


def without_components(definitions: tuple[Definition, ...]) -> tuple[Definition, ...]:
    """The definitions that use no component of a point or frame, directly or through others."""
    later: set[str] = set()
    for definition in definitions:
        if any(is_component(name.name) or name.name in later for name in names_in(definition.value)):
            later.add(definition.name)
    return tuple(definition for definition in definitions if definition.name not in later)
