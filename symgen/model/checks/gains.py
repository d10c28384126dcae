"""Gains under `identify`: each a mere factor of one input, so that a log of that input can tell it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from symgen.diagnostics import Mistake
from symgen.model.combinations.geometry import geometric_expressions, names_reached
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.monomials import NotInProductsError, monomials
from symgen.model.file.reading import items, member, text_of
from symgen.model.file.source import MappingNode
from symgen.model.identify_choice import IdentifyChoice
from symgen.model.inertial_parameters import expressions
from symgen.model.model import Input, Model


def check_gains(tree: MappingNode, model: Model) -> Iterator[Mistake]:
    """What is wrong with each of the gains that are parameters of the model."""
    node, chosen = tree.get("identify"), model.identify
    if node is None or chosen is None:
        return
    known = {parameter.name: parameter.value for parameter in model.parameters}
    driven: dict[str, str] = {}
    for item in items(member(node, "gains")):
        name = text_of(item)
        if name in chosen.gains and (reason := _wrong(model, chosen, name, known[name], driven)) is not None:
            message, remedy = reason
            yield Mistake(message, remedy, item.span)


def driven_input(model: Model, name: str) -> int:
    """The number of the input whose factor a gain is."""
    (place,) = (k for k, one in enumerate(model.inputs) if name in names_reached(model, _of_input(one)))
    return place


def _wrong(
    model: Model, chosen: IdentifyChoice, name: str, value: Expression, driven: dict[str, str]
) -> tuple[str, str] | None:
    """What is wrong with a gain, and what to do; `driven` are inputs with gains so far, and is added to."""
    inputs = [one for one in model.inputs if name in names_reached(model, _of_input(one))]
    meanings = _meanings(model)
    if not inputs:
        like = next((f"`acts_on: {{{one.acts_on[0][0]}: {name}}}`" for one in model.inputs if one.acts_on), "`acts_on`")
        return f"the gain `{name}` is in no input", f"write it as a factor of what an input acts by, such as {like}"
    if len(inputs) > 1:
        listed = ", ".join(f"`{one.name}`" for one in inputs)
        return f"the gain `{name}` is a factor of several inputs: {listed}", "give each drive a gain of its own"
    (one,) = inputs
    if not _is_factor(_of_input(one), name, meanings):
        return (
            f"the gain `{name}` is no mere factor of `{one.name}`",
            f"write it once in each product, such as `acts_on: {{x: {name}*cos(b)}}`, and in nothing else of the input",
        )
    if elsewhere := [what for what, of in _beside_inputs(model) if name in names_reached(model, of)]:
        return (
            f"the gain `{name}` stands in {elsewhere[0]}, too",
            "name the gain of the drive by itself: another parameter with the same value",
        )
    if not isinstance(value, Number):
        return f"the gain `{name}` follows from other parameters", "give its value as a number"
    if not value.value:
        return f"the gain `{name}` is 0, which drives nothing", "give the value that the data sheet says"
    if name in (*chosen.fixed, *chosen.geometry):
        return f"`{name}` is a gain that is estimated, and is taken for known", "name it in one of the lists"
    if one.name in driven:
        if driven[one.name] == name:
            return f"the gain `{name}` stands twice in `gains`", "name it once"
        return (
            f"the gains `{driven[one.name]}` and `{name}` are both factors of `{one.name}`: only their product shows",
            "leave out the one that is known",
        )
    driven[one.name] = name
    return None


def _of_input(one: Input) -> list[Expression]:
    return [expression for _, expression in one.acts_on] + ([] if one.velocity is None else [one.velocity])


def _is_factor(of: Iterable[Expression], name: str, meanings: Mapping[str, Expression]) -> bool:
    try:
        return monomials(of, frozenset({name}), meanings) == (((name, 1),),)
    except NotInProductsError:
        return False


def _meanings(model: Model) -> dict[str, Expression]:
    """What names stand for, numbers apart."""
    made = {definition.name: definition.value for definition in model.definitions}
    return made | {p.name: p.value for p in model.parameters if not isinstance(p.value, Number)}


def _beside_inputs(model: Model) -> Iterator[tuple[str, list[Expression]]]:
    """What else equations of motion are made of."""
    yield "the energies or springs", [model.kinetic_energy, model.potential_energy]
    yield "`bodies` or `rotor_inertias`", list(expressions(model.mechanism))
    yield "`gravity`", list(model.mechanism.gravity)
    yield "frames, points or constraints", list(geometric_expressions(model))
    forces = [part for force in model.forces for part in (force.magnitude, force.velocity)]
    forces += [force.expression for force in model.applied_forces]
    for place in model.rough:
        forces += [place.coefficient, place.radius, place.width, place.velocity]
    yield "forces or friction", forces
