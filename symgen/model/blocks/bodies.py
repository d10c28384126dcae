"""Reading bodies: masses, centres of mass, inertias, rotor inertias and gravity."""

from __future__ import annotations

from symgen.diagnostics import Notice
from symgen.model.blocks.drawn import read_ties, read_wheels
from symgen.model.blocks.frames import frame_name, read_frames, read_points, read_vector
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.names import did_you_mean
from symgen.model.expressions.walk import exact_value
from symgen.model.file.reading import entries, key_span, member
from symgen.model.file.scope import PARAMETERS, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.mechanism import (
    INERTIA_ELEMENTS,
    NO_VECTOR,
    WORLD,
    ZERO,
    Body,
    Frame,
    Inertia,
    Mechanism,
    RotorInertia,
    Vector3,
)


def read_mechanism(scope: Scope, tree: MappingNode, joints: tuple[Frame, ...]) -> Mechanism:
    """Frames (those of `joints` among them), bodies, points, rotor inertias and gravity."""
    frames = read_frames(scope, tree, joints)
    bodies = _bodies(scope, tree)
    gravity = _gravity(scope, tree, bodies)
    points, rotors = read_points(scope, tree), _rotor_inertias(scope, tree)
    pictured = tuple(read_wheels(scope, tree)), tuple(read_ties(scope, tree))
    return Mechanism(gravity, frames, bodies, points, rotors, *pictured)


def _bodies(scope: Scope, tree: MappingNode) -> tuple[Body, ...]:
    bodies = []
    for key, node in entries(tree.get("bodies")):
        what = f"the body `{key.value}`"
        frame_node = member(node, "frame")
        frame = _own_frame(scope, key) if frame_node is None else frame_name(scope, frame_node, f"`frame` of {what}")
        mass = scope.expression(member(node, "mass"), f"the mass of {what}", PARAMETERS) or ZERO
        com = read_vector(scope, member(node, "com"), f"the centre of mass of {what}", PARAMETERS) or NO_VECTOR
        inertia = _inertia(scope, member(node, "inertia"), what)
        if frame is not None:
            bodies.append(Body(key.value, frame, mass, com, inertia, key.span))
    return tuple(bodies)


def _own_frame(scope: Scope, key: ScalarNode) -> str | None:
    """The frame of the body's own name."""
    if scope.kinds.get(key.value) == "frame" or key.value == WORLD:
        return key.value
    frames = [name for name, kind in scope.kinds.items() if kind == "frame"]
    remedy = did_you_mean(key.value, frames, "say which with `frame:`, or name the body like its frame")
    scope.wrong_about(key.value, f"the body `{key.value}` has no frame", remedy, key.span)
    return None


def _inertia(scope: Scope, node: Node | None, what: str) -> Inertia:
    elements: dict[str, Expression] = {
        name: scope.expression(member(node, name), f"the inertia {name} of {what}", PARAMETERS) or ZERO
        for name in INERTIA_ELEMENTS
    }
    return Inertia(**elements)


def _rotor_inertias(scope: Scope, tree: MappingNode) -> tuple[RotorInertia, ...]:
    rotors = []
    for key, node in entries(tree.get("rotor_inertias")):
        inertia = scope.expression(node, f"the rotor inertia of `{key.value}`", PARAMETERS)
        if scope.kinds.get(key.value) != "coordinate":
            coordinates = [name for name, kind in scope.kinds.items() if kind == "coordinate"]
            remedy = scope.coordinate_meant(key.value, coordinates, "name a coordinate")
            scope.wrong_about(key.value, f"`{key.value}` in `rotor_inertias` is no coordinate", remedy, key.span)
        elif inertia is not None:
            rotors.append(RotorInertia(key.value, inertia, key.span))
    return tuple(rotors)


def _gravity(scope: Scope, tree: MappingNode, bodies: tuple[Body, ...]) -> Vector3:
    node = tree.get("gravity")
    if node is not None:
        return read_vector(scope, node, "`gravity`", PARAMETERS) or NO_VECTOR
    if any(exact_value(body.mass) != 0 for body in bodies):
        span = key_span(tree, "bodies")
        scope.notices.append(Notice("the bodies have mass and there is no `gravity`: it is taken as zero", span))
    return NO_VECTOR
