"""What closes loops and couples joints, and the inputs that motors are."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from symgen.model.expressions.names import did_you_mean
from symgen.model.mechanism import WORLD
from symgen.model.mjcf.bodies import BodyReader
from symgen.model.mjcf.settings import ACTUATORS, SERVO_DEFAULT, Settings
from symgen.model.mjcf.words import ACTUATOR, EQUALITY, GENERAL, REFUSED_EQUALITIES, SERVO, TORQUE
from symgen.model.robots.machine import ENDINGS, Closing, Drive, Follower, MachineJoint, computed
from symgen.model.robots.numbers import Vector
from symgen.model.robots.places import AxesPlace, quaternion_axes
from symgen.model.robots.reader import MAXIMUM_LINKS
from symgen.model.robots.xml import Element

# a joint that follows another one as MuJoCo has it where nothing else is said
FOLLOWING = (Fraction(0), Fraction(1))


class EqualityReader(BodyReader):
    """Reads `equality` and `actuator`, after the bodies."""

    def __init__(self, unread: frozenset[str]) -> None:
        super().__init__(unread)
        self.closings: list[Closing] = []
        self.followers: list[Follower] = []
        self.drives: list[Drive] = []

    def read_equalities(self, element: Element) -> None:
        """Rows that hold, but those that are switched off."""
        for name, child in self._entries(element):
            if child.tag in REFUSED_EQUALITIES:
                self.refuse(child, *REFUSED_EQUALITIES[child.tag])
            elif child.tag == "joint":
                known = (*EQUALITY, "joint1", "joint2", "polycoef")
                settings = self.settings(child, "", known, "equality")
                self._follower(settings, name)
            elif child.tag in ("connect", "weld"):
                more = ("anchor",) if child.tag == "connect" else ("anchor", "relpose", "torquescale")
                known = (*EQUALITY, "body1", "body2", "site1", "site2", *more)
                self._closing(self.settings(child, "", known, "equality"), name)
            else:
                self.unknown_child(child, ("connect", "weld", "joint"), "equality")

    def _entries(self, element: Element) -> Iterator[tuple[str, Element]]:
        """Each with its name, to which mistakes belong until the next; none of too many."""
        if len(element.children) > MAXIMUM_LINKS:
            what = f"`{element.tag}` has more than {MAXIMUM_LINKS} entries"
            self.wrong(what, "remove what does not act", element.span)
            return
        for number, child in enumerate(element.children, 1):
            self.owner = child.attributes.get("name", "").strip() or f"{child.tag}_{number}"
            yield self.owner, child

    def _is_active(self, settings: Settings, name: str) -> bool:
        active = settings.get("active", "true") == "true"
        if not active:
            self.leave_out(f"{settings.element.tag}, which is not active,", name)
        return active

    def _follower(self, settings: Settings, name: str) -> None:
        what = f"the equality `{name}`"
        one = self._single_joint(settings, "joint1", what)
        other = self._single_joint(settings, "joint2", what) if settings.has("joint2") else None
        given = self.numbers(settings, "polycoef", what, 1, 5)
        if not self._is_active(settings, name) or one is None or (other is None and settings.has("joint2")):
            return
        span = settings.element.span
        coefficients = given or tuple(computed(value, span) for value in FOLLOWING)
        coefficients += tuple(computed(value, span) for value in FOLLOWING[len(coefficients) :])
        leader, leader_offset = ("", Fraction(0)) if other is None else (other.name, other.start[0])
        self.followers.append(Follower(name, one.name, leader, coefficients, one.start[0], leader_offset, span))

    def _closing(self, settings: Settings, name: str) -> None:
        what, kind = f"the equality `{name}`", settings.element.tag
        by_sites = settings.has("site1") or settings.has("site2")
        ends = [self._end(settings, f"{'site' if by_sites else 'body'}{number}", what) for number in (1, 2)]
        if not by_sites and kind == "connect" and not settings.has("anchor"):
            self.wrong(f"{what} has no `anchor`", 'add anchor="..."', settings.element.span)
        anchor = self._vector(settings, "anchor", what, AxesPlace().shift)
        relative = self._relative(settings, what)
        first, second = ends
        if not self._is_active(settings, name) or first is None or second is None:
            return
        if not by_sites:
            first, second = self._assembled(kind, first[0], second[0], anchor, relative)
        type_name = "point" if kind == "connect" else "fixed"
        span = settings.element.place("name") if "name" in settings.element.attributes else settings.element.span
        self.closings.append(Closing(name, type_name, (first[0], second[0]), (first[1], second[1]), span))

    def _assembled(
        self, kind: str, one: str, other: str, anchor: Vector, relative: AxesPlace | None
    ) -> tuple[tuple[str, AxesPlace], tuple[str, AxesPlace]]:
        """Both ends where they meet in the configuration of the file."""
        between = self.poses[one].inverse.then(self.poses[other])
        if kind == "weld":
            return (one, relative or between), (other, AxesPlace())
        return (one, AxesPlace(anchor)), (other, AxesPlace(between.inverse.point(anchor)))

    def _relative(self, settings: Settings, what: str) -> AxesPlace | None:
        """The place of the second body of a weld in the first; None for that of the configuration of the file."""
        numbers = [number.value for number in self.numbers(settings, "relpose", what, 7, 7)]
        if not any(numbers[3:]):
            return None
        return AxesPlace((numbers[0], numbers[1], numbers[2]), quaternion_axes(numbers[3:]))

    def _end(self, settings: Settings, key: str, what: str) -> tuple[str, AxesPlace] | None:
        name = settings.get(key, WORLD if key == "body2" else "")
        noun = key.rstrip("12")
        known = self.sites if noun == "site" else self.poses
        if name and name in known:
            return self.sites[name] if noun == "site" else (name, AxesPlace())
        others = [other for other in known if other][:MAXIMUM_LINKS]
        remedy = did_you_mean(name, others, f"name a {noun} of this file")
        place = settings.owner(key).place(key) if settings.has(key) else settings.element.span
        message = f"the {noun} `{name}` of {what} does not exist" if name else f"{what} has no `{key}`"
        self.wrong(message, remedy, place)
        return None

    def _single_joint(self, settings: Settings, key: str, what: str) -> MachineJoint | None:
        """A joint with one coordinate."""
        name = settings.get(key)
        single = {joint.name: joint for joint in self.joints if len(ENDINGS[joint.kind]) == 1}
        if name in single:
            return single[name]
        remedy = did_you_mean(name, single, "name a hinge or a slide")
        place = settings.owner(key).place(key) if settings.has(key) else settings.element.span
        message = f"`{name}` of {what} is no joint with one coordinate" if name else f"{what} has no `{key}`"
        self.wrong(message, remedy, place)
        return None

    def read_actuators(self, element: Element) -> None:
        """Motors at joints; what is no force is refused."""
        for name, child in self._entries(element):
            if child.tag not in ACTUATORS:
                self.refuse(child, SERVO, TORQUE)
                continue
            if child.tag in self.unread:
                self.leave_out(child.tag, name)
                continue
            others = [key for key in _TRANSMISSIONS if key in child.attributes]
            for key in others:
                remedy = f"write it as an input in the model file; {self.leaving_out(child.tag)}"
                self.wrong(f"`{key}` of the actuator `{name}` is not read", remedy, child.place(key))
            if not others:
                self._drive(self.settings(child, "", (*ACTUATOR, *GENERAL), "general"), name)

    def _drive(self, settings: Settings, name: str) -> None:
        what = f"the actuator `{name}`"
        joint = self._single_joint(settings, "joint", what)
        for key in ("armature", "damping"):
            self.zero_or(settings, key, what, "it acts beside the input", "write it at the joint")
        gear = self.numbers(settings, "gear", what, 1, 6)
        gain = Fraction(1)
        if settings.element.tag == "general":
            for key in ("gaintype", "biastype", "dyntype"):
                if settings.get(key, _PLAIN[key]) != _PLAIN[key]:
                    place = settings.owner(key).place(key)
                    self.wrong(f"`{key}` of {what} is not read: {SERVO}", TORQUE, place)
            if settings.has(SERVO_DEFAULT):
                servo = settings.owner(SERVO_DEFAULT)
                self.wrong(f"{what} has a default that makes it a `{servo.tag}`: {SERVO}", TORQUE, servo.span)
            numbers = self.numbers(settings, "gainprm", what, 1, 7)
            gain = numbers[0].value if numbers else gain
        for key in ("ctrlrange", "forcerange"):
            if settings.has(key):
                self.leave_out(key, name)
        if joint is None:
            return
        span = settings.element.place("name") if "name" in settings.element.attributes else settings.element.span
        factor = (gear[0].value if gear else Fraction(1)) * gain
        written = gear[0] if gear and gain == 1 else computed(factor, span)
        self.drives.append(Drive(name, joint.name, written, span))


_TRANSMISSIONS = ("jointinparent", "tendon", "site", "refsite", "body", "cranksite", "slidersite", "cranklength")
_PLAIN = {"gaintype": "fixed", "biastype": "none", "dyntype": "none"}
