"""What goes wrong, as data: a user's mistakes (place, excerpt, remedy) and notices; our own bugs are another type."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A place in the model file, or in `file` beside it; line and columns count from 1, `end_column` is one past the
    last character."""

    line: int
    column: int
    end_column: int
    file: str = ""


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake of the user: what is wrong, where, and what to do.

    `about` is the name in both texts by which this mistake differs from the same one made elsewhere.
    Raises SymgenBug without a remedy: whoever is told what is wrong is told what to do.
    """

    message: str
    remedy: str
    span: Span | None = None
    about: str = ""

    def __post_init__(self) -> None:
        if not self.remedy.strip():
            raise SymgenBug(f"there is no remedy for: {self.message}")


@dataclass(frozen=True, slots=True)
class Notice:
    """Something the user should know that is no mistake."""

    message: str
    span: Span | None = None


class ModelError(Exception):
    """All mistakes of one model file, in the order of the file; then those of the file beside it, whose text is
    `texts` by its name."""

    def __init__(
        self, file: str, text: str, mistakes: tuple[Mistake, ...], texts: Mapping[str, str] | None = None
    ) -> None:
        self.file = file
        self.text = text
        self.texts = dict(texts or {})
        placed = [(m.span or Span(0, 0, 0), m) for m in mistakes]
        self.mistakes = tuple(m for _, m in sorted(placed, key=lambda pair: (pair[0].file, pair[0])))
        super().__init__(self.render())

    def render(self) -> str:
        """Every mistake as `file:line:column: message`, the excerpt with a marker, and the remedy.

        What is wrong in the same way at several places is told once, with the further places.
        """
        alike: dict[tuple[str, str, str], list[Mistake]] = {}
        for mistake in self.mistakes:
            file = mistake.span.file if mistake.span is not None else ""
            alike.setdefault((file, *_unnamed(mistake)), []).append(mistake)
        return "\n".join(self._rendered(file, mistakes) for (file, _, _), mistakes in alike.items())

    def _rendered(self, file: str, mistakes: list[Mistake]) -> str:
        first, *others = mistakes
        places = dict.fromkeys((m.about, m.span) for m in others if m.span is not None and m.span != first.span)
        listed = [f"`{about}` at {s.line}:{s.column}" if about else f"{s.line}:{s.column}" for about, s in places]
        if len(listed) > MOST_PLACES:
            listed[MOST_PLACES:] = [f"{len(listed) - MOST_PLACES} more places"]
        if listed:
            among = listed[0] if len(listed) == 1 else f"{', '.join(listed[:-1])} and {listed[-1]}"
            first = Mistake(f"{first.message} (also {'' if first.about else 'at '}{among})", first.remedy, first.span)
        return render_mistake(file or self.file, self.texts[file] if file else self.text, first)


def _unnamed(mistake: Mistake) -> tuple[str, str]:
    """Message and remedy without the name they are about."""
    if not mistake.about:
        return mistake.message, mistake.remedy
    return mistake.message.replace(mistake.about, "\0"), mistake.remedy.replace(mistake.about, "\0")


class SymgenBug(Exception):
    """A fault of symgen itself, never of the user: names the stage and what was being worked on."""


# Characters of a line of the file that are shown; of a longer one the part about the mistake.
EXCERPT_WIDTH = 110
# Places of mistakes of one kind that are listed; the others are counted.
MOST_PLACES = 8


def printable(text: str) -> str:
    """The text with a visible character for each that would move the cursor, reverse the line or colour the screen."""
    return "".join(c if c.isprintable() else " " if c == "\t" else "�" for c in text)


def render_mistake(file: str, text: str, mistake: Mistake) -> str:
    """One mistake as text, ending in a line break."""
    message, remedy = printable(mistake.message), printable(mistake.remedy)
    if mistake.span is None:
        return f"{file}: {message}\n  remedy: {remedy}\n"
    span = mistake.span
    lines = text.splitlines()
    line = lines[span.line - 1] if 0 < span.line <= len(lines) else ""
    start = max(0, span.column - 1 - EXCERPT_WIDTH // 2) if len(line) > EXCERPT_WIDTH else 0
    excerpt = printable(line[start : start + EXCERPT_WIDTH])
    width = max(1, min(span.end_column - span.column, len(excerpt) - (span.column - 1 - start)))
    marker = " " * (span.column - 1 - start) + "^" * width
    gutter = f"{span.line:5d} | "
    return (
        f"{file}:{span.line}:{span.column}: {message}\n"
        f"{gutter}{excerpt}\n{' ' * (len(gutter) - 2)}| {marker}\n"
        f"  remedy: {remedy}\n"
    )
