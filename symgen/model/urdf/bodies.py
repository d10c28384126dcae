"""One body for each part that moves: links on fixed joints are added to the link that carries them.

Masses, centres and tensors are added as exact fractions, turned by the matrices of the origins.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from symgen.diagnostics import Notice, Span
from symgen.model.checks.bodies import check_bodies
from symgen.model.expressions.expression import Number
from symgen.model.file.source import Node
from symgen.model.mechanism import INERTIA_ELEMENTS, NO_VECTOR, Body, Inertia, Mechanism
from symgen.model.robots.numbers import IDENTITY
from symgen.model.robots.places import NO_SHIFT, AxesPlace
from symgen.model.robots.solids import PLACES, Solid, body_node, made, matrix_of, together
from symgen.model.urdf.robot import Inertial, Robot, UrdfJoint


@dataclass(frozen=True, slots=True)
class LinkPose:
    """Where a link sits in the axes of the link that carries it."""

    carrier: str
    place: AxesPlace


def placed_links(robot: Robot) -> dict[str, LinkPose]:
    """Every link, parents first; a link that moves by itself, and the root, carry themselves."""
    held: dict[str, list[UrdfJoint]] = {}
    for joint in robot.joints.values():
        held.setdefault(joint.parent, []).append(joint)
    places = {robot.root: LinkPose(robot.root, AxesPlace())}
    waiting = [robot.root]
    for name in waiting:
        pose = places[name]
        for joint in held.get(name, ()):
            waiting.append(joint.child)
            if joint.kind == "fixed":
                inner = AxesPlace(joint.origin.shift, joint.origin.axes)
                places[joint.child] = LinkPose(pose.carrier, pose.place.then(inner))
            else:
                places[joint.child] = LinkPose(joint.child, AxesPlace())
    return {name: places[name] for name in robot.links}


def carried_links(places: dict[str, LinkPose]) -> dict[str, list[str]]:
    """For each carrier the links that move with it: itself first."""
    groups: dict[str, list[str]] = {}
    for name, place in places.items():
        groups.setdefault(place.carrier, []).append(name)
    return {name: sorted(links, key=name.__ne__) for name, links in groups.items()}


def judge_links(robot: Robot) -> Iterator[Notice]:
    """Links on fixed joints whose masses or inertias no body has: the sum is judged like every other body."""
    bodies = []
    groups = carried_links(placed_links(robot)).values()
    for link in (robot.links[name] for links in groups if len(links) > 1 for name in links):
        if link.inertial is not None:
            mass, *entries = (Number(q.value, q.span) for q in (link.inertial.mass, *link.inertial.tensor))
            elements = dict(zip(INERTIA_ELEMENTS, entries, strict=True))
            bodies.append(Body(link.name, link.name, mass, NO_VECTOR, Inertia(**elements), link.inertial.span))
    for report in check_bodies(Mechanism(bodies=tuple(bodies)), {}):
        yield Notice(report.message, report.span)


def body_entries(robot: Robot, links: list[str], places: dict[str, LinkPose]) -> tuple[Node, Span] | None:
    """The body of links that move together, in the axes of the first; None without mass and inertia."""
    solids: list[Solid] = []
    inertials: list[Inertial] = []
    for name in links:
        inertial = robot.links[name].inertial
        if inertial is not None and any(entry.value for entry in (inertial.mass, *inertial.tensor)):
            inertials.append(inertial)
            solids.append(_solid(inertial, places[name].place))
    if not solids:
        return None
    first = inertials[0]
    whole = together(solids)
    as_written = len(solids) == 1 and robot.links[links[0]].inertial is first
    mass = first.mass.node if len(solids) == 1 else made(whole.mass, first.span)
    com = [made(entry, first.span) for entry in whole.com]
    elements = [whole.tensor[row][column] for row, column in PLACES]
    tensor = [made(element, first.span) for element in elements]
    if as_written:
        com = [entry.node for entry in first.origin.xyz] or com
        if first.origin.axes == IDENTITY:
            tensor = [entry.node for entry in first.tensor]
    shown = [element != 0 for element in elements]
    return body_node(mass, com if any(whole.com) else (), tensor, shown, first.span), first.span


def _solid(inertial: Inertial, place: AxesPlace) -> Solid:
    own = Solid(inertial.mass.value, NO_SHIFT, matrix_of([entry.value for entry in inertial.tensor]))
    return own.seen_from(place.then(AxesPlace(inertial.origin.shift, inertial.origin.axes)))
