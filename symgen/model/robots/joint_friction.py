"""Damping and dry friction of joints of a robot file, as entries of the block `friction`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from symgen.diagnostics import Span
from symgen.model.file.reading import member
from symgen.model.file.scope import Scope
from symgen.model.file.source import MappingNode, ScalarNode
from symgen.model.robots.nodes import Entry, own_names, text_node
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class JointFriction:
    """What a file says about one joint, by the name of its coordinate in the model; None for none."""

    joint: str
    coordinate: str
    viscous: ScalarNode | None
    dry: ScalarNode | None
    span: Span


def friction_entries(scope: Scope, tree: MappingNode, form: str, joints: Iterable[JointFriction]) -> Iterator[Entry]:
    """The entries, unless the model file has its own for the coordinate; dry friction needs a width."""
    key = form.lower()
    width, own = member(tree.get(key), "friction_width"), own_names(tree, "friction")
    for one in joints:
        if one.coordinate in own:
            continue
        parts: list[Entry] = []
        if one.viscous is not None:
            parts.append((text_node("viscous", one.span), one.viscous))
        if one.dry is not None:
            if width is None:
                message = f"the dry friction of the joint `{one.joint}` has no width in which it changes its sign"
                remedy = (
                    f"add the rate at which it has 76 % of its full size: `{key}: {{file: ..., friction_width: 0.01}}"
                    f"`, or an entry `{one.coordinate}` under `friction` of the model file, which replaces that of "
                    f"the {form}"
                )
                scope.wrong(message, remedy, one.dry.span, one.joint)
                continue
            parts += [(text_node("coulomb", one.span), one.dry), (text_node("width", one.span), width)]
        if parts:
            yield text_node(one.coordinate, one.span), MappingNode(tuple(parts), one.span, True)
