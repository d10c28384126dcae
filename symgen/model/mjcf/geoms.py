"""Masses and tensors of geoms, where bodies have none of their own, as MuJoCo works them out."""

from __future__ import annotations

import math
from fractions import Fraction

from symgen.model.kinematics.triples import minus, plus
from symgen.model.mjcf.settings import Settings, SettingsReader
from symgen.model.robots.numbers import IDENTITY, Vector
from symgen.model.robots.places import NO_SHIFT, AxesPlace, z_to
from symgen.model.robots.solids import Solid, matrix_of

# In kg/m**3, where a geom has neither mass nor density.
USUAL_DENSITY = Fraction(1000)
PI = Fraction(math.pi)
# how many numbers `size` has, also where `fromto` gives the length
SIZES = {"sphere": (1, 1), "capsule": (2, 1), "cylinder": (2, 1), "ellipsoid": (3, 1), "box": (3, 1)}
WITHOUT_VOLUME = ("plane", "hfield")


def read_geom(reader: SettingsReader, settings: Settings, what: str) -> Solid | None:
    """The mass of a geom in the axes of its body; None for one that has none, or has mistakes."""
    kind = settings.get("type", "sphere")
    group = settings.get("group", "0")
    if group.isdecimal() and not reader.compiler.groups[0] <= int(group) <= reader.compiler.groups[1]:
        return None
    mass, density = (reader.single(settings, key, what) for key in ("mass", "density"))
    is_massless = mass.value == 0 if mass is not None else density is not None and density.value == 0
    if kind in WITHOUT_VOLUME or is_massless:
        return None
    place = placed_geom(reader, settings, what, kind)
    if kind not in SIZES:
        message = f"{what} is of type `{kind}`, whose mass is not worked out"
        remedy = f'give the body <inertial mass=... .../>, or the geom mass="0"; types are {", ".join(SIZES)}'
        reader.wrong(message, remedy, settings.owner("type").place("type"))
        return None
    shelled = "its mass is not on its surface", "give the body <inertial mass=... .../>"
    reader.zero_or(settings, "shellinertia", what, *shelled)
    size = _size(reader, settings, what, kind)
    if not size:
        return None
    volume, moments = _shape(kind, size)
    weight = mass.value if mass is not None else volume * (USUAL_DENSITY if density is None else density.value)
    x, y, z = (weight * moment for moment in moments)
    zero = Fraction(0)
    return Solid(weight, NO_SHIFT, ((x, zero, zero), (zero, y, zero), (zero, zero, z))).seen_from(place)


def placed_geom(reader: SettingsReader, settings: Settings, what: str, kind: str) -> AxesPlace:
    """Where a geom or a site sits in its body, its z axis along `fromto` where that is given."""
    if not settings.has("fromto") or kind == "sphere":
        return reader.place(settings, what)
    start, end = _ends(reader, settings, what)
    way = minus(end, start)
    if not any(way):
        reader.wrong(f"`fromto` of {what} has no length", "give two points", settings.owner("fromto").place("fromto"))
        return AxesPlace()
    middle = plus(start, end)
    return AxesPlace((middle[0] / 2, middle[1] / 2, middle[2] / 2), z_to(way))


def _ends(reader: SettingsReader, settings: Settings, what: str) -> tuple[Vector, Vector]:
    numbers = [number.value for number in reader.numbers(settings, "fromto", what, 6, 6)] or [Fraction(0)] * 5 + [PI]
    return (numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5])


def _size(reader: SettingsReader, settings: Settings, what: str, kind: str) -> tuple[Fraction, ...]:
    """Radii and half lengths; none where there is a mistake."""
    needed, with_ends = SIZES[kind]
    along = settings.has("fromto") and kind != "sphere"
    count = with_ends if along else needed
    if not settings.has("size"):
        reader.wrong(f"{what} has no `size`", 'add size="..."', settings.element.span)
        return ()
    numbers = reader.numbers(settings, "size", what, count, 3)
    if any(number.value <= 0 for number in numbers[:count]):
        reader.wrong(f"`size` of {what} is not positive", "give radii and half lengths", numbers[0].span)
        return ()
    size = tuple(number.value for number in numbers[:count])
    if not along or not size:
        return size
    start, end = _ends(reader, settings, what)
    way = minus(end, start)
    half = Fraction(math.sqrt(sum(entry * entry for entry in way))) / 2
    return (size[0], half) if needed == 2 else (size[0], size[0], half)


def _shape(kind: str, size: tuple[Fraction, ...]) -> tuple[Fraction, tuple[Fraction, Fraction, Fraction]]:
    """The volume, and the moments of inertia of a mass of 1."""
    if kind == "sphere":
        size = (*size, *size, *size)
    if kind == "box":
        a, b, c = (entry**2 for entry in size)
        return 8 * size[0] * size[1] * size[2], ((b + c) / 3, (a + c) / 3, (a + b) / 3)
    if kind in ("ellipsoid", "sphere"):
        a, b, c = (entry**2 for entry in size)
        return 4 * PI / 3 * size[0] * size[1] * size[2], ((b + c) / 5, (a + c) / 5, (a + b) / 5)
    radius, length = size[0], 2 * size[1]
    rod = (3 * radius**2 + length**2) / 12
    if kind == "cylinder":
        return PI * radius**2 * length, (rod, rod, radius**2 / 2)
    # a capsule: a cylinder, and the halves of a sphere at its ends, 3/8 of the radius beyond them
    ends = 4 * radius / (4 * radius + 3 * length)
    across = (1 - ends) * rod + ends * (2 * radius**2 / 5 + length**2 / 4 + 3 * length * radius / 8)
    along = (1 - ends) * radius**2 / 2 + ends * 2 * radius**2 / 5
    return PI * radius**2 * length + 4 * PI / 3 * radius**3, (across, across, along)


def read_inertial(reader: SettingsReader, settings: Settings, what: str) -> Solid | None:
    """The mass that a body says it has."""
    if not settings.has("mass"):
        reader.wrong(f"{what} has no `mass`", 'add mass="..."', settings.element.span)
        return None
    mass = reader.single(settings, "mass", what)
    diagonal, full = (reader.numbers(settings, key, what, count, count) for key, count in _TENSORS)
    place = reader.place(settings, what)
    if settings.has("fullinertia"):
        if place.axes != IDENTITY or settings.has("diaginertia"):
            message = f"{what} has `fullinertia` beside turned axes or `diaginertia`"
            reader.wrong(message, "keep one of them", settings.owner("fullinertia").place("fullinertia"))
        elements = [number.value for number in full]
    else:
        elements = [number.value for number in diagonal] + [Fraction(0)] * 3
    if mass is None or len(elements) < 6:
        if not settings.has("fullinertia") and not settings.has("diaginertia"):
            remedy = 'add diaginertia="..." or fullinertia="..."'
            reader.wrong(f"{what} has no inertia", remedy, settings.element.span)
        return None
    return Solid(mass.value, NO_SHIFT, matrix_of(elements)).seen_from(place)


_TENSORS = (("diaginertia", 3), ("fullinertia", 6))
