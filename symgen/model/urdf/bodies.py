"""One body for each part that moves: links on fixed joints are added to the link that carries them.

Masses, centres and tensors are added as exact fractions, turned by the matrices of the origins.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from symgen.diagnostics import Notice, Span
from symgen.model.checks.bodies import check_bodies
from symgen.model.expressions.expression import Number
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode
from symgen.model.kinematics.triples import plus, transposed
from symgen.model.mechanism import INERTIA_ELEMENTS, NO_VECTOR, Body, Inertia, Mechanism
from symgen.model.urdf.numbers import IDENTITY, Matrix, Vector, applied, product, written
from symgen.model.urdf.robot import Inertial, Robot, UrdfJoint

# Exactly 0, where sums of exact numbers begin.
ZERO = Fraction(0)
NOWHERE: Vector = (ZERO, ZERO, ZERO)
# where the elements xx, yy, zz, xy, xz, yz stand in the matrix
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


@dataclass(frozen=True, slots=True)
class Solid:
    """Mass, centre of mass and the tensor about it, in the axes of one link."""

    mass: Fraction
    com: Vector
    tensor: Matrix


@dataclass(frozen=True, slots=True)
class LinkPose:
    """Where a link sits in the axes of the link that carries it."""

    carrier: str
    shift: Vector
    axes: Matrix


def placed_links(robot: Robot) -> dict[str, LinkPose]:
    """Every link, parents first; a link that moves by itself, and the root, carry themselves."""
    held: dict[str, list[UrdfJoint]] = {}
    for joint in robot.joints.values():
        held.setdefault(joint.parent, []).append(joint)
    places = {robot.root: LinkPose(robot.root, NOWHERE, IDENTITY)}
    waiting = [robot.root]
    for name in waiting:
        place = places[name]
        for joint in held.get(name, ()):
            waiting.append(joint.child)
            if joint.kind == "fixed":
                shift = plus(place.shift, applied(place.axes, joint.origin.shift))
                places[joint.child] = LinkPose(place.carrier, shift, product(place.axes, joint.origin.axes))
            else:
                places[joint.child] = LinkPose(joint.child, NOWHERE, IDENTITY)
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
            solids.append(_solid(inertial, places[name].shift, places[name].axes))
    if not solids:
        return None
    first = inertials[0]
    whole = _together(solids)
    as_written = len(solids) == 1 and robot.links[links[0]].inertial is first
    mass = first.mass.node if len(solids) == 1 else _made(whole.mass, first.span)
    com = [_made(entry, first.span) for entry in whole.com]
    tensor = [_made(whole.tensor[row][column], first.span) for row, column in PLACES]
    if as_written:
        com = [entry.node for entry in first.origin.xyz] or com
        if first.origin.axes == IDENTITY:
            tensor = [entry.node for entry in first.tensor]
    entries: list[tuple[ScalarNode, Node]] = [(_key("mass", first.span), mass)]
    if any(whole.com):
        entries.append((_key("com", first.span), SequenceNode(tuple(com), first.span)))
    elements = [
        (_key(name, first.span), node)
        for name, node, (row, column) in zip(INERTIA_ELEMENTS, tensor, PLACES, strict=True)
        if whole.tensor[row][column] != 0
    ]
    if elements:
        entries.append((_key("inertia", first.span), MappingNode(tuple(elements), first.span, True)))
    return MappingNode(tuple(entries), first.span, True), first.span


def _solid(inertial: Inertial, shift: Vector, axes: Matrix) -> Solid:
    xx, yy, zz, xy, xz, yz = (entry.value for entry in inertial.tensor)
    turned = product(axes, inertial.origin.axes)
    tensor: Matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    com = plus(shift, applied(axes, inertial.origin.shift))
    return Solid(inertial.mass.value, com, product(product(turned, tensor), transposed(turned)))


def _together(solids: list[Solid]) -> Solid:
    """One body of several: the tensors about the common centre by Steiner's theorem."""
    if len(solids) == 1:
        return solids[0]
    mass = sum((solid.mass for solid in solids), ZERO)
    moments = [sum((solid.mass * solid.com[axis] for solid in solids), ZERO) for axis in range(3)]
    x, y, z = ((moment / mass if mass else ZERO) for moment in moments)
    rows = [[ZERO] * 3 for _ in range(3)]
    for solid in solids:
        arm = (solid.com[0] - x, solid.com[1] - y, solid.com[2] - z)
        square = sum((entry * entry for entry in arm), ZERO)
        for row in range(3):
            for column in range(3):
                steiner = (square if row == column else ZERO) - arm[row] * arm[column]
                rows[row][column] += solid.tensor[row][column] + solid.mass * steiner
    first, second, third = ((row[0], row[1], row[2]) for row in rows)
    return Solid(mass, (x, y, z), (first, second, third))


def _made(value: Fraction, span: Span) -> ScalarNode:
    return ScalarNode(written(value), span, "", False)


def _key(text: str, span: Span) -> ScalarNode:
    return ScalarNode(text, span, "", False)
