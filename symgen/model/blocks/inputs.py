"""Reading inputs: what each force or torque acts on, given by coordinates, a joint, points, frames or a cable."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from symgen.model.blocks.frames import frame_name, read_vector
from symgen.model.expressions.combine import minus, plus, times
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Number, Power
from symgen.model.expressions.names import did_you_mean
from symgen.model.file.declarations import is_coordinate
from symgen.model.file.reading import description_of, entries, items, key_span, member, text_of
from symgen.model.file.scope import CONFIGURATION, Scope, a_kind
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.mechanism import PLACES, TURNING_RATES, VELOCITIES, WORLD, ZERO, Component, Vector3
from symgen.model.model import Input

FORCES = ("point", "torque_on", "cable")
ACTIONS = ("acts_on", "joint", *FORCES)
ONE = Number(ZERO.value + 1)


def read_inputs(scope: Scope, tree: MappingNode) -> tuple[Input, ...]:
    """The inputs with their columns of the control matrix, or the rates they work on."""
    inputs: list[Input] = []
    for key, node in entries(tree.get("inputs")):
        unit = text_of(member(node, "unit"))
        action = chosen_action(scope, key, node, ACTIONS)
        column: tuple[tuple[str, Expression], ...] = ()
        velocity = None
        if action == "acts_on":
            column = _column(scope, key, member(node, "acts_on"))
        elif action == "joint":
            joint = member(node, "joint")
            if isinstance(joint, ScalarNode) and is_coordinate(scope, joint, f"`joint` of `{key.value}`"):
                column = ((joint.value, ONE),)
        elif action is not None:
            velocity = working_rate(scope, node, action, f"`{key.value}`")
        if scope.owns(key):
            inputs.append(Input(key.value, unit, description_of(node), column, key.span, velocity))
    return tuple(inputs)


def working_rate(scope: Scope, node: Node, action: str, what: str) -> Expression | None:
    """The rate that a unit force of that action works on; None where it cannot be read."""
    if action == "cable":
        owners = [point_name(scope, item, f"`cable` of {what}") for item in items(member(node, "cable"))]
        known = [owner for owner in owners if owner is not None]
        return shortening(known) if len(known) == len(owners) > 1 else None
    direction = read_vector(scope, member(node, "direction"), f"the direction of {what}", CONFIGURATION)
    axes = frame_name(scope, member(node, "axes"), f"`axes` of {what}") or WORLD
    owners_of = frame_name if action == "torque_on" else point_name
    owner = owners_of(scope, member(node, action), f"`{action}` of {what}")
    reaction_node = member(node, "reaction")
    reaction = None if reaction_node is None else owners_of(scope, reaction_node, f"`reaction` of {what}")
    if owner is None or direction is None or (reaction_node is not None and reaction is None):
        return None
    components = TURNING_RATES if action == "torque_on" else VELOCITIES
    rate = along(direction, owner, components, axes)
    return rate if reaction in (None, WORLD) else minus(rate, along(direction, reaction, components, axes))


def point_name(scope: Scope, node: Node | None, what: str) -> str | None:
    """The name of a declared point, or of a frame or the world for its origin."""
    name = text_of(node)
    if name is None or node is None:
        return None
    if name == WORLD:
        return name
    if scope.kinds.get(name) in ("point", "frame"):
        scope.used.add(name)
        return name
    kind = scope.kinds.get(name)
    if kind is not None:
        remedy = "name one of `points`, or a frame for its origin"
        scope.wrong_about(name, f"`{name}` is {a_kind(kind)}, but {what} names a point", remedy, node.span)
        return None
    points = [other for other, kind in scope.kinds.items() if kind in ("point", "frame")]
    remedy = did_you_mean(name, points, "declare it under `points`")
    scope.wrong_about(name, f"unknown point `{name}` in {what}", remedy, node.span)
    return None


def along(direction: Vector3, owner: str, components: Sequence[str], axes: str) -> Expression:
    """direction . components of the owner."""
    total: Expression = ZERO
    for factor, what in zip(direction, components, strict=True):
        total = plus(total, times(factor, Name(Component(owner, what, axes).name)))
    return total


def shortening(points: Sequence[str]) -> Expression:
    """The rate at which a cable through the points gets shorter."""
    total: Expression = ZERO
    for one, other in pairwise(points):
        stretch: Expression = ZERO
        for place, velocity in zip(PLACES, VELOCITIES, strict=True):
            stretch = plus(stretch, Binary("*", difference(one, other, place), difference(one, other, velocity)))
        total = minus(total, Binary("/", stretch, distance(one, other)))
    return total


def distance(one: str, other: str) -> Expression:
    """The distance of two points."""
    return Call("sqrt", (squared_distance(one, other),))


def squared_distance(one: str, other: str, axes: str = WORLD) -> Expression:
    """Its square, by components in some frame's axes."""
    total: Expression = ZERO
    for place in PLACES:
        total = plus(total, Power(difference(one, other, place, axes), ONE.value * 2))
    return total


def difference(one: str, other: str, what: str, axes: str = WORLD) -> Expression:
    """The component of `other` minus that of `one`."""
    return Binary("-", Name(Component(other, what, axes).name), Name(Component(one, what, axes).name))


def chosen_action(scope: Scope, key: ScalarNode, node: Node, actions: Sequence[str]) -> str | None:
    """The one key that says what the input acts on."""
    given = [action for action in actions if member(node, action) is not None]
    listed = ", ".join(f"`{action}`" for action in actions[:-1])
    if not given:
        remedy = f"give one of {listed} or `{actions[-1]}`"
        scope.wrong_about(key.value, f"`{key.value}` acts on nothing", remedy, key.span)
        return None
    if len(given) > 1:
        span = key_span(node, given[1]) if isinstance(node, MappingNode) else key.span
        scope.wrong(f"`{key.value}` has both `{given[0]}` and `{given[1]}`", "keep one of them", span)
        return None
    if given[0] in ("point", "torque_on") and member(node, "direction") is None:
        remedy = "add `direction: [x, y, z]`, a unit vector in the axes of the world or of `axes`"
        scope.wrong(f"`{key.value}` has no `direction`", remedy, key.span)
        return None
    return given[0]


def _column(scope: Scope, key: ScalarNode, node: Node | None) -> tuple[tuple[str, Expression], ...]:
    column: list[tuple[str, Expression]] = []
    for target, coefficient in entries(node):
        if is_coordinate(scope, target, f"`acts_on` of `{key.value}`"):
            where = f"the coefficient of `{key.value}` on `{target.value}`"
            expression = scope.expression(coefficient, where, CONFIGURATION)
            if expression is not None:
                column.append((target.value, expression))
    return tuple(column)
