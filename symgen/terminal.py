"""What a run prints: progress on standard error, the closing table, notices."""

from __future__ import annotations

import codecs
import os
import re
import shutil
import sys
import textwrap
import time
import unicodedata
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TextIO

from symgen.diagnostics import Notice
from symgen.generation.results import Summary
from symgen.runtime.activity import described
from symgen.runtime.clock import Clock

_ERROR_NOTE = "  * in units of what rounding the inputs and the result does to it"
_CLEAR_LINE = "\r\x1b[K"
# Columns of a terminal that does not say how wide it is.
USUAL_WIDTH = 80
# Columns before a table, and between two columns.
_MARGIN = 2 + 3
# What a message says of how far a stage is: k of n, or percent.
_COUNTED, _PERCENT = re.compile(r"\b(\d+) of (\d+)\b"), re.compile(r"\b(\d+) %")
# Cells of the bar that shows it, and seconds of a stage before which no time that is left is told.
_CELLS, _TOO_SOON = 20, 2.0
# Lines of a file in a message, and the marks below them.
_EXCERPT = re.compile(r" *\d* *\| ")
SPELLED = "symgen-spelled"
_SPELLINGS = {"─": "-", "−": "-", "·": "*", "×": "x", "√": "sqrt", "≠": "!=", "≤": "<=", "≥": ">=", "→": "->"}
_SPELLINGS |= {"\u0303": "~", "\u0307": "_dot", "\u0308": "_ddot"}  # accents that stand behind their letter


class Progress:
    """Tells what is being done: one line that changes on a terminal, nothing when quiet.

    Elsewhere (a log) each stage gets one line: what follows the first comma of a message counts within its stage. A
    stage that takes longer is told again every 2 s, with what it is at, how long it has taken and how long it will.
    On a terminal a stage that counts has a bar, and the time that is left if it goes on so.
    """

    def __init__(self, label: str, quiet: bool, stream: TextIO | None = None) -> None:
        self._label = label
        self._quiet = quiet
        self._stream = sys.stderr if stream is None else stream
        self._live = self._stream.isatty()
        self._stage = self._message = ""
        self._began = self._first = 0.0
        self._printing = False  # a signal must not print into a line that is being printed
        self._clock = Clock(self._tick)

    def __call__(self, message: str) -> None:
        """Shows what starts now; an empty message makes room for other output."""
        if self._quiet:
            return
        if not message:
            self.done()
            return
        stage = message.partition(",")[0]
        new = stage != self._stage
        if new:
            self._began, self._first = time.monotonic(), _share(message) or 0.0
        self._stage, self._message = stage, message
        if self._live:
            self._print(message)
        elif new:
            self._print(stage)
        self._clock.start(anew=self._live or new)

    def done(self) -> None:
        """Removes the changing line."""
        self._clock.stop()
        if not self._quiet and self._live:
            print(_CLEAR_LINE, end="", file=self._stream, flush=True)

    def _tick(self) -> None:
        """Prints what a stage is at that has not printed anything for a while."""
        if not self._printing:
            spent = f"{time.monotonic() - self._began:.0f} s"
            self._print(", ".join(word for word in (self._message, described(), spent) if word))

    def _print(self, message: str) -> None:
        self._printing = True
        line = f"{self._label}: {message} ..."
        try:
            if self._live:
                room = _width(self._stream) - 1  # a line that wraps could not be cleared
                bar = self._bar()
                shown = line + bar if len(line) + len(bar) <= room else line[:room]
                print(_CLEAR_LINE + shown, end="", file=self._stream, flush=True)
            else:
                print(line, file=self._stream, flush=True)
        finally:
            self._printing = False

    def _bar(self) -> str:
        """How far the stage is, and how many seconds are left; empty where it does not count."""
        share = _share(self._message)
        if share is None:
            return ""
        full = round(_CELLS * share)
        bar = f" [{'#' * full}{'-' * (_CELLS - full)}]"
        spent = time.monotonic() - self._began
        if spent < _TOO_SOON or share <= self._first:
            return bar
        return f"{bar} {spent * (1 - share) / (share - self._first):.0f} s left"


def _share(message: str) -> float | None:
    """What a message says is done, from 0 to 1."""
    if (counted := _COUNTED.search(message)) is not None:
        done, total = map(int, counted.groups())
        return min(1.0, done / total) if total else None
    percent = _PERCENT.search(message)
    return None if percent is None else min(1.0, int(percent[1]) / 100)


def _width(terminal: TextIO) -> int:
    """Columns of the terminal itself: standard output may lead elsewhere."""
    try:
        return os.get_terminal_size(terminal.fileno()).columns or USUAL_WIDTH
    except OSError:
        return shutil.get_terminal_size((USUAL_WIDTH, 24)).columns


def summary_table(name: str, summary: Summary, width: int | None = None) -> str:
    """Sizes, largest errors, operations by quantity, and what the system does not need; in so many columns if given."""
    sizes = f"n = {summary.n}, r = {summary.r}, δ = {summary.delta}, m = {summary.m}"
    sections = [f"{name}   {sizes}"]
    if summary.operations:
        rows = [(quantity, str(count)) for quantity, count in summary.operations]
        sections.append(columns(("quantity", "operations"), rows, "<>"))
    if summary.errors:
        errors = [(e.target, f"{e.error:.2g}", f"{e.tolerance:g}", e.quantity) for e in summary.errors]
        sections.append(columns(("largest error*", "found", "allowed", "in"), errors, "<>><") + "\n" + _ERROR_NOTE)
    if summary.skipped:
        skipped = summary.skipped if width is None else _folded(summary.skipped, width - _MARGIN)
        sections.append(columns(("not needed", "because"), skipped, "<<"))
    return "\n\n".join(sections) + "\n"


def _folded(rows: Sequence[tuple[str, str]], width: int) -> list[tuple[str, str]]:
    """Rows of two sentences over several lines, which together have so many columns; long names stay whole."""
    left = min(max(len(what) for what, _ in rows), 2 * width // 5)
    lines: list[tuple[str, str]] = []
    for what, why in rows:
        parts = textwrap.wrap(what, left, break_long_words=False)
        reasons = textwrap.wrap(why, width - left, break_long_words=False)
        lines += zip_longest(parts, reasons, fillvalue="")
    return lines


def written_table(folder: Path, files: Sequence[Path]) -> str:
    """The files that were written below a folder, a line for those of each kind: how many, and the first of them."""
    kinds: dict[str, list[str]] = {}
    for file in files:
        kinds.setdefault(f"{file.parts[0]}/" if len(file.parts) > 1 else "", []).append(file.name)
    width = max(map(len, kinds), default=0)
    lines = [f"written to {folder}/:"]
    for kind, names in sorted(kinds.items(), key=lambda item: not item[0]):
        start = f"  {kind:{width}}  {len(names):3d}  "
        shown = textwrap.shorten(", ".join(names), USUAL_WIDTH - len(start), placeholder=" ...")
        lines.append(start + shown)
    return "\n".join([*lines, ""])


def terminal_width(stream: TextIO) -> int | None:
    """The columns of the terminal that a stream leads to; None where it leads elsewhere."""
    return _width(stream) if stream.isatty() else None


def fitted(text: str, stream: TextIO) -> str:
    """The text as it is, or for a terminal with long lines folded at words; excerpts of files stay."""
    width = terminal_width(stream)
    if width is None:
        return text
    lines = text.splitlines(keepends=True)
    return "".join(line if len(line) <= width or _EXCERPT.match(line) else _hanging(line, width) for line in lines)


def _hanging(line: str, width: int) -> str:
    """A line over several, what goes on indented by more."""
    own = line[: len(line) - len(line.lstrip())]
    ending = "\n" if line.endswith("\n") else ""
    parts = textwrap.wrap(
        line, width, subsequent_indent=f"{own}    ", break_long_words=False, break_on_hyphens=False
    )
    return "\n".join(parts) + ending


def notice_line(file: str, notice: Notice) -> str:
    """A notice with its place."""
    place = file if notice.span is None else f"{notice.span.file or file}:{notice.span.line}:{notice.span.column}"
    return f"{place}: notice: {notice.message}"


def columns(head: Sequence[str], rows: Sequence[Sequence[str]], alignment: str) -> str:
    """Rows below a head, each column as wide as needed; `alignment` has < or > for each."""
    widths = [max(len(row[k]) for row in (head, *rows)) for k in range(len(head))]
    lines = [
        "   ".join(f"{cell:{side}{width}}" for cell, side, width in zip(row, alignment, widths, strict=True)).rstrip()
        for row in (head, *rows)
    ]
    lines.insert(1, "─" * max(len(line) for line in lines))
    return "\n".join("  " + line for line in lines)


def _spelled(error: UnicodeError) -> tuple[str, int]:
    """What an output without a character shows instead: theta for θ, ^2 for a raised 2, or else a question mark."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_spelling, error.object[error.start : error.end])), error.end


def _spelling(character: str) -> str:
    if character in _SPELLINGS:
        return _SPELLINGS[character]
    name = unicodedata.name(character, "")
    if name.startswith("GREEK ") and " LETTER " in name:
        letter = name.rpartition(" ")[2]
        return letter.lower() if " SMALL " in name else letter.capitalize()
    sign = {"<super>": "^", "<sub>": "_"}.get(unicodedata.decomposition(character).partition(" ")[0], "")
    plain = unicodedata.normalize("NFKD", character)
    return sign + plain if plain.isascii() else "?"


codecs.register_error(SPELLED, _spelled)
