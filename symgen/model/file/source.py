"""YAML text as a tree that knows its places: every scalar is text, every node has line and column.

Built from YAML events, iteratively, so that no document, however deep or long, can exhaust the machine; anchors,
aliases, merge keys and tags are refused before anything is built from them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TypeAlias

import yaml

from symgen.diagnostics import Mistake, Span

# Characters of a file that are read: a file is untrusted input.
MAXIMUM_CHARACTERS = 1_000_000
# Levels of collections in collections.
MAXIMUM_DEPTH = 24
# Values and collections of a file.
MAXIMUM_NODES = 100_000
PLAIN_REMEDY = "write the value out, or name it under `parameters` or `definitions`"

QUOTED = "quote a text that has a comma, colon, bracket or #"

START = Span(1, 1, 2)

_EventLoader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True, slots=True)
class ScalarNode:
    """A text; `raw` is its source text, quotes and line breaks included, starting at `line` and `column`."""

    value: str
    span: Span
    raw: str = field(repr=False)
    quoted: bool

    def place(self, offset: int, length: int) -> Span:
        """The place of `value[offset : offset + length]`, also where the text is quoted or runs over several lines."""
        if self.raw == self.value:
            column = self.span.column + offset
            return replace(self.span, column=column, end_column=column + max(1, length))
        start = _raw_offset(self.raw, self.value, offset)
        before = self.raw[:start]
        line = self.span.line + before.count("\n")
        column = start - before.rfind("\n") if "\n" in before else self.span.column + start
        return Span(line, column, column + max(1, length), self.span.file)


@dataclass(frozen=True, slots=True)
class SequenceNode:
    """A list."""

    items: tuple[Node, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class MappingNode:
    """Names with values, in the order of the file; `flow` where written in braces."""

    entries: tuple[tuple[ScalarNode, Node], ...]
    span: Span
    flow: bool

    def get(self, key: str) -> Node | None:
        """The value of the first entry of that name."""
        return next((value for name, value in self.entries if name.value == key), None)


Node: TypeAlias = ScalarNode | SequenceNode | MappingNode


@dataclass(slots=True)
class _Open:
    """A collection whose end has not been read."""

    mapping: bool
    flow: bool
    span: Span
    items: list[Node]


def read_tree(text: str) -> tuple[MappingNode | None, tuple[Mistake, ...]]:
    """The document's top mapping; a syntax error is reported alone, duplicate keys are collected."""
    if len(text) > MAXIMUM_CHARACTERS:
        message = f"the file has {len(text)} characters, at most {MAXIMUM_CHARACTERS} are read"
        return None, (Mistake(message, "split the model, or remove what does not belong to it", START),)
    try:
        try:
            root, mistakes = _build(text, yaml.parse(text, Loader=_EventLoader))
        except yaml.YAMLError:
            # PyYAML's own parser decides, and words the error: libyaml's differs in details, and may not be there.
            root, mistakes = _build(text, yaml.parse(text, Loader=yaml.SafeLoader))
    except _RefusedYamlError as refused:
        return None, (refused.mistake,)
    except yaml.YAMLError as error:
        return None, (_syntax_mistake(text, error),)
    if root is None:
        return None, (
            Mistake(
                "the file is empty", "write a model; a minimal one has `model`, `coordinates`, `kinetic_energy`", START
            ),
        )
    if not isinstance(root, MappingNode):
        message = "a model file is a mapping of names to values"
        return None, (Mistake(message, "start with `model: name_of_the_model`", root.span),)
    return root, tuple(mistakes)


class _RefusedYamlError(Exception):
    def __init__(self, message: str, remedy: str, span: Span) -> None:
        self.mistake = Mistake(message, remedy, span)


def _build(text: str, events: Iterator[yaml.Event]) -> tuple[Node | None, list[Mistake]]:
    mistakes: list[Mistake] = []
    open_collections: list[_Open] = []
    root: Node | None = None
    nodes = 0
    for event in events:
        node: Node | None = None
        match event:
            case yaml.DocumentStartEvent() if root is not None:
                raise _RefusedYamlError("a second document begins here", "keep one model per file", _span(event))
            case yaml.AliasEvent():
                raise _RefusedYamlError(f"YAML aliases are not read: `*{event.anchor}`", PLAIN_REMEDY, _span(event))
            case yaml.ScalarEvent():
                _refuse_decoration(event)
                node = _scalar(text, event)
            case yaml.MappingStartEvent() | yaml.SequenceStartEvent():
                _refuse_decoration(event)
                mapping = isinstance(event, yaml.MappingStartEvent)
                open_collections.append(_Open(mapping, bool(event.flow_style), _span(event), []))
                if len(open_collections) > MAXIMUM_DEPTH:
                    message = f"nested deeper than {MAXIMUM_DEPTH} levels"
                    raise _RefusedYamlError(message, "flatten the file", _span(event))
            case yaml.MappingEndEvent() | yaml.SequenceEndEvent():
                node = _close(open_collections.pop(), mistakes)
            case _:
                continue
        nodes += 1
        if nodes > MAXIMUM_NODES:
            raise _RefusedYamlError(f"more than {MAXIMUM_NODES} values", "split the model", _span(event))
        if node is not None and open_collections:
            _append(open_collections[-1], node)
        elif node is not None:
            root = node
    return (None if isinstance(root, ScalarNode) and not root.raw else root), mistakes


def _append(collection: _Open, node: Node) -> None:
    if collection.mapping and len(collection.items) % 2 == 0:
        if not isinstance(node, ScalarNode):
            raise _RefusedYamlError(
                "a key that is a list or a mapping", "use a plain name as key, or quote the text", node.span
            )
        if node.value == "<<" and not node.quoted:
            raise _RefusedYamlError("YAML merge keys are not read", PLAIN_REMEDY, node.span)
    collection.items.append(node)


def _close(collection: _Open, mistakes: list[Mistake]) -> Node:
    if not collection.mapping:
        return SequenceNode(tuple(collection.items), collection.span)
    entries: list[tuple[ScalarNode, Node]] = []
    first: dict[str, Span] = {}
    for key, value in zip(collection.items[::2], collection.items[1::2], strict=True):
        assert isinstance(key, ScalarNode)
        if key.value in first:
            message = f"`{key.value}` stands here a second time (first in line {first[key.value].line})"
            mistakes.append(Mistake(message, "remove or rename one of the two", key.span))
            continue
        first[key.value] = key.span
        entries.append((key, value))
    return MappingNode(tuple(entries), collection.span, collection.flow)


def _refuse_decoration(event: yaml.ScalarEvent | yaml.CollectionStartEvent) -> None:
    if event.anchor is not None:
        raise _RefusedYamlError(f"YAML anchors are not read: `&{event.anchor}`", PLAIN_REMEDY, _span(event))
    if event.tag is not None:
        remedy = "remove it; symgen knows what each value is"
        raise _RefusedYamlError(f"YAML tags are not read: `{event.tag}`", remedy, _span(event))


def _scalar(text: str, event: yaml.ScalarEvent) -> ScalarNode:
    assert event.start_mark is not None
    assert event.end_mark is not None
    raw = text[event.start_mark.index : event.end_mark.index]
    return ScalarNode(event.value, _span(event), raw, bool(event.style))


def _span(event: yaml.Event) -> Span:
    """The event's place, up to the end of its first line's part that matters: one character at least."""
    start, end = event.start_mark, event.end_mark
    assert start is not None
    assert end is not None
    first, last = start.column + 1, end.column + 1
    return Span(start.line + 1, first, max(first + 1, last) if end.line == start.line else first + 1)


def _raw_offset(raw: str, value: str, offset: int) -> int:
    """Where `value[offset]` stands in the source: folding changes white space only, so the other characters align."""
    places = _visible(raw)
    visible = len("".join(value[:offset].split()))
    return places[visible] if visible < len(places) else max(0, len(raw) - 1)


@lru_cache(maxsize=2)
def _visible(raw: str) -> tuple[int, ...]:
    """Where the characters of a text stand that are no white space; one text is asked for each of its names."""
    header = raw.find("\n") + 1 if raw[:1] in "|>" else 0
    first = max(header, 1 if raw[:1] in "\"'" else 0)
    return tuple(place for place in range(first, len(raw)) if not raw[place].isspace())


def _syntax_mistake(text: str, error: yaml.YAMLError) -> Mistake:
    if isinstance(error, yaml.reader.ReaderError):
        return _character_mistake(text, error.position)
    if not isinstance(error, yaml.MarkedYAMLError):
        return Mistake("this is not YAML", "check brackets, quotes and indentation", START)
    mark = error.problem_mark or error.context_mark
    span = _at(mark) if mark else START
    problem = " ".join(str(part) for part in (error.problem, error.context) if part)
    begun = error.context_mark
    if "'\\t'" in problem:
        return Mistake("a tab where YAML wants spaces", "indent with spaces, not with tabs", span)
    if "quoted scalar" in problem and begun is not None:
        return Mistake("a quotation mark that is never closed", "close it at the end of the text", _at(begun))
    if "parsing a flow" in problem and begun is not None:
        where = "" if begun.line + 1 == span.line else f" in line {begun.line + 1}"
        return Mistake(f"the bracket opened{where} at column {begun.column + 1} is not closed before this",
                       "close it, separate entries by commas, and quote a text that has a comma, colon, bracket or #",
                       span)  # fmt: skip
    if "expected <block end>" in problem:
        message = "this line does not belong to its block: it begins further right or left, or has no name"
        return Mistake(message, "indent all entries of a block alike, each `name: value`", span)
    if problem.startswith("mapping values are not allowed"):
        message = "a second `:` in one line"
        if ":" not in text.splitlines()[span.line - 1][: span.column - 1]:
            message = "this line is no entry of the block that it stands in"
        return _without_colon(text, span) or Mistake(message, f"indent entries of a block alike; {QUOTED}", span)
    return Mistake(f"this is not YAML: {problem}", f"check indentation, brackets and quotes; {QUOTED}", span)


def _at(mark: yaml.Mark) -> Span:
    return Span(mark.line + 1, mark.column + 1, mark.column + 2)


def _without_colon(text: str, span: Span) -> Mistake | None:
    """The mistake at the line before, where its name has no colon, which only shows at the next one."""
    lines = text.splitlines()
    for number in range(span.line - 1, 0, -1):
        line = lines[number - 1].split("#")[0].rstrip()
        if line.strip():
            if ":" in line or line.lstrip().startswith("-"):
                return None
            start = len(line) - len(line.lstrip()) + 1
            return Mistake("a name without a colon", "write `name: value`", Span(number, start, len(line) + 1))
    return None


def _character_mistake(text: str, position: int) -> Mistake:
    line = text.count("\n", 0, position) + 1
    column = position - (text.rfind("\n", 0, position) + 1) + 1
    message = f"a control character (code {ord(text[position]):#04x})"
    return Mistake(message, "remove it", Span(line, column, column + 1))
