"""A robot description as blocks of the model language, put before the entries that the model file has itself.

So a robot is resolved, checked and derived like frames, joints and bodies that a user wrote, and loops, points and
inputs of the model file refer to its links and joints by name.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import sqrt

from symgen.diagnostics import Span
from symgen.model.file.reading import entries
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode
from symgen.model.mechanism import WORLD
from symgen.model.robots.joint_friction import JointFriction, friction_entries
from symgen.model.robots.names import RobotNames
from symgen.model.robots.nodes import Entry, is_placed, ranged_names, text_node, with_entries
from symgen.model.robots.numbers import WrittenNumber, angle_text, written
from symgen.model.urdf.bodies import body_entries, carried_links, placed_links
from symgen.model.urdf.robot import ENDINGS, Origin, Robot, UrdfJoint

TYPES = {"continuous": "revolute"}
# roll, pitch and yaw turn about x, y, z fixed in the parent: yaw, pitch, roll about the axes reached so far
TURNS = ("x", "y", "z")


def with_robot(scope: Scope, tree: MappingNode, robot: Robot, names: RobotNames, span: Span) -> MappingNode:
    """The tree of the model file with the robot's frames, joints, bodies, friction, ranges and rows of mimics."""
    frames: list[Entry] = []
    joints: list[Entry] = []
    root = names.frames[robot.root]
    if root != WORLD and not is_placed(tree, root):
        place = robot.links[robot.root].span
        frames.append((text_node(root, place), MappingNode((), place, True)))
    for joint in robot.joints.values():
        entry = _motion(joint, names)
        (frames if joint.kind == "fixed" else joints).append(entry)
    moving = [joint for joint in robot.joints.values() if joint.kind != "fixed"]
    additions = {
        "constraints": list(_mimics(moving, names)),
        "frames": frames,
        "joints": joints,
        "bodies": list(_bodies(scope, tree, robot, names)),
        "friction": list(friction_entries(scope, tree, "URDF", _friction(moving, names))),
        "ranges": list(_ranges(tree, moving, names)),
    }
    return with_entries(tree, additions, span)


def _motion(joint: UrdfJoint, names: RobotNames) -> Entry:
    """The frame of a fixed joint, or the joint with its coordinates."""
    span, child = joint.span, names.frames[joint.child]
    parent = (text_node("parent", span), text_node(names.frames[joint.parent], span))
    turns = _turns(joint.origin, span)
    shift = SequenceNode(tuple(entry.node for entry in joint.origin.xyz), span)
    if joint.kind == "fixed":
        parts: list[Entry] = [parent]
        if any(joint.origin.shift):
            parts.append((text_node("translation", span), shift))
        if turns.items:
            parts.append((text_node("rotation", span), turns))
        return text_node(child, span), MappingNode(tuple(parts), span, True)
    base = names.coordinates[joint.name]
    coordinates = tuple(text_node(base + ending, span) for ending in ENDINGS[joint.kind])
    moved: list[Entry] = [
        (text_node("type", span), text_node(TYPES.get(joint.kind, joint.kind), span)),
        parent,
        (text_node("child", span), text_node(child, span)),
        (text_node("axis", span), _axis(joint)),
        (text_node("coordinates", span), SequenceNode(coordinates, span)),
    ]
    if any(joint.origin.shift):
        moved.append((text_node("at", span), shift))
    if turns.items:
        moved.append((text_node("rotation", span), turns))
    return text_node(base, span), MappingNode(tuple(moved), span, True)


def _turns(origin: Origin, span: Span) -> SequenceNode:
    turns = []
    for name, angle in reversed(list(zip(TURNS, origin.rpy, strict=False))):
        if angle_text(angle) != "0" and angle.value != 0:
            turn = ScalarNode(angle_text(angle), angle.span, angle.text, False)
            turns.append(SequenceNode((text_node(name, span), turn), span))
    return SequenceNode(tuple(turns), span)


def _axis(joint: UrdfJoint) -> Node:
    """The axis; that of a way gets length 1, where a turn needs the direction only."""
    if not joint.axis:
        return text_node("x", joint.span)
    square = sum((entry.value**2 for entry in joint.axis), Fraction(0))
    if joint.kind != "prismatic" or square == 1:
        return SequenceNode(tuple(entry.node for entry in joint.axis), joint.span)
    length = Fraction(sqrt(square))
    scaled = (ScalarNode(written(entry.value / length), entry.span, "", False) for entry in joint.axis)
    return SequenceNode(tuple(scaled), joint.span)


def _bodies(scope: Scope, tree: MappingNode, robot: Robot, names: RobotNames) -> Iterable[Entry]:
    taken = {key.value: key.span for key, _ in entries(tree.get("bodies"))}
    places = placed_links(robot)
    for carrier, links in carried_links(places).items():
        made = body_entries(robot, links, places)
        if made is None:
            continue
        name = names.frames[carrier]
        if name in taken:
            remedy = f"name the further body differently, with `frame: {name}`"
            scope.wrong(f"`{name}` has its mass from the robot description", remedy, taken[name])
        yield text_node(name, made[1]), made[0]


def _friction(joints: list[UrdfJoint], names: RobotNames) -> Iterable[JointFriction]:
    for joint in joints:
        viscous, dry = (
            value.node if value is not None and value.value else None
            for value in (joint.dynamics.get("damping"), joint.dynamics.get("friction"))
        )
        yield JointFriction(joint.name, names.coordinates[joint.name], viscous, dry, joint.span)


def _ranges(tree: MappingNode, joints: list[UrdfJoint], names: RobotNames) -> Iterable[Entry]:
    """Limits of position, velocity and acceleration, unless the model file gives the range itself."""
    own = ranged_names(tree)
    for joint in joints:
        if ENDINGS[joint.kind] != ("",):
            continue
        name, span = names.coordinates[joint.name], joint.span
        ranges: list[tuple[str, Node, Node]] = []
        if joint.kind != "continuous":
            lower, upper = (_number(joint.limits.get(key), span) for key in ("lower", "upper"))
            ranges.append((name, lower, upper))
        for key, ending in (("velocity", "_dot"), ("acceleration", "_ddot")):
            bound = joint.limits.get(key)
            if bound is not None and bound.value > 0:
                ranges.append((name + ending, ScalarNode(f"-{bound.text}", bound.span, "", False), bound.node))
        for key, low, high in ranges:
            if key not in own:
                yield text_node(key, span), SequenceNode((low, high), span)


def _mimics(joints: list[UrdfJoint], names: RobotNames) -> Iterable[Entry]:
    for joint in joints:
        mimic = joint.mimic
        if mimic is None:
            continue
        name, row = names.coordinates[joint.name], names.coordinates[mimic.joint]
        if mimic.multiplier is not None and mimic.multiplier.value != 1:
            row = f"({mimic.multiplier.text})*{row}"
        if mimic.offset is not None and mimic.offset.value != 0:
            row = f"{row} - ({mimic.offset.text})"
        yield text_node(f"{name}_mimic", mimic.span), ScalarNode(f"{name} - {row}", mimic.span, "", False)


def _number(value: WrittenNumber | None, span: Span) -> Node:
    return text_node("0", span) if value is None else value.node
