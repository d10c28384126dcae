"""A mechanism where its start leads: the places of frames and points, and what each joint lets move."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

from symgen.mechanics.genericity import assembly_of, parameter_values
from symgen.mechanics.system import System
from symgen.model.configurations.gradient import Gradients
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import names_in
from symgen.model.kinematics.float_kinematics import FloatKinematics
from symgen.model.mechanism import Frame, Quaternion
from symgen.model.model import Model

Place: TypeAlias = tuple[float, float, float]
Kind: TypeAlias = Literal["fixed", "turning", "sliding", "ball", "free"]
# Of the world; also the axis of what has none.
ORIGIN: Place = (0.0, 0.0, 0.0)
# Of the size of the machine: what is nearer is one place.
SAME_PLACE = 1e-6


@dataclass(frozen=True, slots=True)
class DrawnJoint:
    """What a frame's joint lets move, where it is, the point of its parent that it stands on, and its axis."""

    frame: str
    kind: Kind
    place: Place
    foot: Place
    axis: Place
    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]


class MachinePose:
    """One configuration of a model; ArithmeticError or ValueError where expressions have no value there."""

    def __init__(self, model: Model) -> None:
        self.model, self.mechanism = model, model.mechanism
        self.parameters = parameter_values(System(model))
        q = assembly_of(model).places[0].q
        self._index = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
        self._definitions = {definition.name: definition.value for definition in model.definitions}
        self._values = self.parameters | {name: float(q[i]) for name, i in self._index.items()}
        self._kinematics = self._at(self._values)

    def _at(self, values: Mapping[str, float]) -> FloatKinematics:
        return FloatKinematics(self.mechanism, Gradients(dict(values), self._index, self._definitions))

    def place(self, name: str) -> Place:
        """Of a point, or of the origin of a frame (m)."""
        return _place(self._kinematics, name)

    def axis(self, frame: str, number: int) -> Place:
        """An axis of a frame, in those of the world."""
        x, y, z = (self._kinematics.value(f"{frame}.r{row}{number + 1}") for row in "123")
        return x, y, z

    @cached_property
    def joints(self) -> tuple[DrawnJoint, ...]:
        """One for each frame."""
        return tuple(map(self._joint, self.mechanism.frames))

    @property
    def names(self) -> tuple[str, ...]:
        """Of frames, then of points."""
        frames, points = self.mechanism.frames, self.mechanism.points
        return (*(frame.name for frame in frames), *(point.name for point in points))

    @cached_property
    def size(self) -> float:
        """The longest extent of all places."""
        places = [self.place(name) for name in self.names] or [ORIGIN]
        return max(max(p[k] for p in places) - min(p[k] for p in places) for k in range(3)) or 1.0

    def is_same(self, one: Place, other: Place) -> bool:
        """Whether two places are one."""
        return max(abs(a - b) for a, b in zip(one, other, strict=True)) < SAME_PLACE * self.size

    def _joint(self, frame: Frame) -> DrawnJoint:
        slides = [name for entry in frame.translation for name in self._coordinates(entry)]
        if isinstance(frame.rotation, Quaternion):
            turns = [name for part in frame.rotation.parts for name in self._coordinates(part)]
        else:
            turns = [name for turn in frame.rotation for name in self._coordinates(turn.angle)]
        slides, turns = list(dict.fromkeys(slides)), list(dict.fromkeys(turns))
        kind: Kind = "fixed"
        if len(slides) > 1:
            kind = "free"
        elif slides:
            kind = "sliding"
        elif len(turns) > 1:
            kind = "ball"
        elif turns:
            kind = "turning"
        names = (*slides, *turns)
        acting = {one.name: {name for name, _ in one.acts_on} for one in self.model.inputs}
        driven = [name for name, coordinates in acting.items() if coordinates and coordinates <= {*names}]
        place, foot = self.place(frame.name), self._foot(frame, slides)
        return DrawnJoint(frame.name, kind, place, foot, self._axis(frame, slides, turns), names, tuple(driven))

    def _foot(self, frame: Frame, slides: list[str]) -> Place:
        """Where the frame is with its slide at 0."""
        if not slides:
            return self.place(frame.name)
        return _place(self._at(self._values | dict.fromkeys(slides, 0.0)), frame.name)

    def _axis(self, frame: Frame, slides: list[str], turns: list[str]) -> Place:
        """What the joint slides along or turns about, by a small step of its coordinate."""
        if len(slides) == 1:
            moved = _place(self._at(self._values | {slides[0]: self._values[slides[0]] + self.size}), frame.name)
            here = self.place(frame.name)
            return _unit((moved[0] - here[0], moved[1] - here[1], moved[2] - here[2]))
        if len(turns) == 1:
            step = 1e-4
            turned = self._at(self._values | {turns[0]: self._values[turns[0]] + step})
            axes = [
                (self.axis(frame.name, k), [turned.value(f"{frame.name}.r{row}{k + 1}") for row in "123"])
                for k in range(3)
            ]
            # half the sum of e_k x e_k' is the axis times the sine of the step
            whole = [0.0, 0.0, 0.0]
            for before, after in axes:
                for i in range(3):
                    j, k = (i + 1) % 3, (i + 2) % 3
                    whole[i] += before[j] * after[k] - before[k] * after[j]
            return _unit((whole[0], whole[1], whole[2]))
        return ORIGIN

    def _coordinates(self, expression: Expression) -> Iterator[str]:
        """Those that an expression depends on, through definitions."""
        for name in names_in(expression):
            if name.name in self._index:
                yield name.name
            yield from self._named.get(name.name, ())

    @cached_property
    def _named(self) -> Mapping[str, tuple[str, ...]]:
        """Those that each definition depends on: it is made of earlier ones."""
        found: dict[str, tuple[str, ...]] = {}
        for name, value in self._definitions.items():
            words = dict.fromkeys(one.name for one in names_in(value))
            inner = [word for word in words for word in ((word,) if word in self._index else found.get(word, ()))]
            found[name] = tuple(dict.fromkeys(inner))
        return found


def _place(kinematics: FloatKinematics, name: str) -> Place:
    x, y, z = (kinematics.value(f"{name}.{axis}") for axis in "xyz")
    return x, y, z


def _unit(vector: Place) -> Place:
    length = sum(x * x for x in vector) ** 0.5
    return (vector[0] / length, vector[1] / length, vector[2] / length) if length else ORIGIN
