"""Reading elements, attributes and numbers of a robot description; what is not understood is a mistake, by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.names import did_you_mean
from symgen.model.expressions.parser import MAXIMUM_DIGITS
from symgen.model.robots.numbers import LARGEST_POWER, WrittenNumber, read_number
from symgen.model.robots.xml import Element

# Links that are read, and joints.
MAXIMUM_LINKS = 500
# In rad, by which a joint with limits may turn.
MAXIMUM_ANGLE = 10_000
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven")


class ElementReader:
    """What readers of all formats do; `unread` is what the user wants left out, by name."""

    def __init__(self, form: str, unread: frozenset[str]) -> None:
        self.form = form
        self.unread = unread
        self.owner = ""
        self.mistakes: list[Mistake] = []
        self.left_out: dict[str, list[str]] = {}

    def wrong(self, message: str, remedy: str, span: Span) -> None:
        """Records a mistake, about the part that is being read where the message names it."""
        self.mistakes.append(Mistake(message, remedy, span, self.owner if f"`{self.owner}`" in message else ""))

    def attributes(self, element: Element, known: Iterable[str]) -> None:
        """Text where none belongs, and attributes that nobody knows."""
        if element.text:
            message = f"`{element.tag}` holds the text `{element.text[:40]}`"
            self.wrong(message, "values stand in attributes; remove the text", element.span)
        for key in element.attributes:
            if key in known or key == "xmlns" or key.startswith("xmlns:"):
                continue
            if key in self.unread:
                self.leave_out(key, self.owner)
                continue
            unknown = f"symgen does not know what it does to the motion; {self.leaving_out(key)}"
            remedy = did_you_mean(key, known, unknown)
            self.wrong(f"`{key}` is no attribute of `{element.tag}`", remedy, element.place(key))

    def unknown_child(self, child: Element, known: Iterable[str], what: str) -> None:
        """Records an element that nobody knows in a `what`, unless it is left out."""
        if child.tag in self.unread:
            self.leave_out(child.tag, child.attributes.get("name") or self.owner)
            return
        unknown = f"symgen does not know what it does to the motion; {self.leaving_out(child.tag)}"
        self.wrong(f"`{child.tag[:60]}` is no part of a `{what}`", did_you_mean(child.tag, known, unknown), child.span)

    def refuse(self, element: Element, why: str, remedy: str) -> None:
        """Records an element that changes the motion in a way that no block has, unless it is left out."""
        if element.tag in self.unread:
            self.leave_out(element.tag, element.attributes.get("name") or self.owner)
        else:
            what = f"`{element.tag[:60]}`"
            self.wrong(f"{what} is not read: {why}", f"{remedy}; {self.leaving_out(element.tag)}", element.span)

    def leave_out(self, tag: str, name: str) -> None:
        """Notes what takes no part."""
        self.left_out.setdefault(tag, []).append(name)

    def leaving_out(self, name: str) -> str:
        """How the user says that something may be left out."""
        block = f"{self.form.lower()}: {{file: ..., leave_out: [{name[:40]}]}}"
        return f"where it may be left out, say so: `{block}`"

    def only(self, element: Element, tag: str) -> Element | None:
        """The child of that name, of which there is one at most."""
        children = element.all(tag)
        for further in children[1:]:
            self.wrong(f"`{element.tag}` has a second `{tag}`", "keep one of them", further.span)
        return children[0] if children else None

    def text(self, element: Element, key: str, what: str) -> str:
        """An attribute that must be there."""
        text = element.attributes.get(key, "").strip()
        if not text:
            self.wrong(f"{what} has no `{key}`", f'add {key}="..."', element.span)
        return text

    def number(self, element: Element, key: str, what: str, needed: bool = False) -> WrittenNumber | None:
        """The number in an attribute."""
        text = element.attributes.get(key)
        if text is None:
            if needed:
                self.wrong(f"{what} has no `{key}`", f'add {key}="..."', element.span)
            return None
        return self.number_in(text.strip(), element.place(key), f"`{key}` of {what}")

    def number_in(self, text: str, span: Span, what: str) -> WrittenNumber | None:
        """The number that a text is."""
        value = read_number(text, span)
        if value is None:
            within = f"of at most {MAXIMUM_DIGITS} digits and within 1e{LARGEST_POWER}"
            self.wrong(f"{what} is `{text[:40]}`", f"write a decimal number, {within}", span)
        return value

    def vector(
        self, element: Element, key: str, what: str, least: int = 3, most: int = 3
    ) -> tuple[WrittenNumber, ...]:
        """The numbers in an attribute, between `least` and `most` of them; none where it is not there."""
        text = element.attributes.get(key)
        if text is None:
            return ()
        return self.numbers_in(text, lambda start, length: element.place(key, start, length), what, least, most)

    def numbers_in(
        self, text: str, place: Callable[[int, int], Span], what: str, least: int, most: int
    ) -> tuple[WrittenNumber, ...]:
        """The numbers of a text with spaces between them; `place` tells where characters of it are."""
        entries: list[WrittenNumber] = []
        start = 0
        for part in text.split():
            start = text.index(part, start)
            value = read_number(part, place(start, len(part)))
            start += len(part)
            if value is not None:
                entries.append(value)
        if len(entries) == len(text.split()) and least <= len(entries) <= most:
            return tuple(entries)
        counted = COUNTS[least] if least == most else f"{COUNTS[least]} to {COUNTS[most]}"
        remedy = f"write {counted} decimal number{'' if most == 1 else 's'} with spaces between"
        self.wrong(f"{what} is `{text[:60]}`", remedy, place(0, len(text)))
        return ()

    def twice(self, what: str, element: Element, first: Span) -> None:
        """Records a name that stands a second time."""
        name = element.attributes.get("name", "")
        message = f"there is a second {what} `{name}` (first in line {first.line})"
        self.wrong(message, "remove or rename one of the two", element.place("name"))
