"""From the tree of the file to a complete Model: every name known, every default filled in."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from symgen.diagnostics import Notice, Span
from symgen.model.asked_base import with_inertial_base
from symgen.model.blocks.allocation import declare_settings, read_allocation
from symgen.model.blocks.bodies import read_mechanism
from symgen.model.blocks.coordinates import read_coordinates
from symgen.model.blocks.couplings import read_couplings
from symgen.model.blocks.drawn import read_picture
from symgen.model.blocks.elements import read_forces, read_friction, read_springs
from symgen.model.blocks.identify import read_identify
from symgen.model.blocks.inputs import read_inputs
from symgen.model.blocks.joint_forms import JointCoordinate, read_joints
from symgen.model.blocks.loops import LoopRows
from symgen.model.blocks.paths import read_paths
from symgen.model.blocks.published import read_published
from symgen.model.blocks.rough_places import read_rough_places
from symgen.model.blocks.task import read_task
from symgen.model.checks.all_checks import check_mechanics, notice_efforts, notice_empty_outputs
from symgen.model.checks.dimensions import check_units
from symgen.model.checks.gains import check_gains
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.combine import plus
from symgen.model.expressions.expression import Call, Expression, Number
from symgen.model.expressions.names import name_mistake, nearest
from symgen.model.file.constants import constant
from symgen.model.file.declarations import (
    declare_names,
    read_applied_forces,
    read_constraints,
    read_definitions,
    read_parameters,
    read_ranges,
)
from symgen.model.file.reading import entries, items, member, one_line, text_of
from symgen.model.file.schema import MODEL
from symgen.model.file.scope import CONFIGURATION, STATE, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.kinematics.components import without_components
from symgen.model.mechanism import Mechanism, Quaternion
from symgen.model.model import Input, Model
from symgen.model.quantities import QUANTITIES, ROWS

ZERO = Number(Fraction(0))


def resolve(scope: Scope, tree: MappingNode, text: str) -> Model:
    """The model as far as it can be understood; what cannot is a mistake in `scope`."""
    joint_coordinates = declare_names(scope, tree)
    declare_settings(scope, tree)
    ranges = read_ranges(scope, tree)
    parameters = read_parameters(scope, tree, ranges)
    definitions = read_definitions(scope, tree)
    defaults = default_values(parameters)
    joints = read_joints(scope, tree, joint_coordinates, defaults)
    mechanism = read_mechanism(scope, tree, joints.frames)
    _check_mass(scope, tree)
    kinetic_read = scope.expression(tree.get("kinetic_energy"), "the kinetic energy", STATE)
    kinetic = kinetic_read or ZERO
    potential = scope.expression(tree.get("potential_energy"), "the potential energy", CONFIGURATION) or ZERO
    written = (*read_constraints(scope, tree), *read_couplings(scope, tree))
    inputs = read_inputs(scope, tree)
    allocation, settings = read_allocation(scope, tree, inputs, parameters, ranges)
    forces = read_applied_forces(scope, tree)
    springs, dampers, fits = read_springs(scope, tree, defaults)
    friction, fits_of_friction = read_friction(scope, tree)
    elements = read_forces(scope, tree)
    used = [
        kinetic, potential, *(row.expression for row in written), *(force.expression for force in forces),
        *(coefficient for column in inputs for _, coefficient in column.acts_on), *_placing(mechanism),
    ]  # fmt: skip
    coordinates = read_coordinates(tree, ranges, definitions, used, joint_coordinates)
    made = LoopRows(scope, mechanism, coordinates, without_components(definitions), defaults)
    before = len(scope.mistakes)
    constraints = (*written, *made.of_loops(tree), *joints.rows, *made.of_wheels(tree))
    # of loops with mistakes nobody knows how many rows they would have
    rows = sum(row.kind == "geometric" for row in constraints) if len(scope.mistakes) == before else None
    rough = read_rough_places(scope, tree, mechanism, constraints, defaults)
    names = tuple(coordinate.name for coordinate in coordinates)
    whole = not scope.mistakes
    tolerances = tree.get("tolerances")
    published = read_published(scope, tree, names)
    paths = read_paths(scope, tree, names, rows)
    model = Model(
        name=_model_name(scope, tree),
        description=one_line(tree.get("description")),
        source=one_line(tree.get("source")),
        coordinates=coordinates,
        parameters=(*parameters, *settings),
        definitions=definitions,
        kinetic_energy=kinetic,
        potential_energy=plus(potential, springs),
        constraints=tuple(sorted(constraints, key=lambda row: row.kind == "nonholonomic")),
        inputs=inputs,
        allocation=allocation,
        applied_forces=forces,
        outputs=_outputs(tree.get("outputs"), bool(inputs)),
        together=_together(tree.get("outputs")),
        independent_velocities=_coordinate_list(scope, tree, "independent_velocities", names),
        measured=_coordinate_list(scope, tree, "measured", names) or _driven(tree.get("outputs"), inputs),
        deviations=_deviations(scope, tree.get("measured")),
        task=read_task(scope, tree),
        identify=read_identify(scope, tree, parameters),
        derivatives=text_of(tree.get("derivatives")) == "true",
        configuration=_configuration(scope, tree.get("configuration"), names, joint_coordinates),
        constraint_rank_tolerance=_tolerance(scope, tolerances, "constraint_rank"),
        actuation_rank_tolerance=_tolerance(scope, tolerances, "actuation_rank"),
        published=published,
        paths=paths,
        report=_report(tree.get("report")),
        notices=(),
        text_hash=hashlib.sha256(text.encode()).hexdigest(),
        mechanism=mechanism,
        forces=(*dampers, *friction, *elements),
        rough=rough.places,
        released=rough.released,
        trig_range="wide" if text_of(tree.get("trig_range")) == "wide" else "normal",
        picture=read_picture(scope, tree, defaults),
    )
    as_written = replace(model, potential_energy=potential, forces=elements, mechanism=model.pictured)
    scope.mistakes.extend(check_units(tree, as_written, (*fits, *fits_of_friction, *rough.fits)))
    scope.mistakes.extend(check_gains(tree, model) if whole else ())
    model = check_mechanics(scope, tree, model, kinetic_read, whole)
    if not scope.mistakes:
        model = with_inertial_base(model, model.outputs)
    notice_empty_outputs(scope, tree, model)
    notice_efforts(scope, model)
    _notice_unused(scope, tree)
    return model


def _check_mass(scope: Scope, tree: MappingNode) -> None:
    """Something must move, and have mass."""
    known = {field.key for field in MODEL.fields}
    needed = ("coordinates", "joints", "kinetic_energy", "bodies")
    if any(key.value not in known and nearest(key.value, sorted(known)) in needed for key, _ in tree.entries):
        return  # the key is misspelt, which is told
    if tree.get("coordinates") is None and tree.get("joints") is None:
        span = Span(tree.span.line, tree.span.column, tree.span.column + 1)
        remedy = "add `coordinates`: the generalized coordinates, in the order of q; the rate of x is x_dot"
        scope.wrong("the model has no `coordinates`", remedy, span)
    if tree.get("kinetic_energy") is None and tree.get("bodies") is None:
        span = Span(tree.span.line, tree.span.column, tree.span.column + 1)
        remedy = "add `kinetic_energy`: T, quadratic in the rates; or `frames` and `bodies`"
        scope.wrong("the model has no `kinetic_energy` and no `bodies`", remedy, span)


def _placing(mechanism: Mechanism) -> Iterator[Expression]:
    """What places frames and points; an angle of a turn counts as inside a sine."""
    for frame in mechanism.frames:
        yield from frame.translation
        if isinstance(frame.rotation, Quaternion):
            yield from frame.rotation.parts
        else:
            yield from (Call("sin", (turn.angle,)) for turn in frame.rotation)
    yield from (entry for point in mechanism.points for entry in point.at)


def _model_name(scope: Scope, tree: MappingNode) -> str:
    node = tree.get("model")
    if not isinstance(node, ScalarNode) or not node.value:
        return ""
    mistake = name_mistake(node, "model")
    if mistake is not None:
        scope.mistakes.append(mistake)
    return node.value


def _outputs(node: Node | None, has_inputs: bool) -> tuple[str, ...]:
    """What is to be made, in the order in which it is named first, together with others or by itself."""
    known = {"all", *(quantity.name for quantity in QUANTITIES)}
    outputs: list[str] = []
    for item in (node,) if isinstance(node, ScalarNode) else items(node):
        for one in _members(item) or (item,):
            name = text_of(one)
            if name in known and name not in outputs:
                outputs.append(name)
    if "all" in outputs:  # what is named beside it is made however long it is
        outputs.sort(key=lambda name: name != "all")
    return tuple(outputs) or (("inverse_dynamics",) if has_inputs else ("forward_dynamics",))


def _members(output: Node) -> tuple[Node, ...]:
    """The quantities that one call is to have; none for one that is named by itself."""
    return tuple(items(output.get("together"))) if isinstance(output, MappingNode) else ()


def _together(outputs: Node | None) -> tuple[tuple[str, ...], ...]:
    """The groups of quantities that have a function in common, each once."""
    groups = (tuple(dict.fromkeys(map(text_of, _members(item)))) for item in items(outputs))
    return tuple(dict.fromkeys(tuple(name for name in group if name in ROWS) for group in groups if len(group) > 1))


def _driven(outputs: Node | None, inputs: tuple[Input, ...]) -> tuple[str, ...]:
    """The coordinates that inputs drive alone: what is measured where outputs need it and the file does not say."""
    named = (text_of(one) for item in items(outputs) for one in _members(item) or (item,))
    asked = any(name in ROWS and ROWS[name].is_of_measured for name in named if name is not None)
    columns = [given.acts_on for given in inputs if given.velocity is None] if asked else []
    driven = (column[0] for column in columns if len(column) == 1)
    return tuple(dict.fromkeys(name for name, force in driven if isinstance(force, Number)))


def _coordinate_list(scope: Scope, tree: MappingNode, key: str, names: tuple[str, ...]) -> tuple[str, ...]:
    chosen: list[str] = []
    node = tree.get(key)
    listed: Sequence[Node] = [name for name, _ in entries(node)] or items(node)
    for item in listed:
        name = text_of(item)
        if name is None:
            continue
        if name not in names:
            remedy = scope.coordinate_meant(name, names, "name coordinates, without _dot")
            if name.removesuffix("_dot") in names:
                remedy = f"write the coordinate: `{name.removesuffix('_dot')}`"
            scope.wrong_about(name, f"`{name}` in `{key}` is no coordinate", remedy, item.span)
        elif name in chosen:
            scope.wrong(f"`{name}` stands twice in `{key}`", "name it once", item.span)
        else:
            chosen.append(name)
    # With a faulty name the count would be wrong too; one mistake is enough.
    return tuple(chosen) if len(chosen) == len(listed) else ()


def _deviations(scope: Scope, node: Node | None) -> tuple[Fraction, ...]:
    """What encoders are off by, where the file says it."""
    deviations: list[Fraction] = []
    for key, value in entries(node):
        number = constant(scope, value, f"the standard deviation of `{key.value}`")
        if number is not None and number <= 0:
            scope.wrong(f"the standard deviation of `{key.value}` is not positive", "write what its encoder is off by, "
                        "such as 1e-4", value.span)  # fmt: skip
            number = None
        deviations += [] if number is None else [number]
    return tuple(deviations) if len(deviations) == len(entries(node)) else ()


def _configuration(
    scope: Scope, node: Node | None, names: tuple[str, ...], joints: tuple[JointCoordinate, ...]
) -> tuple[tuple[str, Fraction], ...]:
    start: list[tuple[str, Fraction]] = []
    for key, value in entries(node):
        if key.value not in names:
            remedy = scope.coordinate_meant(key.value, names, "name coordinates")
            scope.wrong_about(key.value, f"`{key.value}` in `configuration` is no coordinate", remedy, key.span)
            continue
        number = constant(scope, value, f"the start value of `{key.value}`")
        if number is not None:
            start.append((key.value, number))
    given = {name for name, _ in start}
    usual = [(joint.name, joint.start) for joint in joints if joint.start is not None and joint.name not in given]
    return (*start, *usual)


def _tolerance(scope: Scope, node: Node | None, key: str) -> Fraction | None:
    value_node = member(node, key)
    value = constant(scope, value_node, f"the tolerance `{key}`")
    if value is None or value_node is None:
        return None
    if not 0 < value < 1:
        scope.wrong(f"the tolerance `{key}` is not between 0 and 1", "write a small number such as 1e-9",
                    value_node.span)  # fmt: skip
        return None
    return value


def _report(node: Node | None) -> Literal["full", "short"]:
    return "short" if text_of(node) == "short" else "full"


def _notice_unused(scope: Scope, tree: MappingNode) -> None:
    for block, kind in (("parameters", "parameter"), ("definitions", "definition")):
        for key, _ in entries(tree.get(block)):
            if scope.kinds.get(key.value) == kind and key.value not in scope.used:
                scope.notices.append(Notice(f"the {kind} `{key.value}` is not used", key.span))
