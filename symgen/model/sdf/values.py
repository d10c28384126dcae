"""Values of SDF, which stand as texts in elements, and poses."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from symgen.model.robots.numbers import IDENTITY, WrittenNumber, product, turn
from symgen.model.robots.places import AxesPlace, quaternion_axes
from symgen.model.robots.reader import ElementReader
from symgen.model.robots.xml import Element

DEGREE = Fraction(math.pi) / 180
TRUE = ("true", "1")


class ValueReader(ElementReader):
    """Reads the values in children of an element."""

    def __init__(self, unread: frozenset[str]) -> None:
        super().__init__("SDF", unread)

    def parts(
        self,
        element: Element,
        read: Iterable[str],
        idle: Iterable[str] = (),
        refused: dict[str, tuple[str, str]] | None = None,
    ) -> None:
        """Children that take no part, are refused, or that nobody knows."""
        for child in element.children:
            if child.tag in idle:
                self.leave_out(child.tag, child.attributes.get("name", "") or self.owner)
            elif refused is not None and child.tag in refused:
                self.refuse(child, *refused[child.tag])
            elif child.tag not in read:
                self.unknown_child(child, read, element.tag)

    def words(self, element: Element, known: Iterable[str] = ()) -> str:
        """The text of an element that holds a value, and has no attributes but these."""
        for key in element.attributes:
            if key not in known and key not in self.unread:
                self.wrong(f"`{key}` is no attribute of `{element.tag}`", self.leaving_out(key), element.place(key))
        for child in element.children:
            self.unknown_child(child, (), element.tag)
        return element.text

    def value(self, element: Element, tag: str, what: str, needed: bool = False) -> WrittenNumber | None:
        """The number in a child."""
        child = self.only(element, tag)
        if child is None:
            if needed:
                self.wrong(f"{what} has no `{tag}`", f"add <{tag}>...</{tag}>", element.span)
            return None
        text = self.words(child)
        return self.number_in(text, child.place_inside(0, len(text)) if text else child.span, f"`{tag}` of {what}")

    def values(self, child: Element, what: str, count: int, known: Iterable[str] = ()) -> tuple[WrittenNumber, ...]:
        """The numbers that stand in an element."""
        return self.numbers_in(self.words(child, known), child.place_inside, what, count, count)

    def is_true(self, element: Element, tag: str, otherwise: bool = False) -> bool:
        """Whether a child says so."""
        child = self.only(element, tag)
        return otherwise if child is None else self.words(child).lower() in TRUE

    def name_in(self, element: Element, tag: str, what: str) -> tuple[str, Element]:
        """The name that a child holds, and that child; the element itself where there is none, which is recorded."""
        child = self.only(element, tag)
        name = self.words(child) if child is not None else ""
        if not name:
            self.wrong(f"{what} has no `{tag}`", f"add <{tag}>...</{tag}>", element.span)
        return name, element if child is None else child

    def pose(self, element: Element | None, what: str) -> AxesPlace:
        """A shift, then turns by yaw about z, pitch about the new y, roll about the newest x; or a quaternion."""
        if element is None or not element.text:
            return AxesPlace()
        known = ("relative_to", "rotation_format", "degrees")
        by_quaternion = element.attributes.get("rotation_format", "euler_rpy") == "quat_xyzw"
        numbers = self.values(element, f"the pose of {what}", 7 if by_quaternion else 6, known)
        if not numbers:
            return AxesPlace()
        x, y, z, *turns = (number.value for number in numbers)
        if by_quaternion:
            if not any(turns):
                self.wrong(f"the quaternion of {what} is 0", "write 0 0 0 1 for no turn", element.span)
                return AxesPlace()
            return AxesPlace((x, y, z), quaternion_axes((turns[3], *turns[:3])))
        degrees = element.attributes.get("degrees", "false").strip().lower() in TRUE
        axes = IDENTITY
        for axis, number in enumerate(numbers[3:]):
            value = number.value * DEGREE if degrees else number.value
            axes = product(turn(axis, WrittenNumber(value, number.text, number.span)), axes)
        return AxesPlace((x, y, z), axes)
