"""Boxes, cylinders, spheres and meshes as solids of flat faces, for pictures alone: plain numbers."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Iterator
from itertools import product
from typing import TypeAlias

from symgen.model.kinematics.triples import Triple
from symgen.records import dataclass

Corner: TypeAlias = Triple[float]
# Sides of the polygons that stand for circles, and rings of them in a sphere.
ROUND_SIDES, RINGS = 16, 8
# Triangles of a mesh that are read; a browser turns ten times as many without a halt.
MOST_TRIANGLES = 5000
# Bytes of STL: its head with the number of triangles, and each of these.
HEAD, TRIANGLE = 84, 50
# Bytes of a file that are read: a triangle takes seven lines of a text.
MOST_BYTES = 400 * MOST_TRIANGLES
VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")


@dataclass(frozen=True, slots=True)
class Faces:
    """Corners (m), and faces by the numbers of their corners."""

    corners: tuple[Corner, ...]
    faces: tuple[tuple[int, ...], ...]


def box(x: float, y: float, z: float) -> Faces:
    """Edges of these lengths about the origin."""
    corners = tuple((a * x / 2, b * y / 2, c * z / 2) for a, b, c in product((-1, 1), repeat=3))
    sides = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return Faces(corners, sides)


def cylinder(radius: float, length: float) -> Faces:
    """About the z axis, its middle at the origin."""
    low, high = (_circle(radius, half) for half in (-length / 2, length / 2))
    bottom, top = range(ROUND_SIDES - 1, -1, -1), range(ROUND_SIDES, 2 * ROUND_SIDES)
    return Faces((*low, *high), (*_band(0, ROUND_SIDES), tuple(bottom), tuple(top)))


def sphere(radius: float) -> Faces:
    """About the origin."""
    angles = [math.pi * k / RINGS for k in range(1, RINGS)]
    rings = [_circle(radius * math.sin(angle), -radius * math.cos(angle)) for angle in angles]
    bands = [face for k in range(len(rings) - 1) for face in _band(k * ROUND_SIDES, ROUND_SIDES)]
    south, north, last = len(rings) * ROUND_SIDES, len(rings) * ROUND_SIDES + 1, (len(rings) - 1) * ROUND_SIDES
    caps = [face for k in range(ROUND_SIDES) for face in (
        (south, (k + 1) % ROUND_SIDES, k), (last + k, last + (k + 1) % ROUND_SIDES, north)
    )]  # fmt: skip
    corners = (*(corner for ring in rings for corner in ring), (0.0, 0.0, -radius), (0.0, 0.0, radius))
    return Faces(corners, (*bands, *caps))


def _circle(radius: float, height: float) -> list[Corner]:
    turns = (2 * math.pi * k / ROUND_SIDES for k in range(ROUND_SIDES))
    return [(radius * math.cos(turn), radius * math.sin(turn), height) for turn in turns]


def _band(first: int, sides: int) -> Iterator[tuple[int, ...]]:
    """Faces between a polygon and the next."""
    for k in range(sides):
        beside = (k + 1) % sides
        yield first + k, first + beside, first + sides + beside, first + sides + k


def of_stl(data: bytes) -> Faces | None:
    """The triangles of an STL file, binary or text; None where it is none, or too large."""
    count = int.from_bytes(data[80:HEAD], "little")
    if len(data) == HEAD + TRIANGLE * count and count:
        numbers = (struct.unpack_from("<9f", data, HEAD + TRIANGLE * k + 12) for k in range(min(count, MOST_TRIANGLES)))
        places = [nine[k : k + 3] for nine in numbers for k in (0, 3, 6)]
    elif data.lstrip()[:5] == b"solid":
        try:
            places = [tuple(map(float, match.groups())) for match in VERTEX.finditer(data)]
        except ValueError:
            return None
        count = len(places) // 3
    else:
        return None
    if not 0 < count <= MOST_TRIANGLES or len(places) != 3 * count:
        return None
    number: dict[tuple[float, ...], int] = {}
    corners = [number.setdefault(place, len(number)) for place in places]
    distinct = tuple((x, y, z) for x, y, z in number)
    return Faces(distinct, tuple(tuple(corners[k : k + 3]) for k in range(0, len(corners), 3)))
