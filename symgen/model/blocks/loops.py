"""Reading loops and rolling wheels: constraint rows between points and frames."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Literal

from symgen.model.blocks.frames import NEED_FRAME, frame_name
from symgen.model.blocks.inputs import point_name, squared_distance
from symgen.model.blocks.lengths import check_length
from symgen.model.expressions.combine import divided, minus, negated, plus, times
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Number, Power
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.file.declarations import enter_row
from symgen.model.file.reading import entries, items, member, text_of
from symgen.model.file.scope import PARAMETERS, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.kinematics.formulas import ExpressionArithmetic, ExpressionNumber, Form
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import AXES, PLACES, WORLD, ZERO, Component, Mechanism, component, is_component
from symgen.model.model import ConstraintRow, Coordinate, Definition

# What each full joint holds: offsets along the axis, offsets across it, tilts of the axis, the turn about it.  A point
# or a spherical joint holds the three offsets, in the axes of the world.
JOINED: dict[str, tuple[bool, bool, bool, bool]] = {
    "revolute": (True, True, True, False),
    "prismatic": (False, True, True, True),
    "cylindrical": (False, True, True, False),
    "planar": (True, False, True, False),
    "fixed": (True, True, True, True),
}
OF_POINTS = ("point", "distance")
LOOPS = (*OF_POINTS, "spherical", *JOINED)
ONE = Number(Fraction(1))
# The exponent of a square.
POWER_TWO = Fraction(2)


class LoopRows:
    """Rows of loops and wheels, without those that hold in every configuration of a plane mechanism."""

    def __init__(
        self,
        scope: Scope,
        mechanism: Mechanism,
        coordinates: tuple[Coordinate, ...],
        known: tuple[Definition, ...],
        defaults: Mapping[str, float],
    ) -> None:
        self._scope, self._defaults = scope, defaults
        self._formulas = ExpressionArithmetic(coordinates, {definition.name: definition.value for definition in known})
        self._kinematics: Kinematics[ExpressionNumber, Form] = Kinematics(mechanism, self._formulas)

    def of_loops(self, tree: MappingNode) -> Iterator[ConstraintRow]:
        """The rows that close the loops."""
        for key, node in entries(tree.get("loops")):
            what = f"the loop `{key.value}`"
            kind = text_of(member(node, "type"))
            if kind not in LOOPS:
                continue
            between = items(member(node, "between"))
            if kind not in OF_POINTS and self._are_points(between, kind, what):
                continue
            owner_of = point_name if kind in OF_POINTS else frame_name
            owners = [owner_of(self._scope, item, f"`between` of {what}") for item in between]
            known = [owner for owner in owners if owner is not None]
            if len(known) != 2:
                continue
            if known[0] == known[1]:
                remedy = "name two different ones; the second is what the first is attached to"
                self._scope.wrong(f"{what} joins `{known[0]}` with itself", remedy, between[1].span)
                continue
            yield from self._named(key, self._closing(kind, known[0], known[1], node, what))

    def _are_points(self, between: Iterable[Node], kind: str, what: str) -> bool:
        """Whether points stand where a joint has frames, which is a mistake with a remedy of its own."""
        points = [item for item in between if self._scope.kinds.get(text_of(item) or "") == "point"]
        if not points:
            return False
        named = " and ".join(f"`{text_of(item)}`" for item in points)
        remedy = "write `type: point`: two points meet, which is what a spherical joint holds"
        if kind != "spherical":
            remedy = f"points meet with `type: point`; a {kind} joint holds directions too: {NEED_FRAME}"
        said = f"{named} {'is a point' if len(points) == 1 else 'are points'}, but {what} of type {kind} joins frames"
        self._scope.wrong(said, remedy, points[0].span)
        return True

    def of_wheels(self, tree: MappingNode) -> Iterator[ConstraintRow]:
        """The rows of wheels that roll on the plane z = 0 of the world."""
        for key, node in entries(tree.get("rolling")):
            what = f"the wheel `{key.value}`"
            frame = frame_name(self._scope, member(node, "frame"), f"`frame` of {what}")
            radius = self._scope.expression(member(node, "radius"), f"the radius of {what}", PARAMETERS)
            remedy = "write its size; which way the wheel turns is said by the axis of its joint"
            check_length(
                self._scope, member(node, "radius"), radius, self._defaults, f"the radius of {what}", remedy
            )
            if frame is not None and radius is not None and frame in self._kinematics.frames:
                axle = _main_axis(text_of(member(node, "axle")), 1)
                yield from self._named(key, self._rolling(frame, radius, axle), ("along", "across"))

    def _closing(
        self, kind: str, one: str, other: str, node: Node, what: str
    ) -> Iterator[tuple[str, Expression]]:
        if kind == "distance":
            length = self._scope.expression(member(node, "length"), f"the length of {what}", PARAMETERS)
            if member(node, "length") is None:
                self._scope.wrong(f"{what} has no `length`", "add `length`, the distance of the points", node.span)
            remedy = "write its size; points that meet are joined with `type: point`"
            check_length(self._scope, member(node, "length"), length, self._defaults, f"the length of {what}", remedy)
            if length is not None:
                yield "length", minus(squared_distance(one, other, self._meeting(one, other)), Power(length, POWER_TWO))
            return
        axis = _main_axis(text_of(member(node, "axis")), 2)
        across = [index for index in range(3) if index != axis]
        along, beside, tilted, turned = JOINED.get(kind, (True, True, False, False))
        # a joint that holds every offset holds them in any axes
        axes = self._meeting(one, other) if along and beside else other
        for index in range(3):
            if beside if index in across else along:
                here, there = (Name(Component(owner, PLACES[index], axes).name) for owner in (one, other))
                yield PLACES[index], minus(here, there)
        # the axis of one, seen from the other, has no components across it
        for row in across if tilted else ():
            yield f"tilt_{AXES[row]}", Name(Component(one, f"r{row + 1}{axis + 1}", other).name)
        if turned:
            yield "turn", Name(Component(one, f"r{across[0] + 1}{across[1] + 1}", other).name)

    def _meeting(self, one: str, other: str) -> str:
        """The frame that carries both sides of a loop.

        In its axes rows know nothing of how it moves itself, and none is left across a plane in which they move.
        """
        points = self._kinematics.points
        return self._kinematics.meeting(*(points[owner].frame if owner in points else owner for owner in (one, other)))

    def _rolling(self, frame: str, radius: Expression, axle: int) -> Iterator[tuple[str, Expression]]:
        """No slip where the wheel touches the plane, and the height of its centre where that can change.

        The lowest point lies at -R (n - (n.a) a) / |n - (n.a) a| from the centre, with the axle a and the normal n.
        """
        column = axle + 1
        parent = self._kinematics.frames[frame].parent
        upright = self._zero(Component(frame, f"r3{column}").name)
        level = self._value(Component(parent, "r33").name) if parent != WORLD else ONE
        axes = parent if upright and exact_value(level) == 1 else WORLD

        def rate(what: str) -> Expression:
            return Name(Component(frame, what, axes).name)

        if upright:
            yield "along", minus(rate("vx"), _scaled(radius, rate("wy")))
            yield "across", plus(rate("vy"), _scaled(radius, rate("wx")))
            if self._formulas.rate(self._value(Component(frame, "z").name)):
                yield "height", minus(Name(f"{frame}.z"), radius)
            return
        # the spin does not show in the axes of what carries the wheel
        still = parent != WORLD and exact_value(self._value(Component(frame, f"r{column}{column}", parent).name)) == 1
        carrier = parent if still else frame
        one, other = (axle + 1) % 3, (axle + 2) % 3
        up_one, up_other = (self._entry(carrier, 2, index) for index in (one, other))
        side = Call("sqrt", (plus(Power(up_one, POWER_TWO), Power(up_other, POWER_TWO)),))
        arm_one, arm_other = (negated(_scaled(radius, divided(up, side))) for up in (up_one, up_other))
        spin, turn_one, turn_other = (Name(Component(frame, f"w{AXES[k]}", carrier).name) for k in (axle, one, other))
        # what turning adds to the velocity of the centre: the cross product with the arm
        added = {
            axle: minus(times(turn_one, arm_other), times(turn_other, arm_one)),
            one: negated(times(spin, arm_other)),
            other: times(spin, arm_one),
        }
        for row, name in enumerate(("along", "across")):
            slip: Expression = Name(f"{frame}.v{AXES[row]}")
            for index, value in added.items():
                slip = plus(slip, times(self._entry(carrier, row, index), value))
            yield name, slip
        yield "height", minus(Name(f"{frame}.z"), _scaled(radius, side))

    def _entry(self, frame: str, row: int, column: int) -> Expression:
        """An entry of the attitude of a frame in the world; zero where it is zero in every configuration."""
        name = Component(frame, f"r{row + 1}{column + 1}").name
        return ZERO if self._zero(name) else Name(name)

    def _named(
        self, key: ScalarNode, rows: Iterable[tuple[str, Expression]], of_rates: tuple[str, ...] = ()
    ) -> Iterator[ConstraintRow]:
        for suffix, expression in rows:
            if not self._zero_row(expression):
                name = f"{key.value}_{suffix}"
                enter_row(self._scope, name, key.span)
                kind: Literal["geometric", "nonholonomic"] = "nonholonomic" if suffix in of_rates else "geometric"
                yield ConstraintRow(name, kind, expression, key.span)

    def _zero_row(self, expression: Expression) -> bool:
        """Whether a row vanishes because each of its components does, or cancels as it stands."""
        names = [name.name for name in names_in(expression) if is_component(name.name)]
        if not names:
            return False
        values = {name: self._value(name) for name in names}
        if all(exact_value(value) == 0 for value in values.values()):
            return True
        return len(names) == 2 and values[names[0]] == values[names[1]] and expression == minus(
            Name(names[0]), Name(names[1])
        )

    def _zero(self, name: str) -> bool:
        return exact_value(self._value(name)) == 0

    def _value(self, name: str) -> Expression:
        one = component(name)
        if one.is_rate:
            return ZERO if not self._kinematics.component_rate(one) else Name(name)
        return self._kinematics.component(one).expression


def _main_axis(name: str | None, usual: int) -> int:
    return next((index for index, axis in enumerate(AXES) if axis == name), usual)


def _scaled(length: Expression, other: Expression) -> Expression:
    """The product as it stands: a length of 1 is one of the product's units all the same."""
    return Binary("*", length, other)
