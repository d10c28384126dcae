"""A mechanism where its start leads: the places of frames and points, and what each joint lets move."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

from symgen.mechanics.genericity import assembly_of, parameter_values
from symgen.mechanics.system import System
from symgen.model.configurations.gradient import Gradients
from symgen.model.kinematics.float_kinematics import FloatArithmetic, Form
from symgen.model.kinematics.triples import Rates, Triple, applied, cross, transposed
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import WORLD, Component, Frame, component
from symgen.model.model import Model

Place: TypeAlias = Triple[float]
Kind: TypeAlias = Literal["fixed", "turning", "sliding", "ball", "free"]
# Of the size of the machine, or of a direction: what is less is none.
NEXT_TO_NOTHING = 1e-6


@dataclass(frozen=True, slots=True)
class DrawnJoint:
    """What a frame's joint lets move, where it is, and the point of its parent that it stands on.

    `slides` and `turns` are the directions along and about which it moves, in the axes of the world.  `coordinates` are
    those that no frame before it has.
    """

    frame: str
    kind: Kind
    place: Place
    foot: Place
    slides: tuple[Place, ...]
    turns: tuple[Place, ...]
    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]


def kinematics_at(model: Model, values: Mapping[str, float]) -> Kinematics[float, Form]:
    """The frames and points of a model at these values of coordinates and parameters."""
    index = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
    definitions = {definition.name: definition.value for definition in model.definitions}
    return Kinematics(model.pictured, FloatArithmetic(Gradients(values, index, definitions)), False)


class MachinePose:
    """One configuration of a model; ArithmeticError or ValueError where expressions have no value there.

    It is where the start of the model leads, with default values of parameters, unless others are given.  `values` are
    those of parameters and coordinates.
    """

    def __init__(
        self, model: Model, parameters: Mapping[str, float] | None = None, q: Sequence[float] | None = None
    ) -> None:
        self.model, self.mechanism = model, model.pictured
        self.parameters = parameter_values(System(model)) if parameters is None else dict(parameters)
        q = assembly_of(model).places[0].q if q is None else q
        self._names = [coordinate.name for coordinate in model.coordinates]
        self.values = self.parameters | dict(zip(self._names, map(float, q), strict=True))
        self._kinematics = kinematics_at(model, self.values)
        self.places = {name: self._kinematics.position(name) for name in self._owners()}
        extents = (max(axis) - min(axis) for axis in zip(*self.places.values(), strict=True))
        self.size = max(extents, default=0.0) or 1.0

    def _owners(self) -> list[str]:
        return [one.name for group in (self.mechanism.frames, self.mechanism.points) for one in group]

    def axis(self, frame: str, number: int) -> Place:
        """An axis of a frame, in those of the world."""
        x, y, z = (row[number] for row in self._kinematics.axes(frame))
        return x, y, z

    def is_still(self, owner: str) -> bool:
        """Whether a point, or the origin of a frame, stays where it is, whatever moves."""
        return not any(value for form in self.place_rate(owner) for value in form.values())

    def place_rate(self, owner: str) -> Rates[Form]:
        """How the place of a point, or of the origin of a frame, moves in the world: coefficients of the rates."""
        return self._kinematics.position_rate(owner)

    def gradients(self, by: Mapping[str, int]) -> Gradients:
        """What evaluates expressions here, with gradients by the components of points and frames that have numbers.

        Rates of these are 0.
        """
        definitions = {definition.name: definition.value for definition in self.model.definitions}

        def known(name: str) -> tuple[float, dict[int, float]]:
            one = component(name)
            return 0.0 if one.is_rate else self.component(one), {by[name]: 1.0} if name in by else {}

        return Gradients(self.values, {}, definitions, known)

    def component(self, one: Component) -> float:
        """A component of a point or frame that is no rate."""
        return self._kinematics.component(one)

    def all_axes(self, frame: str) -> tuple[Place, Place, Place]:
        """The rows of the matrix that turns components in a frame's axes into those in the world's."""
        return self._kinematics.axes(frame)

    def in_frame(self, frame: str, place: Place) -> Place:
        """A place of the world from the origin of a frame, in its axes."""
        if frame == WORLD:
            return place
        x, y, z = (a - b for a, b in zip(place, self.places[frame], strict=True))
        return applied(transposed(self.all_axes(frame)), (x, y, z))

    def in_world(self, frame: str, at: Place) -> Place:
        """The place in the world of one in a frame."""
        return self._kinematics.place(frame, at)

    def is_same(self, one: Place, other: Place) -> bool:
        """Whether two places are one."""
        return math.dist(one, other) < NEXT_TO_NOTHING * self.size

    @cached_property
    def joints(self) -> tuple[DrawnJoint, ...]:
        """One for each frame, parents first."""
        shown: set[int] = set()
        drawn = []
        for frame in self.mechanism.frames:
            joint = self._joint(frame, shown)
            shown.update(self._names.index(name) for name in joint.coordinates)
            drawn.append(joint)
        return tuple(drawn)

    def _joint(self, frame: Frame, shown: set[int]) -> DrawnJoint:
        own = self._kinematics.joint(frame.name)
        slides, turns = (self._directions(frame.parent, rates) for rates in (own.place_rate, own.turning_before))
        kind: Kind = "fixed"
        if slides:
            kind = "sliding" if len(slides) == 1 else "free"
        elif turns:
            kind = "turning" if len(turns) == 1 else "ball"
        moving = _coordinates(own.place_rate), _coordinates(own.turning_before)
        names = tuple(self._names[i] for i in dict.fromkeys(i for part in moving for i in part) if i not in shown)
        acting = {one.name: {name for name, _ in one.acts_on} for one in self.model.inputs}
        driven = tuple(name for name, coordinates in acting.items() if coordinates and coordinates <= {*names})
        place = foot = self.places[frame.name]
        if kind == "sliding":
            start = self.values | {self._names[i]: 0.0 for i in moving[0]}
            with suppress(ArithmeticError, ValueError):  # a slide at 0 may have no place
                foot = kinematics_at(self.model, start).position(frame.name)
        return DrawnJoint(frame.name, kind, place, foot, slides, turns, names, driven)

    def _directions(self, parent: str, rates: Rates[Form]) -> tuple[Place, ...]:
        """Those of a rate that is given in the parent's axes, each once, in the axes of the world."""
        directions: list[Place] = []
        for i in _coordinates(rates):
            x, y, z = (form.get(i, 0.0) for form in rates)
            vector = applied(self._kinematics.axes(parent), (x, y, z))
            if (length := math.hypot(*vector)) > NEXT_TO_NOTHING:
                one = vector[0] / length, vector[1] / length, vector[2] / length
                if all(math.hypot(*cross(one, other)) > NEXT_TO_NOTHING for other in directions):
                    directions.append(one)
        return tuple(directions)


def _coordinates(rates: Rates[Form]) -> list[int]:
    """Those that move something, by their numbers."""
    return sorted({i for form in rates for i, value in form.items() if value})
