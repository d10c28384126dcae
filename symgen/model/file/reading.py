"""Tolerant access to the tree: what has the wrong shape reads as absent, because the shape check has reported it."""

from __future__ import annotations

from symgen.diagnostics import Span
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode


def entries(node: Node | None) -> tuple[tuple[ScalarNode, Node], ...]:
    """The entries of a mapping."""
    return node.entries if isinstance(node, MappingNode) else ()


def items(node: Node | None) -> tuple[Node, ...]:
    """The items of a list."""
    return node.items if isinstance(node, SequenceNode) else ()


def member(node: Node | None, key: str) -> Node | None:
    """The value under `key` of a mapping."""
    return node.get(key) if isinstance(node, MappingNode) else None


def key_span(node: MappingNode, key: str) -> Span | None:
    """The place of a key."""
    return next((name.span for name, _ in node.entries if name.value == key), None)


def text_of(node: Node | None) -> str | None:
    """The text of a scalar that is not empty, without surrounding white space."""
    if isinstance(node, ScalarNode) and node.value.strip():
        return node.value.strip()
    return None


def one_line(node: Node | None) -> str:
    """A text with single spaces for breaks and runs of white space; nothing where there is none."""
    return " ".join((text_of(node) or "").split())


def description_of(node: Node | None) -> str:
    """The text under `description`, on one line."""
    return one_line(member(node, "description"))
