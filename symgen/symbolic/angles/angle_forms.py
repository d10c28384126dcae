"""Angles as whole combinations of leaves: what sines and cosines are known by, so that equal angles are one.

A leaf is a coordinate, or whatever is not a sum.  Signs are pulled out, so that an angle and its negative share both.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from typing import TYPE_CHECKING

from symgen.symbolic.fingerprint import angle_pair, leaf_pair

if TYPE_CHECKING:
    from symgen.symbolic.graph import Graph
    from symgen.symbolic.scalar import Scalar


class Angles:
    """The angles of one graph, taken apart once each."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        # by arguments of sines and cosines: whether the sign is pulled out, and the angle that is left
        self._upright: dict[Scalar, tuple[bool, Scalar]] = {}
        # cosine and sine in the field of fingerprints: of angles, and of leaves by their values there
        self._residues: dict[Scalar, tuple[int, int]] = {}
        self._of_leaves: dict[int, tuple[int, int]] = {}

    def upright(self, argument: Scalar) -> tuple[bool, Scalar]:
        """Whether a sign is pulled out of an argument, and the angle that is left."""
        known = self._upright.get(argument)
        if known is None:
            known = self._upright[argument] = self._turned(angle_form(argument))
        return known

    def residues(self, angle: Scalar) -> tuple[int, int]:
        """(cosine, sine) of an angle in the field of fingerprints."""
        known = self._residues.get(angle)
        if known is None:
            form = {leaf.value: count for leaf, count in angle_form(angle).items()}
            for leaf in form:
                if leaf not in self._of_leaves:
                    self._of_leaves[leaf] = leaf_pair(leaf)
            known = self._residues[angle] = angle_pair(form, self._of_leaves)
        return known

    def forget(self, gone: Set[Scalar]) -> None:
        """Lets go of scalars, see `Graph.forget`."""
        self._upright = {angle: one for angle, one in self._upright.items() if not (angle in gone or one[1] in gone)}
        self._residues = {angle: pair for angle, pair in self._residues.items() if angle not in gone}

    def _turned(self, form: Mapping[Scalar, int]) -> tuple[bool, Scalar]:
        """Whether the first leaf counts negative, and the sum of the leaves in their order with all signs turned so."""
        leaves = sorted(form, key=lambda leaf: leaf.serial)
        negative = bool(leaves) and form[leaves[0]] < 0
        graph = self._graph
        total = graph.zero
        for leaf in leaves:
            term = graph.mul(graph.const(abs(form[leaf])), leaf)
            total = graph.add(total, term) if (form[leaf] > 0) != negative else graph.sub(total, term)
        return negative, total


def angle_form(a: Scalar) -> dict[Scalar, int]:
    """`a` as an integer combination of leaves (coordinates, or whatever is not a sum), without zeros.

    Leaves stand in the order in which they are met; each sum is looked at once, however often it is used.
    """
    weights: dict[Scalar, tuple[tuple[Scalar, int], ...]] = {}
    stack = [a]
    while stack:
        node = stack.pop()
        if node not in weights:
            weights[node] = terms = _terms(node)
            stack += [term for term, _ in reversed(terms)]
    counts = dict.fromkeys(weights, 0)
    counts[a] = 1
    for node in sorted(weights, key=_serial, reverse=True):  # what a sum is made of is older than the sum
        for term, factor in weights[node]:
            counts[term] += factor * counts[node]
    return {node: count for node, count in counts.items() if count and not weights[node] and not node.is_zero}


def _serial(node: Scalar) -> int:
    return node.serial


def _terms(node: Scalar) -> tuple[tuple[Scalar, int], ...]:
    """What a node adds up, each with a whole factor; nothing for leaves."""
    if node.op == "add":
        return (node.args[0], 1), (node.args[1], 1)
    if node.op == "sub":
        return (node.args[0], 1), (node.args[1], -1)
    if node.op == "neg":
        return ((node.args[0], -1),)
    if node.op == "mul" and (k := node.args[0].constant) is not None and k.denominator == 1:
        return ((node.args[1], k.numerator),)
    return ()
