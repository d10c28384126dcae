"""What only pictures need to know of a mechanism: its wheels, and what is stretched between two points."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Literal

from symgen.diagnostics import Mistake
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.reading import entries, items, member, text_of
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode, ScalarNode
from symgen.model.mechanism import AXES, Tie, Wheel


def read_wheels(scope: Scope, tree: MappingNode) -> Iterator[Wheel]:
    """The wheels under `rolling`; what is wrong with others is told where their rows are made."""
    for _, node in entries(tree.get("rolling")):
        frame, radius = text_of(member(node, "frame")), member(node, "radius")
        if frame is None or scope.kinds.get(frame) != "frame" or not isinstance(radius, ScalarNode):
            continue
        parsed = parse_expression(radius)
        if not isinstance(parsed, Mistake):
            axle = text_of(member(node, "axle"))
            yield Wheel(frame, parsed, next((k for k, axis in enumerate(AXES) if axis == axle), 1))


def read_ties(scope: Scope, tree: MappingNode) -> Iterator[Tie]:
    """Rods, springs and cables between points that are known."""
    for tie in _ties(tree):
        if all(scope.kinds.get(end) in ("frame", "point") for end in tie.ends):
            yield tie


def _ties(tree: MappingNode) -> Iterator[Tie]:
    for _, node in entries(tree.get("loops")):
        if text_of(member(node, "type")) == "distance":
            yield from _between("rod", [text_of(item) for item in items(member(node, "between"))])
    for _, node in entries(tree.get("springs")):
        yield from _between("spring", [text_of(item) for item in items(member(node, "between"))])
    for block in ("inputs", "forces"):
        for _, node in entries(tree.get(block)):
            yield from _between("cable", [text_of(item) for item in items(member(node, "cable"))])


def _between(kind: Literal["rod", "spring", "cable"], names: list[str | None]) -> Iterator[Tie]:
    for one, other in pairwise(names):
        if one is not None and other is not None:
            yield Tie(kind, (one, other))
