"""The tree of bodies: their places, masses, joints, and the sites that equalities name."""

from __future__ import annotations

from dataclasses import dataclass

from symgen.diagnostics import Span
from symgen.model.mechanism import WORLD
from symgen.model.mjcf.geoms import placed_geom, read_geom, read_inertial
from symgen.model.mjcf.joints import JointReader
from symgen.model.mjcf.words import BODY, FRAME, GEOM, IDLE_PARTS, INERTIAL, REFUSED_PARTS, SITE
from symgen.model.robots.machine import MachineJoint, MachineLink
from symgen.model.robots.places import AxesPlace
from symgen.model.robots.reader import MAXIMUM_LINKS
from symgen.model.robots.solids import Solid
from symgen.model.robots.xml import Element

PARTS = ("inertial", "joint", "freejoint", "geom", "site", "body", "frame")


@dataclass(slots=True)
class _OpenBody:
    """A body while its parts are read; frames inside of it move and turn them."""

    name: str
    place: AxesPlace
    span: Span
    inertial: Element | None
    solids: list[Solid]
    joints: list[MachineJoint]
    inner: list[tuple[Element, AxesPlace, str]]


class BodyReader(JointReader):
    """Reads `worldbody` into links and joints."""

    def __init__(self, unread: frozenset[str]) -> None:
        super().__init__(unread)
        self.links: dict[str, MachineLink] = {}
        self.joints: list[MachineJoint] = []
        self.sites: dict[str, tuple[str, AxesPlace]] = {}
        self.poses: dict[str, AxesPlace] = {WORLD: AxesPlace()}
        self._count = 0

    def read_world(self, element: Element) -> None:
        """All bodies on the world, parents first."""
        self.attributes(element, BODY)
        world = _OpenBody(WORLD, AxesPlace(), element.span, None, [], [], [])
        self._parts(element, world, AxesPlace(), element.attributes.get("childclass", ""))
        self.links.setdefault(WORLD, MachineLink(WORLD, (), element.span))
        waiting = [(WORLD, *part) for part in reversed(world.inner)]
        while waiting:
            parent, part, place, inherited = waiting.pop()
            body = self._body(parent, part, place, inherited)
            waiting += [(body.name, *inner) for inner in reversed(body.inner)]
            if len(self.links) > MAXIMUM_LINKS:
                message = f"the model has more than {MAXIMUM_LINKS} bodies"
                self.wrong(message, "import the part of it that moves", part.span)
                return

    def _body(self, parent: str, element: Element, outer: AxesPlace, inherited: str) -> _OpenBody:
        self._count += 1
        name = element.attributes.get("name", "").strip() or f"body_{self._count}"
        self.owner = name
        what = f"the body `{name}`"
        settings = self.settings(element, MAIN_ONLY, BODY, "body")
        why = "symgen does not move bodies from outside", "give it joints, or remove it"
        self.zero_or(settings, "mocap", what, *why)
        self.zero_or(settings, "gravcomp", what, "gravity acts on all bodies of a model", "write `forces` instead")
        if name in self.links:
            self.twice("body", element, self.links[name].span)
        place = outer.then(self.place(settings, what))
        span = element.place("name") if "name" in element.attributes else element.span
        body = _OpenBody(name, place, span, self.only(element, "inertial"), [], [], [])
        self.poses[name] = self.poses[parent].then(place)
        self._parts(element, body, AxesPlace(), element.attributes.get("childclass", inherited))
        self._enter(parent, body)
        return body

    def _parts(self, element: Element, body: _OpenBody, outer: AxesPlace, inherited: str) -> None:
        """What stands in a body, or in a frame inside of it."""
        whose = f"of `{body.name}`"
        for child in element.children:
            if child.tag == "body":
                body.inner.append((child, outer, inherited))
            elif child.tag == "frame":
                self._frame(child, body, outer, inherited)
            elif child.tag in IDLE_PARTS:
                self.leave_out(child.tag, child.attributes.get("name", ""))
            elif child.tag in REFUSED_PARTS:
                self.refuse(child, *REFUSED_PARTS[child.tag])
            elif child.tag == "site":
                settings = self.settings(child, inherited, SITE)
                place = placed_geom(self, settings, f"a site {whose}", settings.get("type", "sphere"))
                self.sites[settings.get("name")] = body.name, outer.then(place)
            elif child.tag == "geom":
                self._geom(child, body, outer, inherited)
            elif child.tag == "inertial" and body.name != WORLD:
                if self.compiler.from_geoms != "true":
                    solid = read_inertial(self, self.settings(child, "", INERTIAL), f"the inertial {whose}")
                    body.solids += [] if solid is None else [solid.seen_from(outer)]
            elif child.tag in ("joint", "freejoint") and body.name != WORLD:
                free = child.tag == "freejoint"
                joint = self.joint(child, inherited, body.name, len(body.joints), outer, free)
                body.joints += [] if joint is None else [joint]
            else:
                self.unknown_child(child, PARTS, element.tag)

    def _frame(self, element: Element, body: _OpenBody, outer: AxesPlace, inherited: str) -> None:
        settings = self.settings(element, MAIN_ONLY, FRAME)
        place = outer.then(self.place(settings, f"a frame of `{body.name}`"))
        self._parts(element, body, place, element.attributes.get("childclass", inherited))

    def _geom(self, element: Element, body: _OpenBody, outer: AxesPlace, inherited: str) -> None:
        settings = self.settings(element, inherited, GEOM)
        named = settings.get("name")
        self.left_out.setdefault("contact", [])
        needed = body.inertial is None or self.compiler.from_geoms == "true"
        if body.name != WORLD and needed and self.compiler.from_geoms != "false":
            what = f"the geom `{named}`" if named else f"a geom of `{body.name}`"
            solid = read_geom(self, settings, what)
            body.solids += [] if solid is None else [solid.seen_from(outer)]
        else:
            self.leave_out("geom", named or body.name)

    def _enter(self, parent: str, body: _OpenBody) -> None:
        """The body behind its joints, one after the other; between them stand links without a name."""
        link = MachineLink(body.name, tuple(body.solids), body.span)
        place = body.place
        if not body.joints:
            self.joints.append(
                MachineJoint(f"{body.name} on {parent}", "fixed", parent, body.name, place, AxesPlace(), body.span)
            )
        for number, joint in enumerate(body.joints, 1):
            last = number == len(body.joints)
            child = body.name if last else f"{joint.name} of {body.name}"
            if not last:
                self.links[child] = MachineLink(child, (), joint.span, True)
            self.joints.append(self.between(joint, parent, child, place))
            parent, place = child, AxesPlace()
        self.links.setdefault(body.name, link)


# bodies and frames have no default classes of their own
MAIN_ONLY = "main"
