"""Links and joints of a model as they stand in the file, before a tree is made of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from symgen.diagnostics import Span
from symgen.model.expressions.names import did_you_mean
from symgen.model.robots.machine import MachineLink
from symgen.model.robots.numbers import Vector, WrittenNumber, applied
from symgen.model.robots.places import ALONG_Z, NO_SHIFT, AxesPlace
from symgen.model.robots.solids import Solid, matrix_of
from symgen.model.robots.xml import Element
from symgen.model.sdf.poses import MODEL, Posed, Poses
from symgen.model.sdf.values import ValueReader
from symgen.model.sdf.words import (
    AXIS_READ,
    DYNAMICS,
    JOINT_IDLE,
    JOINT_READ,
    LIMIT_READ,
    LINK_IDLE,
    LINK_READ,
    TENSOR,
    TYPES,
)

# Limits from here on are none.
ENDLESS = 10**16


@dataclass(frozen=True, slots=True)
class SdfMimic:
    """A coordinate is multiplier * (that of `joint` - reference) + offset."""

    joint: str
    axis: str
    multiplier: WrittenNumber | None
    offset: Fraction
    reference: Fraction
    span: Span


@dataclass(frozen=True, slots=True)
class SdfAxis:
    """An axis in the axes of the joint, and what acts along it."""

    direction: Vector
    values: dict[str, WrittenNumber] = field(hash=False)
    mimic: SdfMimic | None = None


@dataclass(frozen=True, slots=True)
class SdfJoint:
    """What connects two links, with its place in the world of the file."""

    name: str
    kind: str
    parent: str
    child: str
    place: AxesPlace
    axes: tuple[SdfAxis, ...]
    span: Span


class PartReader(ValueReader):
    """Reads `link` and `joint`."""

    def link(self, element: Element) -> MachineLink:
        """A link; one without `inertial` has no mass here."""
        name = self.owner = self.text(element, "name", "the link")
        self.attributes(element, ("name",))
        self.parts(element, LINK_READ, LINK_IDLE)
        what = f"the link `{name}`"
        if not self.is_true(element, "gravity", True):
            self._refused_value(element, "gravity", what, "gravity acts on all bodies of a model")
        for tag in ("kinematic", "enable_wind"):
            if self.is_true(element, tag):
                self._refused_value(element, tag, what, "no block of a model has it")
        decay = self.only(element, "velocity_decay")
        for child in decay.children if decay is not None else ():
            if any(part.strip("0.") for part in child.text.split()):
                self.refuse(child, "it is a force", "write it under `forces` of the model file")
        inertial = self.only(element, "inertial")
        solid = None if inertial is None else self._inertial(inertial, what)
        return MachineLink(name, () if solid is None else (solid,), element.place("name"))

    def _refused_value(self, element: Element, tag: str, what: str, why: str) -> None:
        child = self.only(element, tag)
        if child is not None:
            self.refuse(child, f"{why}, and {what} says otherwise", "write what it does under `forces`")

    def _inertial(self, element: Element, what: str) -> Solid | None:
        self.attributes(element, ("auto",))
        if element.attributes.get("auto", "false").strip().lower() in ("true", "1"):
            remedy = "write `mass` and `inertia`"
            self.wrong(f"{what} wants its mass of its shapes, which is not worked out", remedy, element.place("auto"))
            return None
        self.parts(element, ("pose", "mass", "inertia"))
        pose = self.only(element, "pose")
        if pose is not None and pose.attributes.get("relative_to"):
            remedy = "give it in the axes of the link"
            self.wrong(f"`relative_to` in the inertial of {what} is not read", remedy, pose.place("relative_to"))
        place = self.pose(pose, f"the inertial of {what}")
        mass = self.value(element, "mass", f"the inertial of {what}", needed=True)
        tensor = self.only(element, "inertia")
        if tensor is None:
            self.wrong(f"the inertial of {what} has no `inertia`", "add <inertia>...</inertia>", element.span)
            return None
        self.attributes(tensor, ())
        self.parts(tensor, TENSOR)
        inner = f"the inertia of {what}"
        moments = [self.value(tensor, key, inner, needed=True) for key in TENSOR[:3]]
        products = [self.value(tensor, key, inner) for key in TENSOR[3:]]
        if mass is None or None in moments:
            return None
        elements = [Fraction(0) if number is None else number.value for number in (*moments, *products)]
        return Solid(mass.value, NO_SHIFT, matrix_of(elements)).seen_from(place)

    def posed(self, element: Element, otherwise: str, attached: str) -> Posed:
        """The pose of a link, joint or frame, relative to `otherwise` where it does not say to what."""
        pose = self.only(element, "pose")
        name = element.attributes.get("name", "")
        relative = otherwise if pose is None else pose.attributes.get("relative_to", "").strip() or otherwise
        return Posed(relative, self.pose(pose, f"`{name}`"), attached, element.place("name"))

    def joint(self, element: Element, poses: Poses) -> SdfJoint | None:
        """A joint, with its ends as links."""
        name = self.owner = element.attributes.get("name", "").strip()
        self.attributes(element, ("name", "type"))
        self.parts(element, JOINT_READ, JOINT_IDLE)
        what = f"the joint `{name}`"
        kind = self.text(element, "type", what)
        if kind and kind not in TYPES:
            remedy = did_you_mean(kind, TYPES, f"the types that are read are {', '.join(TYPES)}")
            self.wrong(f"{what} has the type `{kind}`, which is not read", remedy, element.place("type"))
            return None
        ends = []
        for tag in ("parent", "child"):
            end, holder = self.name_in(element, tag, what)
            ends.append(poses.link(end, holder.span) if end else "")
        if not kind or not all(ends):
            return None
        if ends[0] == ends[1]:
            message = f"{what} joins the link `{ends[0]}` with itself"
            self.wrong(message, "name two links, `parent` and `child`", element.place("name"))
            return None
        place = poses.place(name, element.span)
        turning = [motion for motion in TYPES[kind] if motion != "spherical"]
        axes = []
        for tag, _ in zip(("axis", "axis2"), turning, strict=False):
            axis = self.only(element, tag)
            if axis is None:
                self.wrong(f"{what} has no `{tag}`", f"add <{tag}><xyz>...</xyz></{tag}>", element.span)
                return None
            axes.append(self._axis(axis, what, kind, place, poses))
        return SdfJoint(name, kind, ends[0], ends[1], place, tuple(axes), element.place("name"))

    def _axis(self, element: Element, what: str, kind: str, place: AxesPlace, poses: Poses) -> SdfAxis:
        self.attributes(element, ())
        self.parts(element, AXIS_READ)
        written, direction = self.only(element, "xyz"), ALONG_Z
        seen_in = MODEL if self.is_true(element, "use_parent_model_frame") else ""
        if written is not None:
            numbers = self.values(written, f"the axis of {what}", 3, ("expressed_in",))
            direction = (numbers[0].value, numbers[1].value, numbers[2].value) if numbers else ALONG_Z
            seen_in = written.attributes.get("expressed_in", "").strip() or seen_in
        if seen_in:
            other = poses.place(seen_in, element.span if written is None else written.span)
            direction = applied(place.inverse.axes, applied(other.axes, direction))
        values = self._limits(self.only(element, "limit"), what, kind)
        dynamics = self.only(element, "dynamics")
        if dynamics is not None:
            self.attributes(dynamics, ())
            self.parts(dynamics, tuple(DYNAMICS))
            read = {name: self.value(dynamics, tag, f"the dynamics of {what}") for tag, name in DYNAMICS.items()}
            values |= {name: number for name, number in read.items() if number is not None}
        return SdfAxis(direction, values, self._mimic(self.only(element, "mimic"), what))

    def _limits(self, limit: Element | None, what: str, kind: str) -> dict[str, WrittenNumber]:
        if limit is None:
            return {}
        self.attributes(limit, ())
        self.parts(limit, LIMIT_READ)
        values: dict[str, WrittenNumber] = {}
        for key in ("lower", "upper", "velocity", "effort"):
            child = self.only(limit, key)
            if child is None or _is_endless(child.text):
                continue
            value = self.value(limit, key, f"the limit of {what}")
            if value is not None:
                values[key] = value
        effort = values.pop("effort", None)
        if effort is not None and effort.value > 0:
            self.leave_out("effort", self.owner)
        if kind == "continuous" or not {"lower", "upper"} <= set(values):
            values = {key: value for key, value in values.items() if key == "velocity"}
        return values

    def _mimic(self, element: Element | None, what: str) -> SdfMimic | None:
        if element is None:
            return None
        self.attributes(element, ("joint", "axis"))
        self.parts(element, ("multiplier", "offset", "reference"))
        inner = f"the mimic of {what}"
        leader = self.text(element, "joint", inner)
        multiplier, offset, reference = (
            self.value(element, tag, inner) for tag in ("multiplier", "offset", "reference")
        )
        axis = element.attributes.get("axis", "axis").strip()
        zero = Fraction(0)
        start = zero if offset is None else offset.value
        middle = zero if reference is None else reference.value
        return SdfMimic(leader, axis, multiplier, start, middle, element.span)


def _is_endless(text: str) -> bool:
    """Whether a limit is none, as 1.79769e+308 and inf are."""
    try:
        return abs(float(text)) >= ENDLESS
    except ValueError:
        return False
