"""Whole bodies as numbers in the text of a model file, which else stays as it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from symgen.identification.bodies.entries import in_one_line

# From, to, and what stands there instead.
_Change = tuple[int, int, str]


def with_bodies(text: str, entries: Mapping[str, Mapping[str, str]], rotors: Mapping[str, str]) -> str:
    """The text with `mass`, `com` and `inertia` of bodies and inertias of rotors replaced, or added where they lack.

    The text is one that `load_text` has read: its `bodies` are a table of tables, without anchors and tags.
    """
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    assert isinstance(root, yaml.MappingNode)
    blocks = {key.value: value for key, value in root.value}
    changes: list[_Change] = []
    for key, node in blocks["bodies"].value:
        if key.value in entries:
            changes += _of_body(node, entries[key.value])
    for key, node in blocks["rotor_inertias"].value if rotors else ():
        changes.append((*_extent(node), rotors[key.value]))
    for start, end, written in sorted(changes, reverse=True):
        text = text[:start] + written + text[end:]
    return text


def _of_body(node: yaml.Node, entry: Mapping[str, str]) -> Iterator[_Change]:
    if not isinstance(node, yaml.MappingNode) or not node.value:
        start, end = _extent(node)
        yield start, end, f" {in_one_line(dict(entry))}" if start == end else in_one_line(dict(entry))
        return
    first = node.value[0][0].start_mark
    present = {key.value: value for key, value in node.value}
    added = [f"{key}: {value}" for key, value in entry.items() if key not in present]
    for key, value in entry.items():
        if key in present:
            yield (*_extent(present[key]), value)
    if added:
        between = ", " if node.flow_style else "\n" + " " * first.column
        yield first.index, first.index, "".join(one + between for one in added)


def _extent(node: yaml.Node) -> tuple[int, int]:
    """Where a value begins and ends; blocks end with their last value, before comments that follow."""
    start, last = node.start_mark.index, node
    while isinstance(last, yaml.CollectionNode) and not last.flow_style and last.value:
        last = last.value[-1][1] if isinstance(last, yaml.MappingNode) else last.value[-1]
    return start, last.end_mark.index
