"""What only pictures need to know of a mechanism: its wheels, what is stretched between two points, and `picture`.

The block `picture` gives a machine that is written as energies the places that a picture needs.  Its names are for it
alone: no expression outside can have them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Literal

from symgen.diagnostics import Mistake
from symgen.model.blocks.frames import frame_name, read_frames, read_points
from symgen.model.blocks.inputs import point_name
from symgen.model.blocks.lengths import check_length
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.reading import entries, items, member, text_of
from symgen.model.file.scope import PARAMETERS, Kind, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.mechanism import AXES, NO_MECHANISM, NO_VECTOR, Mechanism, Tie, Wheel

# The radius of a wheel that is drawn, where it is wrong.
ROUND_WHEEL = "write its size, a number or an expression of parameters"


def read_wheels(scope: Scope, tree: MappingNode) -> Iterator[Wheel]:
    """The wheels under `rolling`; what is wrong with others is told where their rows are made."""
    for _, node in entries(tree.get("rolling")):
        frame, radius = text_of(member(node, "frame")), member(node, "radius")
        if frame is None or scope.kinds.get(frame) != "frame" or not isinstance(radius, ScalarNode):
            continue
        parsed = parse_expression(radius)
        if not isinstance(parsed, Mistake):
            yield Wheel(frame, parsed, _axle(node))


def _axle(wheel: Node) -> int:
    """The number of the axis that a wheel turns about; y where the file does not say."""
    axle = text_of(member(wheel, "axle"))
    return next((k for k, axis in enumerate(AXES) if axis == axle), 1)


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


def read_picture(scope: Scope, tree: MappingNode, defaults: Mapping[str, float]) -> Mechanism:
    """What the block `picture` adds to the mechanism; `defaults` are values of parameters."""
    block = tree.get("picture")
    if not isinstance(block, MappingNode):
        return NO_MECHANISM
    own = scope.inner()
    kinds: tuple[tuple[str, Kind], ...] = (("frames", "frame"), ("points", "point"))
    for key, kind in kinds:
        for name, _ in entries(block.get(key)):
            own.declare(name, kind)
    return Mechanism(
        NO_VECTOR,
        read_frames(own, block, ()),
        points=read_points(own, block),
        wheels=tuple(_drawn_wheels(own, block, defaults)),
        ties=tuple(_drawn_springs(own, block)),
    )


def _drawn_wheels(scope: Scope, block: MappingNode, defaults: Mapping[str, float]) -> Iterator[Wheel]:
    for key, node in entries(block.get("wheels")):
        what = f"the radius of the wheel `{key.value}`"
        frame = frame_name(scope, member(node, "frame"), f"`frame` of the wheel `{key.value}`")
        radius = scope.expression(member(node, "radius"), what, PARAMETERS)
        check_length(scope, member(node, "radius"), radius, defaults, what, ROUND_WHEEL)
        if frame is not None and radius is not None:
            yield Wheel(frame, radius, _axle(node))


def _drawn_springs(scope: Scope, block: MappingNode) -> Iterator[Tie]:
    for key, node in entries(block.get("springs")):
        yield from _between("spring", [point_name(scope, item, f"the spring `{key.value}`") for item in items(node)])
