"""XML as a tree that knows its places, by expat; what could harm or mislead a reader is refused before it is built.

Document types are refused as such, and with them entities of every kind: a robot description needs none.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from xml.parsers import expat

from symgen.diagnostics import Mistake, Span
from symgen.model.file.source import MAXIMUM_CHARACTERS, MAXIMUM_DEPTH

# Levels of elements in elements where bodies stand inside of bodies.
MAXIMUM_BODIES = 100
# Elements of a file that are read.
MAXIMUM_ELEMENTS = 20_000


@dataclass(frozen=True, slots=True)
class XmlDocument:
    """The text of a file and its name in messages."""

    text: str = field(repr=False)
    file: str
    line_starts: tuple[int, ...] = field(repr=False)

    def span(self, offset: int, length: int) -> Span:
        """The place of characters of the text, cut at the end of their line."""
        line = bisect_right(self.line_starts, offset)
        column = offset - self.line_starts[line - 1] + 1
        end = self.text.find("\n", offset)
        room = (len(self.text) if end < 0 else end) - offset
        return Span(line, column, column + max(1, min(length, room)), self.file)


@dataclass(slots=True)
class Element:
    """An element with its attributes and children in the order of the file, and what stands between them."""

    tag: str
    attributes: dict[str, str]
    document: XmlDocument = field(repr=False)
    offset: int
    children: list[Element] = field(default_factory=list)
    parts: list[str] = field(default_factory=list, repr=False)

    @property
    def text(self) -> str:
        """What stands between its children, without white space around."""
        return "".join(self.parts).strip()

    @property
    def span(self) -> Span:
        """The place of its opening bracket and name."""
        return self.document.span(self.offset, len(self.tag) + 1)

    def all(self, tag: str) -> list[Element]:
        """The children of that name."""
        return [child for child in self.children if child.tag == tag]

    def place(self, attribute: str, start: int = 0, length: int | None = None) -> Span:
        """The place of the value of an attribute, or of some characters of it."""
        raw = re.compile(rf"\s{re.escape(attribute)}\s*=\s*(\"[^\"]*\"|'[^']*')")
        match = raw.search(self.document.text, self.offset)
        value = self.attributes.get(attribute, "")
        if match is None:
            return self.span
        if match.group(1)[1:-1] != value:
            # a character written as &#...;, so that places inside are not those of the text
            start, length = 0, len(match.group(1)) - 2
        return self.document.span(match.start(1) + 1 + start, len(value) if length is None else length)

    def place_inside(self, start: int, length: int) -> Span:
        """The place of some characters of the text, or of the element where something else stands between them."""
        head = re.compile(r"<(?:[^\"'>]|\"[^\"]*\"|'[^']*')*>\s*").match(self.document.text, self.offset)
        if head is None or not self.document.text.startswith(self.text, head.end()):
            return self.span
        return self.document.span(head.end() + start, length)


def a_file(form: str) -> str:
    """`a URDF file`, `an MJCF file`."""
    return f"{'an' if form in ('MJCF', 'SDF') else 'a'} {form} file"


class _RefusedXmlError(Exception):
    pass


def parse_xml(text: str, file: str, form: str) -> Element | Mistake:
    """The root element, or the one mistake that keeps the file from being read; `form` is what it should be."""
    if len(text) > MAXIMUM_CHARACTERS:
        message = f"the file has {len(text)} characters or more, at most {MAXIMUM_CHARACTERS} are read"
        return Mistake(message, "remove what does not belong to the mechanism", Span(1, 1, 2, file))
    lines = text.replace("\r\n", "\n").replace("\r", "\n")
    starts = (0, *(match.end() for match in re.finditer("\n", lines)))
    levels = MAXIMUM_BODIES if form == "MJCF" else MAXIMUM_DEPTH
    reading = _XmlReader(XmlDocument(lines, file, starts), levels)
    try:
        return reading.root()
    except _RefusedXmlError:
        assert reading.mistake is not None
        return reading.mistake
    except expat.ExpatError as error:
        line, column = max(1, error.lineno), error.offset + 1
        if not text.strip():
            return Mistake("the file is empty", f"give {a_file(form)}", Span(1, 1, 2, file))
        if error.code == expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS] and reading.unclosed:
            tag, span = reading.unclosed.tag, reading.unclosed.span
            ends = f"the file ends inside of `{tag}`, which begins here"
            return Mistake(ends, f"close it with </{tag}>, or give the whole file", span)
        message = f"this is not XML: {expat.ErrorString(error.code)}"
        return Mistake(message, "check brackets, quotes and closing tags", Span(line, column, column + 1, file))


class _XmlReader:
    """One pass of expat over a document."""

    def __init__(self, document: XmlDocument, levels: int) -> None:
        self.document = document
        self._levels = levels
        self.mistake: Mistake | None = None
        self._open: list[Element] = []
        self._root: Element | None = None
        self._elements = 0
        self._parser = expat.ParserCreate()
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._characters
        self._parser.StartDoctypeDeclHandler = self._document_type

    @property
    def unclosed(self) -> Element | None:
        """The innermost element that is still open."""
        return self._open[-1] if self._open else None

    def root(self) -> Element:
        """The root; raises _RefusedXmlError with a mistake noted, and expat's error."""
        self._parser.Parse(self.document.text, True)
        assert self._root is not None
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self.document, self._offset())
        self._elements += 1
        if len(self._open) >= self._levels:
            self._refuse(f"nested deeper than {self._levels} levels", "flatten the file", element.span)
        if self._elements > MAXIMUM_ELEMENTS:
            remedy = "remove what does not belong to the mechanism"
            self._refuse(f"more than {MAXIMUM_ELEMENTS} elements", remedy, element.span)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)

    def _end(self, _tag: str) -> None:
        self._open.pop()

    def _characters(self, text: str) -> None:
        if self._open:
            self._open[-1].parts.append(text)

    def _document_type(self, *_declaration: object) -> None:
        remedy = "remove the line <!DOCTYPE ...> and write what its entities stand for"
        # expat is at the end of the declaration's head by now
        start = self.document.text.rfind("<!DOCTYPE", 0, self._offset() + 1)
        self._refuse("document types and entities are not read", remedy, self.document.span(max(0, start), 9))

    def _offset(self) -> int:
        starts = self.document.line_starts
        return starts[self._parser.CurrentLineNumber - 1] + self._parser.CurrentColumnNumber

    def _refuse(self, message: str, remedy: str, span: Span) -> None:
        self.mistake = Mistake(message, remedy, span)
        raise _RefusedXmlError
