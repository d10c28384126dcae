"""Where frames and points are at each frame of a motion: what the animation draws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from symgen.model.float_kinematics import FloatKinematics
from symgen.model.gradient import Gradients
from symgen.model.mechanism import WORLD
from symgen.model.model import Model

Place = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Scene:
    """Names of what is drawn, which of them are joined by a line, and their places (m) at each frame."""

    names: tuple[str, ...]
    lines: tuple[tuple[int, int], ...]
    places: tuple[tuple[Place, ...], ...]


def scene(model: Model, parameters: Mapping[str, float], motion: Sequence[Sequence[float]]) -> Scene | None:
    """The frames' origins and points along the motion; None for a model without frames."""
    mechanism = model.mechanism
    if not mechanism.frames:
        return None
    names = (*(frame.name for frame in mechanism.frames), *(point.name for point in mechanism.points))
    number = {name: k for k, name in enumerate(names)}
    # an origin is joined to its parent's, a point to its frame's
    lines = [(number[f.parent], number[f.name]) for f in mechanism.frames if f.parent != WORLD]
    lines += [(number[p.frame], number[p.name]) for p in mechanism.points if p.frame != WORLD]
    index = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}
    definitions = {definition.name: definition.value for definition in model.definitions}

    def places(q: Sequence[float]) -> tuple[Place, ...]:
        values = {**parameters, **{name: q[i] for name, i in index.items()}}
        kinematics = FloatKinematics(mechanism, Gradients(values, index, definitions))
        found = []
        for name in names:
            x, y, z = (kinematics.value(f"{name}.{axis}") for axis in "xyz")
            found.append((x, y, z))
        return tuple(found)

    return Scene(names, tuple(lines), tuple(places(q) for q in motion))
