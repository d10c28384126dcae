"""What the compiler is told, and attributes that elements have from default classes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from symgen.model.expressions.names import did_you_mean
from symgen.model.mjcf.words import ACTUATOR, EQUALITY, GENERAL, GEOM, JOINT, SITE
from symgen.model.robots.numbers import IDENTITY, Matrix, Vector, WrittenNumber, product, turn
from symgen.model.robots.places import AxesPlace, quaternion_axes, turned_about, unit, z_to
from symgen.model.robots.reader import MAXIMUM_LINKS, ElementReader
from symgen.model.robots.xml import Element

MAIN = "main"
DEGREE = Fraction(math.pi) / 180
ACTUATORS = ("motor", "general")
# actuators whose defaults are those of all actuators
SERVOS = ("position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion", "dcmotor", "plugin")
KINDS_OF_ACTUATORS = "general"
# what stands for a default of a servo among attributes
SERVO_DEFAULT = "<servo>"
DEFAULTS = {
    "joint": JOINT,
    "geom": GEOM,
    "site": SITE,
    "equality": EQUALITY,
    "motor": ACTUATOR,
    "general": (*ACTUATOR, *GENERAL),
}


@dataclass(frozen=True, slots=True)
class CompilerSettings:
    """How numbers are meant."""

    degrees: bool = True
    sequence: str = "xyz"
    auto_limits: bool = True
    from_geoms: str = "auto"
    groups: tuple[int, int] = (0, 5)


@dataclass(slots=True)
class Settings:
    """The attributes of an element, and where each stands: in it or in a default."""

    element: Element
    owners: dict[str, Element]

    def get(self, key: str, otherwise: str = "") -> str:
        """The text of an attribute."""
        return self.owner(key).attributes.get(key, otherwise).strip()

    def owner(self, key: str) -> Element:
        """The element in which an attribute stands."""
        return self.owners.get(key, self.element)

    def has(self, key: str) -> bool:
        """Whether it stands anywhere."""
        return key in self.owners


class SettingsReader(ElementReader):
    """Reads attributes through default classes, and places."""

    def __init__(self, unread: frozenset[str]) -> None:
        super().__init__("MJCF", unread)
        self.compiler = CompilerSettings()
        self.classes: dict[str, dict[str, dict[str, Element]]] = {MAIN: {}}
        self._inside = 0

    def read_defaults(self, element: Element, outer: str) -> None:
        """A default class with those inside of it; each has what the class around it has."""
        name = element.attributes.get("class", "" if self._inside else MAIN).strip()
        self.attributes(element, ("class",))
        if not name:
            self.wrong("a default class has no name", 'add class="..."', element.span)
            return
        own = {tag: dict(owners) for tag, owners in self.classes.get(outer, {}).items()}
        for child in element.children:
            kind = KINDS_OF_ACTUATORS if child.tag in (*ACTUATORS, *SERVOS) else child.tag
            if child.tag in DEFAULTS:
                self.attributes(child, DEFAULTS[child.tag])
            if kind in DEFAULTS:
                own.setdefault(kind, {}).update(dict.fromkeys(child.attributes, child))
            if child.tag in SERVOS:
                own[kind][SERVO_DEFAULT] = child
        self.classes[name] = own
        self._inside += 1
        for child in element.all("default"):
            self.read_defaults(child, name)
        self._inside -= 1

    def settings(self, element: Element, inherited: str, known: tuple[str, ...], kind: str = "") -> Settings:
        """The attributes of an element, with those of its default class, or of the one that its body names."""
        chosen = element.attributes.get("class", inherited).strip() or MAIN
        if chosen not in self.classes:
            remedy = did_you_mean(chosen, list(self.classes)[:MAXIMUM_LINKS], "declare it under `default`")
            place = element.place("class") if "class" in element.attributes else element.span
            self.wrong(f"there is no default class `{chosen}`", remedy, place)
            chosen = MAIN
        self.attributes(element, known)
        owners = self.classes[chosen].get(kind or element.tag, {})
        return Settings(element, {**owners, **dict.fromkeys(element.attributes, element)})

    def numbers(
        self, settings: Settings, key: str, what: str, least: int = 3, most: int = 3
    ) -> tuple[WrittenNumber, ...]:
        """The numbers of an attribute; none where it is not there or wrong."""
        return self.vector(settings.owner(key), key, f"`{key}` of {what}", least, most)

    def single(self, settings: Settings, key: str, what: str) -> WrittenNumber | None:
        """The number of an attribute."""
        return self.number(settings.owner(key), key, what)

    def first(self, settings: Settings, key: str, what: str) -> WrittenNumber | None:
        """The first number of a polynomial, whose others must be 0."""
        given = self.numbers(settings, key, what, 1, 7)
        for further in given[1:]:
            if further.value:
                message = f"`{key}` of {what} is a polynomial"
                self.wrong(message, "give its first number alone, or write `forces` in the model file", further.span)
                break
        return given[0] if given else None

    def angle(self, number: WrittenNumber) -> WrittenNumber:
        """An angle in rad, whatever the file counts in."""
        if not self.compiler.degrees:
            return number
        if not number.value:
            return number
        return WrittenNumber(number.value * DEGREE, f"{number.text}*pi/180", number.span)

    def zero_or(self, settings: Settings, key: str, what: str, why: str, remedy: str) -> None:
        """Refuses an attribute that is not 0 or false."""
        text = settings.get(key)
        if text and text not in ("false", "auto", "disable") and any(part.strip("0.+-") for part in text.split()):
            if key in self.unread:
                self.leave_out(key, self.owner)
            else:
                hint = f"{remedy}; {self.leaving_out(key)}"
                self.wrong(f"`{key}` of {what} is not read: {why}", hint, settings.owner(key).place(key))

    def place(self, settings: Settings, what: str) -> AxesPlace:
        """Where an element sits in the axes of its body."""
        x_y_z = tuple(number.value for number in self.numbers(settings, "pos", what))
        shift: Vector = (x_y_z[0], x_y_z[1], x_y_z[2]) if x_y_z else AxesPlace().shift
        return AxesPlace(shift, self._axes(settings, what))

    def _axes(self, settings: Settings, what: str) -> Matrix:
        given = [key for key in ("quat", "axisangle", "euler", "xyaxes", "zaxis") if settings.has(key)]
        for further in given[1:]:
            message = f"{what} has `{given[0]}` and `{further}`"
            self.wrong(message, "keep one of them", settings.owner(further).place(further))
        if not given:
            return IDENTITY
        key = given[0]
        count = {"quat": 4, "axisangle": 4, "xyaxes": 6}.get(key, 3)
        numbers = self.numbers(settings, key, what, count, count)
        if not numbers:
            return IDENTITY
        values = [number.value for number in numbers]
        place = settings.owner(key).place(key)
        if key == "euler":
            return self._euler([self.angle(number) for number in numbers])
        if not any(values[:4] if key == "quat" else values[:3]) or (key == "xyaxes" and not any(_across(values))):
            self.wrong(f"`{key}` of {what} has no direction", "give one that is not 0", place)
            return IDENTITY
        if key == "quat":
            return quaternion_axes(values)
        if key == "axisangle":
            return turned_about((values[0], values[1], values[2]), self.angle(numbers[3]).value)
        return z_to((values[0], values[1], values[2])) if key == "zaxis" else _x_and_y(values)

    def _euler(self, angles: list[WrittenNumber]) -> Matrix:
        axes = IDENTITY
        for letter, angle in zip(self.compiler.sequence, angles, strict=True):
            turned = turn("xyz".index(letter.lower()), angle)
            axes = product(axes, turned) if letter.islower() else product(turned, axes)
        return axes


def _across(values: list[Fraction]) -> list[Fraction]:
    (a, b, c), (d, e, f) = values[:3], values[3:]
    return [b * f - c * e, c * d - a * f, a * e - b * d]


def _x_and_y(values: list[Fraction]) -> Matrix:
    """The axes with this x, and this y without its part along x."""
    x = unit((values[0], values[1], values[2]))
    normal = _across(values)
    z = unit((normal[0], normal[1], normal[2]))
    y = _across([*z, *x])
    return (x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2])
