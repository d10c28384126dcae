"""Shapes of a model file as data: one table both checks a tree and prints the JSON Schema, so the two cannot drift."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from typing import TypeAlias

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.names import MOST_LISTED, NAME_PATTERN, QUOTING, did_you_mean, is_name, nearest
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode
from symgen.records import dataclass

# Characters of a text, such as a description.
MAXIMUM_TEXT = 2000
JsonSchema: TypeAlias = dict[str, object]


@dataclass(frozen=True, slots=True)
class Text:
    """A text for people; no control characters."""


@dataclass(frozen=True, slots=True)
class ExpressionShape:
    """An expression of the model language; a number is one too."""


@dataclass(frozen=True, slots=True)
class Word:
    """A single word, one of `choices` if there are any."""

    choices: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Listing:
    """A list of `item`, at least `least` and at most `most` of them."""

    item: Shape
    least: int = 0
    most: int | None = None


@dataclass(frozen=True, slots=True)
class TableShape:
    """Names chosen by the user, each with an `entry`, at least `least` of them."""

    entry: Shape
    least: int = 0
    entries_may_be_empty: bool = False


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a record, and what it is for."""

    key: str
    shape: Shape
    about: str
    required: bool = False


@dataclass(frozen=True, slots=True)
class RecordShape:
    """Fixed keys."""

    what: str
    fields: tuple[Key, ...]


@dataclass(frozen=True, slots=True)
class Either:
    """One of several shapes, told apart by being a scalar, a list or a mapping."""

    shapes: tuple[Shape, ...]


@dataclass(frozen=True, slots=True)
class EitherRecord:
    """One of several records, told apart by the key that only it has; the last where none is there."""

    records: tuple[tuple[str, RecordShape], ...]


Shape: TypeAlias = Text | ExpressionShape | Word | Listing | TableShape | RecordShape | Either | EitherRecord


def check_shape(shape: Shape, node: Node, what: str) -> Iterator[Mistake]:
    """Every place where the tree under `node` is not of that shape; `what` names the node in messages."""
    match shape:
        case Text() | ExpressionShape() | Word():
            if not isinstance(node, ScalarNode):
                yield _wrong_kind(shape, node, what)
            else:
                yield from _check_scalar(shape, node, what)
        case Listing():
            if not isinstance(node, SequenceNode):
                yield _wrong_kind(shape, node, what)
            else:
                yield from _check_listing(shape, node, what)
        case TableShape():
            if not isinstance(node, MappingNode):
                yield _wrong_kind(shape, node, what)
            else:
                yield from _check_table(shape, node, what)
        case RecordShape():
            if not isinstance(node, MappingNode):
                yield _wrong_kind(shape, node, what)
            else:
                yield from _check_record(shape, node)
        case Either(shapes=shapes):
            fitting = next((one for one in shapes if isinstance(node, _node_types(one))), None)
            if fitting is None:
                yield _wrong_kind(shape, node, what)
            else:
                yield from check_shape(fitting, node, what)
        case EitherRecord(records=records):
            key_present = (record for key, record in records if isinstance(node, MappingNode) and node.get(key))
            yield from check_shape(next(key_present, records[-1][1]), node, what)


def json_schema_of(shape: Shape) -> JsonSchema:
    """The shape as JSON Schema (draft 2020-12) for editors."""
    match shape:
        case Text():
            return {"type": ["string", "number"]}
        case ExpressionShape():
            return {"type": ["string", "number"]}
        case Word(choices=choices):
            return {"enum": list(choices)} if choices else {"type": "string"}
        case Listing(item=item, least=least, most=most):
            schema: JsonSchema = {"type": "array", "items": json_schema_of(item), "minItems": least}
            return schema if most is None else {**schema, "maxItems": most}
        case TableShape(entry=entry, least=least, entries_may_be_empty=may_be_empty):
            value = json_schema_of(entry)
            return {
                "type": "object",
                "propertyNames": {"pattern": f"^{NAME_PATTERN}$"},
                "additionalProperties": {"anyOf": [value, {"type": "null"}]} if may_be_empty else value,
                "minProperties": least,
            }
        case RecordShape(fields=fields):
            return {
                "type": "object",
                "properties": {
                    field.key: {"description": field.about, **json_schema_of(field.shape)} for field in fields
                },
                "required": [field.key for field in fields if field.required],
                "additionalProperties": False,
            }
        case Either(shapes=shapes):
            return {"anyOf": [json_schema_of(one) for one in shapes]}
        case EitherRecord(records=records):
            return {"anyOf": [json_schema_of(record) for _, record in records]}


def _check_scalar(shape: Text | ExpressionShape | Word, node: ScalarNode, what: str) -> Iterator[Mistake]:
    if not node.value.strip():
        yield Mistake(f"{what} has no value", _due(shape), node.span)
    elif isinstance(shape, Text):
        yield from _check_text(node, what)
    elif isinstance(shape, Word) and shape.choices and node.value not in shape.choices:
        remedy = did_you_mean(node.value, shape.choices, _choices_remedy(shape.choices))
        yield Mistake(f"{what} is `{node.value[:40]}`, which is not known", remedy, node.span)


def _choices_remedy(choices: tuple[str, ...]) -> str:
    if len(choices) > MOST_LISTED:
        return "the command `symgen schema` lists the known words"
    return f"write {', '.join(choices[:-1])} or {choices[-1]}" if len(choices) > 1 else f"write {choices[0]}"


def _check_text(node: ScalarNode, what: str) -> Iterator[Mistake]:
    if len(node.value) > MAXIMUM_TEXT:
        message = f"{what} has {len(node.value)} characters, at most {MAXIMUM_TEXT} are allowed"
        yield Mistake(message, "shorten it", node.span)
    for character in node.value:
        # Cf holds the marks that reverse the reading direction, Zl and Zp end lines in some languages.
        if character not in "\n\t" and unicodedata.category(character) in ("Cc", "Cf", "Cs", "Zl", "Zp"):
            message = f"{what} has a control character (code {ord(character):#06x})"
            yield Mistake(message, "remove it", node.span)
            return


def _check_listing(shape: Listing, node: SequenceNode, what: str) -> Iterator[Mistake]:
    count = len(node.items)
    if count < shape.least or (shape.most is not None and count > shape.most):
        due = f"{shape.least}" if shape.least == shape.most else f"at least {shape.least}"
        entries = "1 entry" if count == 1 else f"{count} entries"
        remedy = f"write {due}, separated by commas" if count < shape.least else QUOTING
        yield Mistake(f"{what} has {entries}, {due} are due", remedy, node.span)
    for item in node.items:
        yield from check_shape(shape.item, item, f"an entry of {what}")


def _check_table(shape: TableShape, node: MappingNode, what: str) -> Iterator[Mistake]:
    if len(node.entries) < shape.least:
        yield Mistake(f"{what} is empty", "give at least one entry", node.span)
    for key, value in node.entries:
        empty = isinstance(value, ScalarNode) and not value.value.strip()
        if is_name(key.value) and not (empty and shape.entries_may_be_empty):
            yield from check_shape(shape.entry, value, f"`{key.value}`")


def _check_record(shape: RecordShape, node: MappingNode) -> Iterator[Mistake]:
    known = {field.key: field for field in shape.fields}
    for key, value in node.entries:
        if key.value in known:
            yield from check_shape(known[key.value].shape, value, f"`{key.value}`")
        elif not is_name(key.value):
            yield Mistake(f"`{key.value[:60]}` is no key of {shape.what}", QUOTING, key.span)
        else:
            remedy = did_you_mean(key.value, known, f"the keys are {', '.join(known)}")
            if isinstance(value, ScalarNode) and not value.value.strip() and remedy.startswith("the keys"):
                # most likely the rest of a description behind its comma
                remedy = f"{remedy}; {QUOTING}"
            yield Mistake(f"`{key.value}` is no key of {shape.what}", remedy, key.span)
    misspelt = {nearest(key.value, sorted(known)) for key, _ in node.entries if key.value not in known}
    for field in shape.fields:
        if field.required and node.get(field.key) is None and field.key not in misspelt:
            span = Span(node.span.line, node.span.column, node.span.column + 1)
            yield Mistake(f"{shape.what} has no `{field.key}`", f"add `{field.key}`: {field.about}", span)


def _wrong_kind(shape: Shape, node: Node, what: str) -> Mistake:
    if isinstance(node, ScalarNode) and not node.value.strip():
        return Mistake(f"{what} has no value", _due(shape), node.span)
    kind = {ScalarNode: "a single value", SequenceNode: "a list", MappingNode: "a mapping"}[type(node)]
    return Mistake(f"{what} is {kind}", _due(shape), node.span)


def _due(shape: Shape) -> str:
    match shape:
        case Text() | Word():
            return "write a text, on one line or as a block"
        case ExpressionShape():
            return f"write a number or an expression; {QUOTING}"
        case Listing():
            return "write a list in [ ], or one entry a line with `- `"
        case TableShape():
            return "write `name: value`, one a line"
        case RecordShape(fields=fields):
            return f"write a mapping with the keys {', '.join(field.key for field in fields)}"
        case Either(shapes=shapes):
            return "; or ".join(_due(one) for one in shapes)
        case EitherRecord(records=records):
            return _due(records[-1][1])


def _node_types(shape: Shape) -> type[ScalarNode] | type[SequenceNode] | type[MappingNode]:
    match shape:
        case Text() | ExpressionShape() | Word():
            return ScalarNode
        case Listing():
            return SequenceNode
        case _:
            return MappingNode
