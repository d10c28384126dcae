"""Reading the short form of joints: each becomes a frame, and coordinates that need no further declaration."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isqrt

from symgen.diagnostics import Span
from symgen.model.blocks.frames import frame_name, read_axis, read_rotation, read_vector
from symgen.model.expressions.combine import divided, minus, plus, times
from symgen.model.expressions.expression import Call, Expression, Name, Number, Power
from symgen.model.expressions.walk import evaluate, exact_value
from symgen.model.file.reading import description_of, entries, items, member, text_of
from symgen.model.file.scope import FRAME, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.mechanism import NO_VECTOR, WORLD, ZERO, Frame, Quaternion, Turn, Vector3
from symgen.model.model import ConstraintRow
from symgen.records import dataclass

ONE = Number(Fraction(1))
Z_AXIS: Vector3 = (ZERO, ZERO, ONE)
# units of the coordinates, in order: lengths first, then angles or the parts of a quaternion
JOINTS: dict[str, tuple[str | None, ...]] = {
    "revolute": ("rad",),
    "prismatic": ("m",),
    "cylindrical": ("m", "rad"),
    "planar": ("m", "m", "rad"),
    "spherical": (None, None, None, None),
    "floating": ("m", "m", "m", None, None, None, None),
}


@dataclass(frozen=True, slots=True)
class JointCoordinate:
    """A coordinate that a joint brings along."""

    name: str
    unit: str | None
    description: str
    start: Fraction | None
    span: Span


@dataclass(frozen=True, slots=True)
class JointForms:
    """What the joints stand for; `rows` hold the quaternions at length 1."""

    frames: tuple[Frame, ...]
    coordinates: tuple[JointCoordinate, ...]
    rows: tuple[ConstraintRow, ...]


def declare_joints(scope: Scope, tree: MappingNode) -> tuple[JointCoordinate, ...]:
    """Enters the frames of the joints, and those of their coordinates that are not declared elsewhere."""
    coordinates = []
    moving: dict[str, ScalarNode] = {}
    for key, node in entries(tree.get("joints")):
        child = member(node, "child")
        scope.declare(child if isinstance(child, ScalarNode) else key, "frame")
        units = JOINTS.get(text_of(member(node, "type")) or "", ())
        named = _coordinates(node)
        for moved in (key.value, text_of(member(node, "child")) or key.value):
            scope.moved_by[moved] = tuple(item.value for item in named)
        if units and len(named) != len(units):
            message = f"the joint `{key.value}` has {len(named)} coordinates, {len(units)} are due"
            remedy = "give `coordinate: name`, or `coordinates: [...]`: lengths first, then the angle or the quaternion"
            scope.wrong_about(key.value, message, remedy, key.span)
        if len(named) != len(units):
            scope.attempted |= {item.value for item in named}
        for position, (item, unit) in enumerate(zip(named, units, strict=False)):
            if item.value in moving:
                _moved_twice(scope, item, key, moving[item.value])
                scope.attempted.add(key.value)
                continue
            moving[item.value] = key
            if scope.kinds.get(item.value) == "coordinate":
                continue
            if scope.declare(item, "coordinate"):
                # a quaternion starts at the attitude 1, because 0 is none
                start = Fraction(int(position == len(units) - 4)) if unit is None else None
                coordinates.append(JointCoordinate(item.value, unit, f"of {key.value}", start, item.span))
    return tuple(coordinates)


def _moved_twice(scope: Scope, item: ScalarNode, joint: ScalarNode, other: ScalarNode) -> None:
    name = item.value
    if other is joint:
        scope.wrong(f"`{name}` stands twice in the joint `{joint.value}`", "name each coordinate once", item.span)
        return
    scope.wrong(
        f"`{name}` is a coordinate of the joint `{other.value}` (line {other.span.line}) already",
        f"give `{joint.value}` a coordinate of its own; joints that move together are coupled by a row under "
        "`constraints`, or by a frame with the other's coordinate in its `rotation` or `translation`",
        item.span,
    )


def read_joints(
    scope: Scope, tree: MappingNode, coordinates: tuple[JointCoordinate, ...], defaults: Mapping[str, float]
) -> JointForms:
    """The frames of the joints, and the rows of their quaternions; `defaults` are the values of the parameters."""
    frames: list[Frame] = []
    rows: list[ConstraintRow] = []
    for key, node in entries(tree.get("joints")):
        what = f"the joint `{key.value}`"
        kind = text_of(member(node, "type")) or ""
        names: list[Expression] = [Name(item.value, item.span) for item in _coordinates(node)]
        parent = frame_name(scope, member(node, "parent"), f"`parent` of {what}") or WORLD
        at = read_vector(scope, member(node, "at"), f"the place of {what}", FRAME) or NO_VECTOR
        axis = _axis(scope, member(node, "axis"), what, defaults)
        fixed = read_rotation(scope, member(node, "rotation"), what)
        child = text_of(member(node, "child")) or key.value
        # mistakes that have been reported: the frame stays, at rest, for those that hang on it
        if isinstance(fixed, Quaternion):
            fixed = ()
        good = kind in JOINTS and len(names) == len(JOINTS[kind]) and key.value not in scope.attempted
        if not good or not _all_coordinates(scope, node):
            frames.append(Frame(child, parent, at, fixed, "", key.span))
            continue
        shift, rotation = _motion(kind, names, axis)
        base = Frame(f"{child}.base", parent, at, fixed, "", key.span)
        description = description_of(node)
        if not fixed:
            frames.append(Frame(child, parent, _sum(at, shift), rotation, description, key.span))
        elif isinstance(rotation, tuple) and all(part == ZERO for part in shift):
            frames.append(Frame(child, parent, at, (*fixed, *rotation), description, key.span))
        else:
            frames += [base, Frame(child, base.name, shift, rotation, description, key.span)]
        if isinstance(rotation, Quaternion):
            row = f"{key.value}_norm"
            scope.kinds.setdefault(row, "constraint row")
            scope.kinds.setdefault(f"multiplier_{row}", "multiplier")
            rows.append(ConstraintRow(row, "geometric", _length(rotation), key.span))
    return JointForms(tuple(frames), coordinates, tuple(rows))


def _coordinates(node: Node) -> list[ScalarNode]:
    single = member(node, "coordinate")
    given = (single,) if single is not None else items(member(node, "coordinates"))
    return [item for item in given if isinstance(item, ScalarNode)]


def _all_coordinates(scope: Scope, node: Node) -> bool:
    return all(scope.kinds.get(item.value) == "coordinate" for item in _coordinates(node))


def _motion(kind: str, names: list[Expression], axis: Vector3) -> tuple[Vector3, tuple[Turn, ...] | Quaternion]:
    """What the joint moves along and turns by, in the axes after its fixed turns."""
    match kind:
        case "revolute":
            return NO_VECTOR, (Turn(axis, names[0]),)
        case "prismatic":
            return _along(axis, names[0]), ()
        case "cylindrical":
            return _along(axis, names[0]), (Turn(axis, names[1]),)
        case "planar":
            return (names[0], names[1], ZERO), (Turn(Z_AXIS, names[2]),)
        case "spherical":
            return NO_VECTOR, Quaternion((names[0], names[1], names[2], names[3]))
        case _:
            return (names[0], names[1], names[2]), Quaternion((names[3], names[4], names[5], names[6]))


def _axis(scope: Scope, node: Node | None, what: str, defaults: Mapping[str, float]) -> Vector3:
    """The axis as it is written, of any length but zero."""
    axis = read_axis(scope, node, f"the axis of {what}") or Z_AXIS
    try:
        vanishes = not any(evaluate(entry, defaults) for entry in axis)
    except (ArithmeticError, ValueError, KeyError):
        # a mistake in an entry, which is told where it stands
        return axis
    if not vanishes:
        return axis
    remedy = "give its direction, such as z or [0, 0.6, 0.8]; its length does not matter"
    scope.wrong(f"the axis of {what} has length zero", remedy, None if node is None else node.span)
    return Z_AXIS


def _along(axis: Vector3, way: Expression) -> Vector3:
    """The way along the axis, whose length does not matter."""
    squares: Expression = ZERO
    for entry in axis:
        squares = plus(squares, Power(entry, Fraction(2)))
    exact = [exact_value(entry) for entry in axis]
    length: Expression = Call("sqrt", (squares,))
    if None not in exact:
        square = sum((value * value for value in exact if value is not None), Fraction(0))
        root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
        length = Number(root) if root * root == square else Call("sqrt", (Number(square),))
    x, y, z = (times(divided(entry, length), way) for entry in axis)
    return x, y, z


def _sum(left: Vector3, right: Vector3) -> Vector3:
    return plus(left[0], right[0]), plus(left[1], right[1]), plus(left[2], right[2])


def _length(quaternion: Quaternion) -> Expression:
    total: Expression = ZERO
    for part in quaternion.parts:
        total = plus(total, Power(part, Fraction(2)))
    return minus(total, ONE)
