"""What is drawn of a machine: strokes, discs and labels in the plane of the picture, the far ones first.

A link is a bar between its two places, or the hull of more; driven joints are filled.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from symgen.drawing.forces import DrawnForce, drawn_forces
from symgen.drawing.lengths import drawn_lengths
from symgen.drawing.links import LinkPlaces
from symgen.drawing.pose import NEXT_TO_NOTHING, DrawnJoint, MachinePose, Place
from symgen.drawing.view import Flat, View, view_of
from symgen.model.expressions.walk import evaluate
from symgen.model.kinematics.triples import cross, inner
from symgen.model.mechanism import WORLD

Role: TypeAlias = Literal["link", "base", "tie", "spring", "cable", "rail", "wheel", "tyre", "axis", "force"]
Mark: TypeAlias = Literal["ground", "guide", "joint", "driven", "slider", "driven slider", "ball", "pin", "point"]
# Sides of the polygon that stands for a circle.
ROUND = 48
# Directions of links that add up to less are balanced.
BALANCED = 0.3
# Of the machine's size: axes of the world, arrows of forces, and how far a spring's zigzags reach; how many these are.
AXIS_LENGTH, ARROW_LENGTH, ZIGZAG, ZIGZAGS = 0.16, 0.14, 0.025, 9
# The length, of 1, below which a direction points at the eye.
NO_DIRECTION = 0.1
# Joints and points that have their names beside them, at most.
NAMED_JOINTS, NAMED_POINTS = 12, 10


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line through places, closed or not."""

    role: Role
    places: tuple[Flat, ...]
    closed: bool = False
    name: str = ""


@dataclass(frozen=True, slots=True)
class Symbol:
    """A mark at a place; `along` is the direction of a slider, or of the guide that it stands in."""

    mark: Mark
    place: Flat
    along: Flat = (1.0, 0.0)


@dataclass(frozen=True, slots=True)
class MachineLabel:
    """Names at a place, away from what is there: coordinates, inputs, or a point."""

    place: Flat
    away: Flat
    coordinates: tuple[str, ...] = ()
    inputs: tuple[str, ...] = ()
    point: str = ""


@dataclass(frozen=True, slots=True)
class MachineSketch:
    """All of a picture, in metres, y upwards."""

    strokes: tuple[Stroke, ...]
    symbols: tuple[Symbol, ...]
    labels: tuple[MachineLabel, ...]
    planar: bool


def sketch(pose: MachinePose) -> MachineSketch:
    """The picture of a machine."""
    return sketch_in(pose, view_of(pose))


def sketch_in(pose: MachinePose, view: View) -> MachineSketch:
    """The picture of a machine in a certain view."""
    forces = tuple(drawn_forces(pose))
    links = _Links(pose, view, frozenset(force.input for force in forces))
    arrows, inputs = _forces(pose, view, forces)
    legs, lengths = _lengths(pose, view)
    axes, bars = tuple(_world(pose, view)), tuple(links.strokes())
    # a plate would hide them
    covered = any(bar.closed and _is_inside(view.flat((0.0, 0.0, 0.0)), bar.places) for bar in bars)
    below, above = ((), axes) if covered else (axes, ())
    return MachineSketch(
        (*below, *links.base(), *_wheels(pose, view), *bars, *above, *_ties(pose, view), *legs, *arrows),
        (*links.grounds(), *links.symbols(), *links.pins()),
        (*links.labels(), *lengths, *inputs),
        view.planar,
    )


class _Links:
    """Frames as links: the places of each, and the joints between them; some inputs are named `elsewhere`."""

    def __init__(self, pose: MachinePose, view: View, elsewhere: frozenset[str]) -> None:
        self._pose, self._view, self._elsewhere = pose, view, elsewhere
        self._joints = {joint.frame: joint for joint in pose.joints}
        links = LinkPlaces(pose)
        self._places, self._roots, self._is_among = links.places, links.root, links.is_among

    def strokes(self) -> Iterator[Stroke]:
        """Bars and hulls, the far ones first; rails of sliders."""
        layers = []
        for frame, places in self._places.items():
            if frame == WORLD or len(places) < 2:
                continue
            hull = _hull([self._view.flat(place) for place in places])
            depth = sum(map(self._view.depth, places)) / len(places)
            layers.append((depth, Stroke("link", tuple(hull), closed=len(hull) > 2)))
        for joint in self._joints.values():
            if joint.kind == "sliding" and not self._pose.is_same(joint.place, joint.foot):
                ends = self._view.flat(joint.foot), self._view.flat(joint.place)
                layers.append((self._view.depth(joint.foot), Stroke("rail", ends)))
        return (stroke for _, stroke in sorted(layers, key=lambda pair: pair[0]))

    def base(self) -> Iterator[Stroke]:
        """What carries an arm that stands above the origin of the world."""
        places = self._places.get(WORLD, [])
        if len(places) == 1 and not self._view.planar:
            yield Stroke("base", (self._view.flat((0.0, 0.0, 0.0)), self._view.flat(places[0])))

    def grounds(self) -> Iterator[Symbol]:
        """Where joints stand on the world, and points of loops; in a plane sliders stand in guides."""
        sliding = [joint for joint in self._world_sliders() if self._view.planar]
        standing = [place for joint in self._moving() if joint not in sliding for place in (joint.place, joint.foot)]
        standing += [self._pose.places[point.name] for point in self._pose.mechanism.points]
        for place in self._places.get(WORLD, []):
            if self._is_among(place, standing) or not self._is_among(place, (joint.foot for joint in sliding)):
                yield Symbol("ground", self._view.flat(place))
        for joint in sliding:
            yield Symbol("guide", self._view.flat(joint.place), self._view.flat(joint.slides[0]))

    def _world_sliders(self) -> Iterator[DrawnJoint]:
        """Joints that slide on what stands still."""
        parents = {frame.name: frame.parent for frame in self._pose.mechanism.frames}
        for joint in self._moving():
            if joint.kind == "sliding" and self._roots[parents[joint.frame]] == WORLD:
                yield joint

    def _moving(self) -> Iterator[DrawnJoint]:
        return (joint for joint in self._joints.values() if joint.kind not in ("fixed", "free"))

    def symbols(self) -> Iterator[Symbol]:
        """Of joints and points."""
        for point in self._pose.mechanism.points:
            if self._is_shown(point.name):
                yield Symbol("point", self._view.flat(self._pose.places[point.name]))
        for joint in self._moving():
            place, driven = self._view.flat(joint.place), bool(joint.inputs)
            if joint.kind == "sliding":
                yield Symbol("driven slider" if driven else "slider", place, self._view.flat(joint.slides[0]))
            elif joint.kind == "ball":
                yield Symbol("ball", place)
            else:
                yield Symbol("driven" if driven else "joint", place)

    def pins(self) -> Iterator[Symbol]:
        """Where loops close: places that two links share without a joint."""
        joints = [joint.place for joint in self._moving()]
        seen: list[Place] = []
        roots = list(self._places)
        for k, frame in enumerate(roots):
            others = [place for other in roots[k + 1 :] for place in self._places[other]]
            for place in self._places[frame]:
                if self._is_among(place, others) and not self._is_among(place, (*joints, *seen)):
                    seen.append(place)
                    yield Symbol("pin", self._view.flat(place))

    def _is_shown(self, point: str) -> bool:
        """Whether a point is none of the places of joints."""
        place = self._pose.places[point]
        return not self._is_among(place, (joint.place for joint in self._moving()))

    def labels(self) -> Iterator[MachineLabel]:
        """Coordinates and inputs at joints, and the names of a few points."""
        named = [joint for joint in self._joints.values() if joint.coordinates]
        # of a long chain those at even distances, the first and the last
        chosen = named[:: math.ceil(len(named) / NAMED_JOINTS) or 1]
        together: list[list[DrawnJoint]] = []
        for joint in dict.fromkeys((*chosen, *named[-1:])):
            there = next((one for one in together if self._pose.is_same(one[0].place, joint.place)), None)
            if there is None:
                together.append([joint])
            else:
                there.append(joint)
        for joints in together:
            place = joints[0].place
            coordinates = tuple(name for joint in joints for name in joint.coordinates)
            inputs = tuple(name for joint in joints for name in joint.inputs if name not in self._elsewhere)
            yield MachineLabel(self._view.flat(place), self._away(place), coordinates, inputs)
        shown = [point.name for point in self._pose.mechanism.points if self._is_shown(point.name)]
        places: list[Place] = []
        for name in shown[:NAMED_POINTS]:
            place = self._pose.places[name]
            if not self._is_among(place, places):
                places.append(place)
                yield MachineLabel(self._view.flat(place), self._away(place), point=name)

    def _away(self, place: Place) -> Flat:
        """From the links that meet there; up where they are balanced."""
        here = self._view.flat(place)
        x = y = 0.0
        for places in self._places.values():
            if self._is_among(place, places):
                for other in places:
                    there = self._view.flat(other)
                    length = math.dist(here, there)
                    if length > 0:
                        x, y = x - (there[0] - here[0]) / length, y - (there[1] - here[1]) / length
        size = math.hypot(x, y)
        x, y = (x / size, y / size) if size > BALANCED else (0.0, 1.0)
        if y < 0 and self._is_among(place, self._places.get(WORLD, [])):
            return (1.0 if x > 0 else -1.0), 0.0  # the ground is below
        return x, y


def _world(pose: MachinePose, view: View) -> Iterator[Stroke]:
    """Axes of the world, at its origin; one that points at the eye is left out."""
    length = AXIS_LENGTH * pose.size
    origin = view.flat((0.0, 0.0, 0.0))
    for k in range(3):
        tip = view.flat((length * (k == 0), length * (k == 1), length * (k == 2)))
        if math.dist(origin, tip) > 0.1 * length:
            yield Stroke("axis", (origin, tip), name="xyz"[k])


def _wheels(pose: MachinePose, view: View) -> Iterator[Stroke]:
    for wheel in pose.mechanism.wheels:
        centre, radius = pose.places[wheel.frame], evaluate(wheel.radius, pose.parameters)
        axle, one, other = (pose.axis(wheel.frame, (wheel.axle + k) % 3) for k in (0, 1, 2))
        if abs(inner(axle, view.near)) < NEXT_TO_NOTHING:
            (x, y), (right, up) = view.flat(centre), view.flat(cross(axle, view.near))
            ends = (x + radius * right, y + radius * up), (x - radius * right, y - radius * up)
            yield Stroke("tyre", ends)
            continue
        rim = []
        for step in range(ROUND):
            angle = 2 * math.pi * step / ROUND
            c, s = radius * math.cos(angle), radius * math.sin(angle)
            x, y, z = (centre[i] + c * one[i] + s * other[i] for i in range(3))
            rim.append(view.flat((x, y, z)))
        yield Stroke("wheel", tuple(rim), closed=True)


def _ties(pose: MachinePose, view: View) -> Iterator[Stroke]:
    for tie in pose.mechanism.ties:
        start, end = (view.flat(pose.places[name]) for name in tie.ends)
        if tie.kind == "rod":
            yield Stroke("tie", (start, end))
        elif tie.kind == "cable":
            yield Stroke("cable", (start, end))
        else:
            yield Stroke("spring", tuple(_zigzag(start, end, ZIGZAG * pose.size)))


def _lengths(pose: MachinePose, view: View) -> tuple[list[Stroke], list[MachineLabel]]:
    """Legs that equations speak of, with their lengths beside the middle."""
    legs: list[Stroke] = []
    names: list[MachineLabel] = []
    for length in drawn_lengths(pose):
        start, end = (view.flat(pose.places[name]) for name in length.ends)
        legs.append(Stroke("tie", (start, end)))
        if length.coordinates or length.inputs:
            middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
            names.append(MachineLabel(middle, (1.0, 0.0), length.coordinates, length.inputs))
    return legs, names


def _forces(
    pose: MachinePose, view: View, forces: Sequence[DrawnForce]
) -> tuple[list[Stroke], list[MachineLabel]]:
    """Arrows of inputs that act on the machine itself, and the names of these inputs; torques have names alone."""
    arrows: list[Stroke] = []
    names: list[MachineLabel] = []
    length = ARROW_LENGTH * pose.size
    for force in forces:
        place = view.flat(force.place)
        right, up = view.flat(force.direction) if force.direction else (0.0, 0.0)
        if (seen := math.hypot(right, up)) > NO_DIRECTION:
            tip = place[0] + length * right, place[1] + length * up
            arrows.append(Stroke("force", (place, tip)))
            names.append(MachineLabel(tip, (right / seen, up / seen), inputs=(force.input,)))
        else:
            names.append(MachineLabel(place, (0.0, 1.0), inputs=(force.input,)))
    return arrows, names


def _zigzag(start: Flat, end: Flat, width: float) -> Iterator[Flat]:
    length = math.dist(start, end) or 1.0
    across = -(end[1] - start[1]) / length * width, (end[0] - start[0]) / length * width
    yield start
    for k in range(1, ZIGZAGS + 1):
        share, side = 0.2 + 0.6 * k / (ZIGZAGS + 1), 1 if k % 2 else -1
        x, y = (start[i] + share * (end[i] - start[i]) + side * across[i] for i in (0, 1))
        yield x, y
    yield end


def _hull(places: Sequence[Flat]) -> list[Flat]:
    """The convex hull by Andrew's monotone chain (de Berg et al., Computational Geometry, ch. 1)."""
    ordered = sorted(set(places))
    halves = []
    for half in (ordered, ordered[::-1]):
        chain: list[Flat] = []
        for place in half:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], place) <= 0:
                chain.pop()
            chain.append(place)
        halves.append(chain[:-1])
    return halves[0] + halves[1]


def _is_inside(place: Flat, hull: Sequence[Flat]) -> bool:
    """Whether a convex hull has a place on it, or inside."""
    return all(_turn(hull[k - 1], hull[k], place) >= 0 for k in range(len(hull)))


def _turn(a: Flat, b: Flat, c: Flat) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
