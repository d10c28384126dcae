"""From the elements of a robot description to its links and joints; what is not understood is a mistake, by name."""

from __future__ import annotations

from collections.abc import Iterable

from symgen.diagnostics import Mistake
from symgen.model.expressions.names import did_you_mean
from symgen.model.robots.numbers import WrittenNumber
from symgen.model.robots.reader import MAXIMUM_LINKS, ElementReader
from symgen.model.robots.xml import Element
from symgen.model.urdf.robot import KINDS, Inertial, Link, Mimic, Origin, Robot, UrdfJoint

TENSOR = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
LIMITS = ("lower", "upper", "velocity", "effort", "acceleration")
# what says nothing about the mechanics; each is told to the user
GEOMETRY = ("visual", "collision")
LEFT_OUT = {
    "robot": ("material", "transmission", "ros2_control", "gazebo", "sensor"),
    "link": (*GEOMETRY, "sensor", "self_collision_checking", "contact"),
    "joint": ("safety_controller", "calibration", "hardwareInterface"),
}
# parts of the extensions above that would change the motion
MECHANICAL = {
    "motorInertia": "add `rotor_inertias: {joint: J*ratio**2}` to the model file",
    "rotorInertia": "add `rotor_inertias: {joint: J*ratio**2}` to the model file",
    "joint": "close loops with `loops` of the model file",
    "springStiffness": "write it under `springs` of the model file",
    "springReference": "write it under `springs` of the model file",
    "gravity": "gravity acts on all bodies of a model",
    "turnGravityOff": "gravity acts on all bodies of a model",
}


def read_robot(root: Element, unread: frozenset[str]) -> tuple[Robot, tuple[Mistake, ...]]:
    """The robot as far as it is understood, and every mistake; `unread` is what the user wants left out, by name."""
    reading = _RobotReader(unread)
    robot = reading.robot(root)
    return robot, tuple(reading.mistakes)


class _RobotReader(ElementReader):
    def __init__(self, unread: frozenset[str]) -> None:
        super().__init__("URDF", unread)

    def robot(self, root: Element) -> Robot:
        if root.tag != "robot":
            self.wrong(f"a robot description is a `robot`, this is a `{root.tag}`", "give a URDF file", root.span)
            return Robot({}, {}, {})
        self.attributes(root, ("name", "version"))
        self.owner = root.attributes.get("name", "")
        self._children(root, ("link", "joint"), "robot")
        if len(root.all("link")) > MAXIMUM_LINKS or len(root.all("joint")) > MAXIMUM_LINKS:
            message = f"the robot has more than {MAXIMUM_LINKS} links or joints"
            self.wrong(message, "import the part of it that moves", root.span)
            return Robot({}, {}, {})
        links: dict[str, Link] = {}
        for element in root.all("link"):
            link = self._link(element)
            if link.name in links:
                self.twice("link", element, links[link.name].span)
            links.setdefault(link.name, link)
        joints: dict[str, UrdfJoint] = {}
        for element in root.all("joint"):
            joint = self._joint(element)
            if joint is not None and joint.name in joints:
                self.twice("joint", element, joints[joint.name].span)
            if joint is not None:
                joints.setdefault(joint.name, joint)
        return Robot(links, joints, {tag: tuple(names) for tag, names in self.left_out.items()})

    def _link(self, element: Element) -> Link:
        self.owner = element.attributes.get("name", "")
        self.attributes(element, ("name", "type"))
        self._children(element, ("inertial",), "link")
        name = self.text(element, "name", "the link")
        inertial = self.only(element, "inertial")
        return Link(name, None if inertial is None else self._inertial(inertial, name), element.place("name"))

    def _inertial(self, element: Element, link: str) -> Inertial | None:
        self.attributes(element, ())
        self._children(element, ("origin", "mass", "inertia"), "inertial")
        origin = self._origin(element)
        mass, tensor = self.only(element, "mass"), self.only(element, "inertia")
        for part, child in (("mass", mass), ("inertia", tensor)):
            if child is None:
                self.wrong(f"the inertial of the link `{link}` has no `{part}`", f"add <{part} .../>", element.span)
        if mass is None or tensor is None:
            return None
        self.attributes(mass, ("value",))
        self.attributes(tensor, TENSOR)
        value = self.number(mass, "value", f"the mass of `{link}`", needed=True)
        entries = [self.number(tensor, name, f"the inertia of `{link}`", needed=True) for name in TENSOR]
        known = tuple(entry for entry in entries if entry is not None)
        return None if value is None or len(known) < len(TENSOR) else Inertial(origin, value, known, element.span)

    def _joint(self, element: Element) -> UrdfJoint | None:
        self.owner = element.attributes.get("name", "")
        self.attributes(element, ("name", "type"))
        self._children(element, ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"), "joint")
        name = self.text(element, "name", "the joint")
        kind = self.text(element, "type", f"the joint `{name}`")
        if kind and kind not in KINDS:
            remedy = did_you_mean(kind, KINDS, f"the types are {', '.join(KINDS)}")
            self.wrong(f"the joint `{name}` has the unknown type `{kind}`", remedy, element.place("type"))
        ends = []
        for end in ("parent", "child"):
            part = self.only(element, end)
            if part is None:
                self.wrong(f"the joint `{name}` has no `{end}`", f'add <{end} link="..."/>', element.span)
                continue
            self.attributes(part, ("link",))
            ends.append(self.text(part, "link", f"the {end} of the joint `{name}`"))
        origin, axis = self._origin(element), self.only(element, "axis")
        direction: tuple[WrittenNumber, ...] = ()
        if axis is not None:
            self.attributes(axis, ("xyz",))
            direction = self.vector(axis, "xyz", f"the axis of the joint `{name}`")
        limits = self._numbers(element, "limit", LIMITS, name)
        dynamics = self._numbers(element, "dynamics", ("damping", "friction"), name)
        mimic = self._mimic(element, name)
        if kind not in KINDS or len(ends) < 2:
            return None
        span = element.place("name")
        return UrdfJoint(name, kind, ends[0], ends[1], origin, direction, limits, dynamics, mimic, span)

    def _mimic(self, element: Element, name: str) -> Mimic | None:
        part = self.only(element, "mimic")
        if part is None:
            return None
        self.attributes(part, ("joint", "multiplier", "offset"))
        multiplier, offset = (
            self.number(part, key, f"the mimic of the joint `{name}`") for key in ("multiplier", "offset")
        )
        return Mimic(self.text(part, "joint", f"the mimic of `{name}`"), multiplier, offset, part.place("joint"))

    def _origin(self, element: Element) -> Origin:
        part = self.only(element, "origin")
        if part is None:
            return Origin()
        self.attributes(part, ("xyz", "rpy"))
        xyz, rpy = (self.vector(part, key, f"`{key}` of the origin") for key in ("xyz", "rpy"))
        return Origin(xyz, rpy)

    def _numbers(self, element: Element, tag: str, keys: tuple[str, ...], joint: str) -> dict[str, WrittenNumber]:
        part = self.only(element, tag)
        if part is None:
            return {}
        self.attributes(part, keys)
        numbers = {key: self.number(part, key, f"the {tag} of the joint `{joint}`") for key in keys}
        return {key: value for key, value in numbers.items() if value is not None}

    def _children(self, element: Element, known: Iterable[str], what: str) -> None:
        for child in element.children:
            if child.tag in known:
                continue
            if child.tag in LEFT_OUT.get(what, ()) or child.tag in self.unread:
                self._leave_out(child)
            elif child.tag.startswith("xacro:"):
                remedy = "this is xacro, from which URDF is made: run `xacro robot.xacro > robot.urdf`"
                self.wrong(f"`{child.tag[:60]}` is no part of a `{what}`", remedy, child.span)
            else:
                self.unknown_child(child, known, what)

    def _leave_out(self, element: Element) -> None:
        name = element.attributes.get("name") or element.attributes.get("reference") or self.owner
        self.leave_out(element.tag, name)
        drawn = element.tag in (*GEOMETRY, "sensor", "material")
        inside = [] if drawn or element.tag in self.unread else list(element.children)
        while inside:
            part = inside.pop()
            # most extensions name the joints that they are about; one with a type or parts is a further joint
            names_a_joint = part.tag == "joint" and "type" not in part.attributes and not part.all("parent")
            if part.tag in MECHANICAL and part.tag not in self.unread and not names_a_joint:
                remedy = f"{MECHANICAL[part.tag]}; {self.leaving_out(part.tag)}"
                self.wrong(f"`{part.tag}` in `{element.tag}` is not read", remedy, part.span)
            inside += part.children
