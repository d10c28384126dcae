"""Names that a faulty declaration was to make: that they are unknown follows from its mistake, which is told."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from symgen.diagnostics import Mistake
from symgen.model.expressions.names import nearest
from symgen.model.file.schema import MODEL
from symgen.model.file.scope import words_of
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode

MEANT = tuple(field.key for field in MODEL.fields)
DECLARING = frozenset({"coordinates", "parameters", "definitions", "joints", "frames", "points", "inputs"})
ACTING = frozenset({"springs", "forces"})
# Keys of declarations that name what stands elsewhere: a mistake there is one of its own.
REFERRING = frozenset({"parent", "frame", "axes", "reaction"})


def attempted_names(tree: MappingNode, mistakes: Sequence[Mistake]) -> set[str]:
    """The words of every entry of a declaring block that holds a mistake of shape, or of the whole block.

    Of entries that only act on what others declare the names: what else is wrong with them follows, too.
    """
    lines = {mistake.span.line for mistake in mistakes if mistake.span is not None and not mistake.span.file}
    words: set[str] = set()
    for key, block, whole in _ranges(tree):
        if nearest(key.value, MEANT) not in DECLARING | ACTING or not any(line in whole for line in lines):
            continue
        if key.value not in DECLARING | ACTING:
            words |= {word for text in _texts(block) for word in words_of(text)}  # the block is misspelt
            continue
        inner = list(_ranges(block)) if isinstance(block, MappingNode) else []
        faulty = [(name, value) for name, value, its in inner if any(line in its for line in lines)]
        for name, value in faulty or [(name, value) for name, value, _ in inner] or [(key, block)]:
            texts = (name.value, *_texts(value)) if key.value in DECLARING else (name.value,)
            words |= {word for text in texts for word in words_of(text)}
    return words


def _ranges(node: MappingNode) -> Iterator[tuple[ScalarNode, Node, range]]:
    """The entries with the lines from each one's name to that of the next."""
    starts = [key.span.line for key, _ in node.entries]
    for (key, value), (first, after) in zip(node.entries, pairwise([*starts, 10**9]), strict=True):
        yield key, value, range(first, max(first + 1, after))


def _texts(node: Node) -> Iterator[str]:
    match node:
        case ScalarNode():
            yield node.value
        case SequenceNode():
            for item in node.items:
                yield from _texts(item)
        case MappingNode():
            for key, value in node.entries:
                yield key.value
                if key.value not in REFERRING:
                    yield from _texts(value)
