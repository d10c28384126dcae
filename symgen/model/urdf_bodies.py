"""One body for each part that moves: links on fixed joints are added to the link that carries them.

Masses, centres and tensors are added as exact fractions, turned by the matrices of the origins.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from symgen.diagnostics import Notice, Span
from symgen.model.body_checks import check_bodies
from symgen.model.expression import Number
from symgen.model.mechanism import INERTIA_ELEMENTS, NO_VECTOR, Body, Inertia, Mechanism
from symgen.model.source import MappingNode, Node, ScalarNode, SequenceNode
from symgen.model.urdf_numbers import (
    IDENTITY,
    Matrix,
    Vector,
    added,
    applied,
    product,
    transposed,
    written,
)
from symgen.model.urdf_robot import Inertial, Robot

ZERO = Fraction(0)
# where the elements xx, yy, zz, xy, xz, yz stand in the matrix
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


@dataclass(frozen=True, slots=True)
class Solid:
    """Mass, centre of mass and the tensor about it, in the axes of one link."""

    mass: Fraction
    com: Vector
    tensor: Matrix


def judge_links(robot: Robot) -> Iterator[Notice]:
    """Links on fixed joints whose masses or inertias no body has: the sum is judged like every other body."""
    bodies = []
    for link in (robot.links[name] for links in carried_links(robot).values() if len(links) > 1 for name in links):
        if link.inertial is not None:
            mass, *entries = (Number(q.value, q.span) for q in (link.inertial.mass, *link.inertial.tensor))
            elements = dict(zip(INERTIA_ELEMENTS, entries, strict=True))
            bodies.append(Body(link.name, link.name, mass, NO_VECTOR, Inertia(**elements), link.inertial.span))
    for mistake in check_bodies(Mechanism(bodies=tuple(bodies)), {}):
        yield Notice(mistake.message, mistake.span)


def carried_links(robot: Robot) -> dict[str, list[str]]:
    """For each link that moves by itself, and the root, those that move with it: itself first."""
    carriers: dict[str, str] = {}

    def carrier(name: str) -> str:
        line = []
        while name not in carriers:
            holder = robot.holder(name)
            line.append(name)
            if holder is None or holder.kind != "fixed":
                carriers[name] = name
                break
            name = holder.parent
        for one in line:
            carriers[one] = carriers[name]
        return carriers[name]

    groups: dict[str, list[str]] = {}
    for name in robot.links:
        groups.setdefault(carrier(name), []).append(name)
    return {name: sorted(links, key=name.__ne__) for name, links in groups.items()}


def body_entries(robot: Robot, links: list[str]) -> tuple[Node, Span] | None:
    """The body of links that move together, in the axes of the first; None without mass and inertia."""
    solids: list[Solid] = []
    inertials: list[Inertial] = []
    for name in links:
        inertial = robot.links[name].inertial
        if inertial is not None and any(entry.value for entry in (inertial.mass, *inertial.tensor)):
            shift, axes = _placed(robot, name, links[0])
            inertials.append(inertial)
            solids.append(_solid(inertial, shift, axes))
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


def _placed(robot: Robot, name: str, carrier: str) -> tuple[Vector, Matrix]:
    """Origin and axes of a link in those of the link that carries it."""
    shift: Vector = (ZERO, ZERO, ZERO)
    axes = IDENTITY
    while name != carrier:
        joint = robot.holder(name)
        assert joint is not None
        turns = joint.origin.axes
        shift, axes = added(joint.origin.shift, applied(turns, shift)), product(turns, axes)
        name = joint.parent
    return shift, axes


def _solid(inertial: Inertial, shift: Vector, axes: Matrix) -> Solid:
    xx, yy, zz, xy, xz, yz = (entry.value for entry in inertial.tensor)
    turned = product(axes, inertial.origin.axes)
    tensor: Matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    com = added(shift, applied(axes, inertial.origin.shift))
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
