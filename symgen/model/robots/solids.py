"""Masses that move together as one body: centres and tensors added as exact fractions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from symgen.diagnostics import Span
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode
from symgen.model.kinematics.triples import transposed
from symgen.model.mechanism import INERTIA_ELEMENTS
from symgen.model.robots.numbers import Matrix, Vector, product, written
from symgen.model.robots.places import AxesPlace

# Exactly 0, where sums of exact numbers begin.
ZERO = Fraction(0)
# where the elements xx, yy, zz, xy, xz, yz stand in the matrix
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


@dataclass(frozen=True, slots=True)
class Solid:
    """Mass, centre of mass and the tensor about it, in the axes of one link."""

    mass: Fraction
    com: Vector
    tensor: Matrix

    def seen_from(self, place: AxesPlace) -> Solid:
        """The same in the axes that its own ones have this place in."""
        tensor = product(product(place.axes, self.tensor), transposed(place.axes))
        return Solid(self.mass, place.point(self.com), tensor)


def matrix_of(elements: Sequence[Fraction]) -> Matrix:
    """The symmetric matrix of xx, yy, zz, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = elements
    return (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)


def together(solids: Sequence[Solid]) -> Solid:
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


def body_node(
    mass: Node, com: Sequence[Node], tensor: Sequence[Node], shown: Sequence[bool], span: Span
) -> MappingNode:
    """An entry of `bodies`; elements of the tensor that are not `shown` are 0."""
    entries: list[tuple[ScalarNode, Node]] = [(_key("mass", span), mass)]
    if com:
        entries.append((_key("com", span), SequenceNode(tuple(com), span)))
    elements = [
        (_key(name, span), node)
        for name, node, is_shown in zip(INERTIA_ELEMENTS, tensor, shown, strict=True)
        if is_shown
    ]
    if elements:
        entries.append((_key("inertia", span), MappingNode(tuple(elements), span, True)))
    return MappingNode(tuple(entries), span, True)


def made(value: Fraction, span: Span) -> ScalarNode:
    """A number that was computed here."""
    return ScalarNode(written(value), span, "", False)


def _key(text: str, span: Span) -> ScalarNode:
    return ScalarNode(text, span, "", False)
