"""Reading frames and points: where things are, as a tree that hangs on the world."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.diagnostics import Notice
from symgen.model.expressions.combine import times
from symgen.model.expressions.expression import Expression, Number, Pi
from symgen.model.expressions.names import did_you_mean
from symgen.model.expressions.walk import exact_value
from symgen.model.file.reading import description_of, entries, items, member, text_of
from symgen.model.file.scope import FRAME, PARAMETERS, Kind, Scope, a_kind
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode
from symgen.model.kinematics.fixed_angles import quarter_turns
from symgen.model.mechanism import AXES, NO_VECTOR, WORLD, ZERO, Frame, Point, Quaternion, Turn, Vector3

ONE = Number(ZERO.value + 1)
# Of the largest component of a vector: smaller ones are what computing it left of 0, as 6e-17 of a cosine.
REST_OF_ZERO = Fraction(1, 10**14)
# What other tools call the world.
GROUND = ("base", "earth", "fixed", "ground", "inertial", "origin", "base_link")
NEED_FRAME = "name the frame it belongs to, or put a frame there under `frames`"


def read_frames(scope: Scope, tree: MappingNode, joints: tuple[Frame, ...]) -> tuple[Frame, ...]:
    """The frames, those of joints among them, parents first; faulty ones are left out."""
    by_name: dict[str, Frame] = {frame.name: frame for frame in joints}
    for key, node in entries(tree.get("frames")):
        frame = _frame(scope, key, node)
        if frame is not None and scope.owns(key):
            by_name[key.value] = frame
    return parents_first(scope, by_name)


def parents_first(scope: Scope, frames: dict[str, Frame]) -> tuple[Frame, ...]:
    """The frames in an order in which each one's parent stands before it; circles are mistakes, and cut open."""
    ordered: dict[str, Frame] = {}
    for name in frames:
        line: list[str] = []
        while name in frames and name not in ordered:
            if name in line:
                circle = [*line[line.index(name) :], name]
                _report_circle(scope, frames, circle)
                frames[circle[0]] = replace(frames[circle[0]], parent=WORLD)
                break
            line.append(name)
            name = frames[name].parent
        ordered |= {one: frames[one] for one in reversed(line) if one not in ordered}
    return tuple(ordered.values())


def read_points(scope: Scope, tree: MappingNode) -> tuple[Point, ...]:
    """The named points."""
    points = []
    for key, node in entries(tree.get("points")):
        what = f"the point `{key.value}`"
        frame = frame_name(scope, member(node, "frame"), f"`frame` of {what}") or WORLD
        carrier = frame_name(scope, member(node, "moves_with"), f"`moves_with` of {what}") or frame
        at = read_vector(scope, member(node, "at"), f"the place of {what}", FRAME)
        if scope.owns(key):
            points.append(Point(key.value, frame, at or NO_VECTOR, carrier, key.span))
    return tuple(points)


def read_vector(scope: Scope, node: Node | None, what: str, allowed: frozenset[Kind]) -> Vector3 | None:
    """Three expressions; a faulty entry counts as 0 (its mistake is recorded), as does what rounding left of 0."""
    if not isinstance(node, SequenceNode) or len(node.items) != 3:
        return None
    written = [scope.expression(item, what, allowed) or ZERO for item in node.items]
    sizes = [abs(exact_value(entry) or Fraction(0)) for entry in written]
    for i, item in enumerate(node.items):
        if 0 < sizes[i] < REST_OF_ZERO * max(sizes):
            written[i] = ZERO
            message = f"`{text_of(item)}` in {what} is taken for 0, beside what it stands with"
            scope.notices.append(Notice(message, item.span))
    x, y, z = written
    return x, y, z


def read_axis(scope: Scope, node: Node | None, what: str) -> Vector3 | None:
    """x, y, z or three components."""
    if isinstance(node, SequenceNode):
        return read_vector(scope, node, what, PARAMETERS)
    name = text_of(node)
    if name is None or node is None:
        return None
    if name not in AXES:
        scope.wrong(f"{what} is `{name}`", "write x, y, z or three components such as [0, 0.6, 0.8]", node.span)
        return None
    x, y, z = (ONE if axis == name else ZERO for axis in AXES)
    return x, y, z


def frame_name(scope: Scope, node: Node | None, what: str) -> str | None:
    """The name of a declared frame, or the world."""
    name = text_of(node)
    if name is None or node is None:
        return None
    if name == WORLD or scope.kinds.get(name) == "frame":
        return name
    kind = scope.kinds.get(name)
    if kind is not None:
        remedy = NEED_FRAME if kind == "point" else "name one of `frames` or `joints`, or `world`"
        scope.wrong_about(name, f"`{name}` is {a_kind(kind)}, but {what} names a frame", remedy, node.span)
        return None
    frames = [other for other, kind in scope.kinds.items() if kind == "frame"]
    otherwise = f"did you mean `{WORLD}`?" if name.lower() in GROUND else "declare it under `frames`"
    remedy = did_you_mean(name, [WORLD, *frames], otherwise)
    scope.wrong_about(name, f"unknown frame `{name}` in {what}", remedy, node.span)
    return None


def read_rotation(scope: Scope, node: Node | None, what: str) -> tuple[Turn, ...] | Quaternion:
    """A list of turns, each `[axis, angle]`, or a quaternion."""
    quaternion = member(node, "quaternion")
    if quaternion is not None:
        parts = [scope.expression(item, f"the quaternion of {what}", FRAME) or ZERO for item in items(quaternion)]
        if len(parts) != 4:
            return ()
        return Quaternion((parts[0], parts[1], parts[2], parts[3]))
    turns = []
    for item in items(node):
        pair = items(item)
        if len(pair) != 2:
            continue
        axis = read_axis(scope, pair[0], f"the axis of a turn of {what}")
        angle = scope.expression(pair[1], f"the angle of a turn of {what}", FRAME)
        if axis is not None and angle is not None:
            turns.append(Turn(axis, _exactly(scope, angle, pair[1])))
    return tuple(turns)


def _exactly(scope: Scope, angle: Expression, node: Node) -> Expression:
    """The angle, with pi where it is a quarter turn to as many digits as were written."""
    turns = quarter_turns(angle)
    if turns is None:
        return angle
    meant = times(Number(Fraction(turns, 2), node.span), Pi(node.span))
    scope.notices.append(Notice(f"`{text_of(node)}` is taken for {turns}*pi/2", node.span))
    return meant


def _frame(scope: Scope, key: ScalarNode, node: Node) -> Frame:
    what = f"the frame `{key.value}`"
    parent = frame_name(scope, member(node, "parent"), f"`parent` of {what}") or WORLD
    translation = read_vector(scope, member(node, "translation"), f"the translation of {what}", FRAME)
    rotation = read_rotation(scope, member(node, "rotation"), what)
    return Frame(key.value, parent, translation or NO_VECTOR, rotation, description_of(node), key.span)


def _report_circle(scope: Scope, frames: dict[str, Frame], circle: list[str]) -> None:
    way = " -> ".join(circle)
    message = f"the frame `{circle[0]}` hangs on itself: {way}"
    remedy = "every frame descends from `world`; take a parent out and close the loop under `loops`"
    scope.wrong(message, remedy, frames[circle[0]].span)
