"""Entries that stand in the wrong block: one mistake that names the right one, in place of one for each of its keys."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from symgen.diagnostics import Mistake
from symgen.model.file.schema import MODEL
from symgen.model.file.shape import RecordShape, TableShape
from symgen.model.file.source import MappingNode, Node, ScalarNode

RECORDS: dict[str, RecordShape] = {
    field.key: field.shape.entry
    for field in MODEL.fields
    if isinstance(field.shape, TableShape) and isinstance(field.shape.entry, RecordShape)
}
# Keys that say nothing of what an entry is.
ANYWHERE = frozenset({"type", "description", "unit"})


def without_misplaced(tree: MappingNode) -> tuple[MappingNode, tuple[Mistake, ...]]:
    """The model without such entries, and a mistake for each."""
    mistakes: list[Mistake] = []

    def kept(block: ScalarNode, value: Node) -> Node:
        if block.value not in RECORDS or not isinstance(value, MappingNode):
            return value
        there = dict(_misplaced(block.value, value))
        mistakes.extend(there.values())
        return replace(value, entries=tuple(one for one in value.entries if one[0].value not in there))

    return replace(tree, entries=tuple((key, kept(key, value)) for key, value in tree.entries)), tuple(mistakes)


def _misplaced(block: str, entries: MappingNode) -> Iterator[tuple[str, Mistake]]:
    """The names of entries whose keys are all those of one other block, and not of this one."""
    for name, entry in entries.entries:
        if not isinstance(entry, MappingNode):
            continue
        keys = {key.value for key, _ in entry.entries} - ANYWHERE
        fitting = [other for other, record in RECORDS.items() if keys and keys <= _keys(record)]
        if len(fitting) != 1 or fitting == [block]:
            continue
        (other,) = fitting
        message = f"`{name.value}` has the keys of {RECORDS[other].what}, and stands under `{block}`"
        remedy = f"`{other}` is a block of its own: move it there"
        if entry.get("type") is not None and "type" not in _keys(RECORDS[other]):
            remedy += ", without `type`"
        yield name.value, Mistake(message, remedy, name.span)


def _keys(record: RecordShape) -> set[str]:
    return {field.key for field in record.fields}
