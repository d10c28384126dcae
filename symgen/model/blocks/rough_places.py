"""Reading friction that grows with a reaction: pins and guides of joints and loops, and rows of constraints by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

from symgen.model.blocks.elements import Fit, is_rough
from symgen.model.blocks.lengths import check_length
from symgen.model.expressions.combine import minus
from symgen.model.expressions.expression import Expression, Name, Number
from symgen.model.expressions.names import did_you_mean
from symgen.model.file.reading import entries, items, member, text_of
from symgen.model.file.scope import PARAMETERS, STATE, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.kinematics.joints import main_axis
from symgen.model.mechanism import AXES, TURNING_RATES, VELOCITIES, WORLD, Component, Mechanism, Quaternion
from symgen.model.model import ConstraintRow, ReleasedJoint, RoughPlace
from symgen.records import dataclass

ONE = Number(Fraction(1))
# What says how large friction of a reaction is, beside what it works on.
SIZES = ("coulomb", "radius", "width")
WHEEL = "name `reaction: [{}]`, the rows of the wheel, its `rate`, and as `load` what it carries of the weight"


@dataclass(frozen=True, slots=True)
class RoughPlaces:
    """What `friction` says of reactions: the places, the joints that are let go for them, units to be checked."""

    places: tuple[RoughPlace, ...] = ()
    released: tuple[ReleasedJoint, ...] = ()
    fits: tuple[Fit, ...] = ()


@dataclass(frozen=True, slots=True)
class _Bearing:
    """What a place carries, and the rate that friction works on there; a pin has a radius."""

    velocity: Expression
    pin: bool
    rows: tuple[str, ...] = ()
    joint: ReleasedJoint | None = None


def read_rough_places(
    scope: Scope,
    tree: MappingNode,
    mechanism: Mechanism,
    rows: tuple[ConstraintRow, ...],
    defaults: Mapping[str, float],
) -> RoughPlaces:
    """The places whose friction grows with what they carry."""
    reader = _RoughReader(scope, tree, mechanism, [row.name for row in rows])
    places: list[RoughPlace] = []
    released: list[ReleasedJoint] = []
    fits: list[Fit] = []
    for key, node in entries(tree.get("friction")):
        if not is_rough(scope, tree, key, node):
            continue
        bearing = reader.bearing(key, node)
        if bearing is None:
            continue
        coefficient, radius, width = (_size(scope, key, node, part, bearing, defaults) for part in SIZES)
        if coefficient is None or radius is None or width is None:
            continue
        joint = bearing.joint
        further = () if joint is None else tuple(name for name, _ in joint.coordinates)
        released += () if joint is None else (joint,)
        load = scope.expression(member(node, "load"), f"`load` of the friction of `{key.value}`", PARAMETERS)
        carried = (bearing.velocity, bearing.rows, further, load)
        place = RoughPlace(key.value, coefficient, radius, width, *carried, key.span)
        places.append(place)
        fits.append(Fit(width, bearing.velocity, -1, False, f"`width` of the friction of `{key.value}`"))
    return RoughPlaces(tuple(places), tuple(released), tuple(fits))


def _size(
    scope: Scope, key: ScalarNode, node: Node, part: str, bearing: _Bearing, defaults: Mapping[str, float]
) -> Expression | None:
    """One of the numbers of a place, whose default is positive; a mistake where there is none."""
    what, given = f"`{part}` of the friction of `{key.value}`", member(node, part)
    if part == "radius" and not bearing.pin:
        if given is None:
            return ONE
        scope.wrong(f"{what} is that of a guide", "leave it out: what slides has no radius", given.span)
        return None
    if given is None:
        remedy = {
            "coulomb": "add `coulomb`: the coefficient of friction, such as 0.1",
            "radius": "add `radius`: that of the pin, on which friction acts",
            "width": "add `width`: the rate at which dry friction has 76 % of its full size, such as 0.01",
        }[part]
        scope.wrong(f"the friction of `{key.value}` has no `{part}`", remedy, key.span)
        return None
    value = scope.expression(given, what, PARAMETERS)
    remedy = "write its size; which way friction acts is said by the rate"
    check_length(scope, given, value, defaults, what, remedy, or_zero=part != "width")
    return value


class _RoughReader:
    """What entries are about."""

    def __init__(self, scope: Scope, tree: MappingNode, mechanism: Mechanism, rows: list[str]) -> None:
        self._scope, self._tree, self._rows = scope, tree, rows
        self._mechanism = mechanism
        self._frames = {frame.name: frame for frame in mechanism.frames}
        self._joints = {key.value: node for key, node in entries(tree.get("joints"))}
        self._loops = {key.value: node for key, node in entries(tree.get("loops"))}

    def bearing(self, key: ScalarNode, node: Node) -> _Bearing | None:
        """What an entry carries; None after a mistake."""
        viscous = member(node, "viscous")
        if viscous is not None:
            remedy = "write it in an entry of the coordinate: it does not grow with a reaction"
            self._scope.wrong(f"`viscous` stands beside the reaction of `{key.value}`", remedy, viscous.span)
            return None
        if member(node, "reaction") is not None:
            return self._of_rows(key, node)
        rate = member(node, "rate")
        if rate is not None:
            remedy = "leave it out: it is that of the joint or loop"
            self._scope.wrong(f"`rate` of the friction of `{key.value}` needs a `reaction`", remedy, rate.span)
            return None
        if key.value in self._joints:
            return self._of_joint(key, self._joints[key.value])
        return self._of_loop(key, self._loops[key.value])

    def _of_rows(self, key: ScalarNode, node: Node) -> _Bearing | None:
        """The multipliers of named rows, and a rate that the file writes."""
        rate = self._scope.expression(member(node, "rate"), f"the rate of the friction of `{key.value}`", STATE)
        if member(node, "rate") is None:
            remedy = "add `rate`: how fast the pin turns, or the guide slides, such as beta_dot"
            self._scope.wrong(f"the friction of `{key.value}` has no `rate`", remedy, key.span)
            return None
        names: list[str] = []
        for item in items(member(node, "reaction")):
            name = text_of(item) or ""
            if name not in self._rows:
                remedy = did_you_mean(name, self._rows, "name rows under `constraints`")
                self._scope.wrong_about(name, f"`{name}` in `reaction` is no constraint row", remedy, item.span)
                return None
            names.append(name)
        return None if rate is None else _Bearing(rate, member(node, "radius") is not None, tuple(names))

    def _of_joint(self, key: ScalarNode, node: Node) -> _Bearing | None:
        kind, child = text_of(member(node, "type")) or "", text_of(member(node, "child")) or key.value
        frame, moving = self._frames.get(child), self._scope.moved_by.get(key.value, ())
        if kind not in ("revolute", "prismatic"):
            return self._not_made(key, f"a {kind} joint", "revolute and prismatic joints have one rate to rub along")
        if frame is None or isinstance(frame.rotation, Quaternion) or len(moving) != 1:
            return None  # a mistake in the joint, which is told there
        turns = 1 if kind == "revolute" else 0
        axis = main_axis(frame.rotation[-1].axis) if turns else _written_axis(member(node, "axis"))
        if axis is None:
            remedy = "turn the frame with `rotation`, so that the axis of the joint is x, y or z"
            return self._not_made(key, "a joint about an oblique axis", remedy)
        if wheel := next(self._wheels_without_load(child), None):
            what = f"what carries the wheel `{wheel}`, whose load no row knows,"
            rows = (row for row in self._rows if row in (f"{wheel}_along", f"{wheel}_across"))
            return self._not_made(key, what, WHEEL.format(", ".join(rows)))
        written = text_of(self._tree.get("kinetic_energy"))
        if not self._mechanism.bodies or (written or "0").strip() != "0":
            remedy = "describe what has mass under `bodies`: what a joint carries is not in an energy"
            return self._not_made(key, "a joint beside a `kinetic_energy`", remedy)
        across = [index for index in range(3) if index != axis[0]]
        further = tuple((self._free(f"{child}_held_{AXES[index]}"), index) for index in across)
        return _Bearing(Name(f"{moving[0]}_dot"), bool(turns), (), ReleasedJoint(child, further, turns))

    def _of_loop(self, key: ScalarNode, node: Node) -> _Bearing | None:
        kind, axis = text_of(member(node, "type")) or "", text_of(member(node, "axis"))
        owners = [text_of(item) or "" for item in items(member(node, "between"))]
        known = {*self._frames, WORLD, *(point.name for point in self._mechanism.points)}
        if len(owners) != 2 or not known.issuperset(owners):
            return None  # a mistake in the loop, which is told there
        mine = [row for row in self._rows if row.startswith(f"{key.value}_")]
        held = [index for index in range(3) if f"{key.value}_{AXES[index]}" in mine]
        frames = [self._frame_of(owner) for owner in owners]
        if kind == "prismatic":
            along = AXES.index(axis) if axis in AXES else 2
            velocity = _difference(owners, VELOCITIES[along], owners[1])
            return _Bearing(velocity, False, tuple(f"{key.value}_{AXES[index]}" for index in held))
        if kind not in ("point", "revolute"):
            return self._not_made(key, f"a loop of type {kind}", "pins of type point or revolute, and prismatic guides")
        normal = [index for index in range(3) if index not in held]
        tilts = any(row.startswith(f"{key.value}_tilt") for row in mine)
        if len(normal) != 1 or tilts or (kind == "revolute" and (axis or "z") != AXES[normal[0]]):
            remedy = f"close the loop elsewhere, so that `{key.value}` is a joint of the tree, under `joints`"
            return self._not_made(key, "a loop in space", remedy)
        velocity = _difference(frames, TURNING_RATES[normal[0]], self._meeting(*frames))
        return _Bearing(velocity, True, tuple(f"{key.value}_{AXES[index]}" for index in held))

    def _not_made(self, key: ScalarNode, what: str, remedy: str) -> _Bearing | None:
        self._scope.wrong(f"friction of the reaction of {what} is not made: `{key.value}`", remedy, key.span)
        return None

    def _frame_of(self, owner: str) -> str:
        points = {point.name: point.frame for point in self._mechanism.points}
        return points.get(owner, owner)

    def _wheels_without_load(self, frame: str) -> Iterator[str]:
        """The wheels at a frame or beyond it that have no row for their height, and so none for their load."""
        for key, node in entries(self._tree.get("rolling")):
            line = self._lineage(text_of(member(node, "frame")) or WORLD)
            if frame in line and f"{key.value}_height" not in self._rows:
                yield key.value

    def _meeting(self, one: str, other: str) -> str:
        """The nearest frame that both hang on, in whose axes the rows of the loop are."""
        line = list(self._lineage(one))
        return next((frame for frame in self._lineage(other) if frame in line), WORLD)

    def _lineage(self, frame: str) -> Iterator[str]:
        """The frame and those that it hangs on; frames that hang on themselves are cut open before."""
        while frame in self._frames:
            yield frame
            frame = self._frames[frame].parent

    def _free(self, name: str) -> str:
        """The name, with an ending where something else has it."""
        while {name, f"{name}_dot", f"{name}_ddot"} & self._scope.kinds.keys():
            name += "_"
        return name


def _difference(owners: Iterable[str], what: str, axes: str) -> Expression:
    """A component of one owner's motion against the other's, in given axes; the world does not move."""
    one, other = owners
    if one == WORLD:
        return minus(Number(Fraction(0)), Name(Component(other, what, axes).name))
    first = Name(Component(one, what, axes).name)
    return first if other == WORLD else minus(first, Name(Component(other, what, axes).name))


def _written_axis(node: Node | None) -> tuple[int, int] | None:
    """The main axis that is written as x, y, z, or as three numbers; z where none is."""
    name = text_of(node) or "z"
    if node is None or name in AXES:
        return next(index for index, axis in enumerate(AXES) if axis == name), 1
    numbers = [text_of(item) or "" for item in items(node)]
    along = [index for index, number in enumerate(numbers) if number.strip("+- ") == "1"]
    others = [number for number in numbers if number.strip("+- ") == "0"]
    return (along[0], 1) if len(numbers) == 3 and len(along) == 1 and len(others) == 2 else None
