"""Joints of bodies: where their axes are, and what acts in them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.names import did_you_mean
from symgen.model.mechanism import WORLD
from symgen.model.mjcf.settings import Settings, SettingsReader
from symgen.model.mjcf.words import JOINT
from symgen.model.robots.machine import MachineJoint, computed
from symgen.model.robots.numbers import IDENTITY, Vector, WrittenNumber, applied
from symgen.model.robots.places import ALONG_Z, NO_SHIFT, UPRIGHT, AxesPlace, quaternion_of, turned_about, unit
from symgen.model.robots.xml import Element

KINDS = {"hinge": "revolute", "slide": "prismatic", "ball": "spherical", "free": "floating"}
# attributes of forces in a joint, by what they are here
FORCES = {"damping": "viscous", "frictionloss": "dry", "armature": "rotor", "stiffness": "stiffness"}


class JointReader(SettingsReader):
    """Reads `joint` and `freejoint`."""

    def joint(
        self, element: Element, inherited: str, body: str, number: int, outer: AxesPlace, free: bool
    ) -> MachineJoint | None:
        """A joint in the axes of its body: `place` holds its anchor, `rest` the body seen from there; its ends are
        those that `between` gives it."""
        known = ("name", "group", "align") if free else JOINT
        settings = self.settings(element, inherited, known, "freejoint" if free else "joint")
        kind = "free" if free else settings.get("type", "hinge")
        name = settings.get("name") or f"{body}_{'free' if kind == 'free' else 'joint'}{number + 1 if number else ''}"
        what = f"the joint `{name}`"
        if kind not in KINDS:
            remedy = did_you_mean(kind, KINDS, f"the types are {', '.join(KINDS)}")
            self.wrong(f"{what} has the unknown type `{kind}`", remedy, settings.owner("type").place("type"))
            return None
        span = element.place("name") if "name" in element.attributes else element.span
        self.zero_or(settings, "align", what, "it would choose other axes for the body", 'write align="false"')
        values = self._values(settings, kind, what)
        axis = self._vector(settings, "axis", what, ALONG_Z)
        anchor = outer.point(self._vector(settings, "pos", what, NO_SHIFT))
        joint = MachineJoint(name, KINDS[kind], WORLD, body, AxesPlace(anchor), AxesPlace(), span, values=values)
        back = AxesPlace((-anchor[0], -anchor[1], -anchor[2]))
        if kind == "ball":
            return replace(joint, rest=back, start=UPRIGHT)
        if kind == "free":
            return replace(joint, place=AxesPlace(), start=UPRIGHT)
        axis = applied(outer.axes, axis)
        start = self._reference(settings, "ref", kind, what)
        x, y, z = unit(axis) if any(axis) else axis
        if kind == "slide":
            rest = AxesPlace((-start.value * x, -start.value * y, -start.value * z))
            return replace(joint, place=AxesPlace(), rest=rest, axis=axis, start=(start.value,))
        turned = AxesPlace(NO_SHIFT, turned_about(axis, -start.value) if any(axis) and start.value else IDENTITY)
        return replace(joint, rest=turned.then(back), axis=axis, start=(start.value,))

    def between(self, joint: MachineJoint, parent: str, child: str, place: AxesPlace) -> MachineJoint:
        """The joint of a body that has this place in the parent; what moves freely starts there."""
        if joint.kind != "floating":
            return replace(joint, parent=parent, child=child, place=place.then(joint.place))
        if parent != WORLD:
            self.wrong(f"the joint `{joint.name}` is free, and its body is not on the world",
                       "move the body to `worldbody`, or give it three slides and a ball", joint.span)  # fmt: skip
        return replace(joint, parent=parent, child=child, start=(*place.shift, *quaternion_of(place)))

    def _values(self, settings: Settings, kind: str, what: str) -> dict[str, WrittenNumber]:
        remedy = "write its forces under `forces` in the model file"
        for key in ("springdamper", "actuatorgravcomp", "springyield"):
            self.zero_or(settings, key, what, "no block of a model has it", remedy)
        for key in ("actuatorfrcrange", *(("range",) if kind == "ball" else ())):
            if settings.has(key):
                self.leave_out(key, self.owner)
        if kind in ("ball", "free"):
            for key in FORCES:
                why = "it acts in several directions at once"
                self.zero_or(settings, key, what, why, f"set it to 0 for this joint, and {remedy}")
            return {}
        values = {name: self.first(settings, key, what) for key, name in FORCES.items() if settings.has(key)}
        if "stiffness" in values:
            values["unstretched"] = self._reference(settings, "springref", kind, what)
        limits = self.numbers(settings, "range", what, 2, 2)
        limited = settings.get("limited", "auto")
        orderly = len(limits) == 2 and limits[0].value < limits[1].value
        automatic = limited == "auto" and self.compiler.auto_limits and orderly
        if limits and (limited == "true" or automatic):
            ends = [self.angle(end) if kind == "hinge" else end for end in limits]
            values |= dict(zip(("lower", "upper"), ends, strict=True))
        return {name: value for name, value in values.items() if value is not None}

    def _reference(self, settings: Settings, key: str, kind: str, what: str) -> WrittenNumber:
        given = self.single(settings, key, what)
        if given is None:
            return computed(Fraction(0), settings.element.span)
        return self.angle(given) if kind == "hinge" else given

    def _vector(self, settings: Settings, key: str, what: str, otherwise: Vector) -> Vector:
        numbers = self.numbers(settings, key, what)
        return (numbers[0].value, numbers[1].value, numbers[2].value) if numbers else otherwise
