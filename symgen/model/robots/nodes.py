"""Entries of the model file that readers of robot descriptions put before those that the user wrote."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from symgen.diagnostics import Span
from symgen.model.file.reading import entries, member, text_of
from symgen.model.file.source import MappingNode, Node, ScalarNode

Entry: TypeAlias = tuple[ScalarNode, Node]


def text_node(text: str, span: Span) -> ScalarNode:
    """A text without source, so that places inside are that of the whole."""
    return ScalarNode(text, span, "", False)


def with_entries(tree: MappingNode, additions: Mapping[str, Sequence[Entry]], span: Span) -> MappingNode:
    """The tree with further entries at the beginning of its blocks; `constraints` stands for its geometric rows."""
    rows = additions.get("constraints")
    if rows:
        geometric = MappingNode((*rows, *entries(member(tree.get("constraints"), "geometric"))), span, False)
        others = [entry for entry in entries(tree.get("constraints")) if entry[0].value != "geometric"]
        block = MappingNode(((text_node("geometric", span), geometric), *others), span, False)
        tree = replaced(tree, "constraints", block, span)
    for key, made in additions.items():
        if made and key != "constraints":
            old = tree.get(key)
            block = MappingNode((*made, *entries(old)), span if old is None else old.span, False)
            tree = replaced(tree, key, block, span)
    return tree


def replaced(tree: MappingNode, key: str, value: Node, span: Span) -> MappingNode:
    """The tree with another value under a key."""
    kept = tuple(entry for entry in tree.entries if entry[0].value != key)
    name = next((own for own, _ in tree.entries if own.value == key), text_node(key, span))
    return MappingNode((*kept, (name, value)), tree.span, tree.flow)


def ranged_names(tree: MappingNode) -> set[str]:
    """The names that the model file gives a range."""
    own = own_names(tree, "ranges")
    return own | {key.value for key, node in entries(tree.get("coordinates")) if member(node, "range") is not None}


def own_names(tree: MappingNode, block: str) -> set[str]:
    """The names in a block of the model file."""
    return {key.value for key, _ in entries(tree.get(block))}


def is_placed(tree: MappingNode, root: str) -> bool:
    """Whether the model file says how the root stands or moves."""
    children = {text_of(member(node, "child")) or key.value for key, node in entries(tree.get("joints"))}
    return root in children or root in own_names(tree, "frames")
