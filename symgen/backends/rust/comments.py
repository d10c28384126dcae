"""A user's text in comments that rustdoc reads as Markdown: whatever it holds, it is shown as it stands."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable

from symgen.backends.comments import COMMENT_WIDTH, indent_of, one_line


def prose(text: str) -> tuple[str, ...]:
    """Text wrapped for a comment, signs of Markdown escaped."""
    escaped = re.sub(r"([\\`*_\[\]<>#|~])", r"\\\1", one_line(text))
    return tuple(textwrap.wrap(escaped, COMMENT_WIDTH, break_long_words=False, break_on_hyphens=False))


def as_they_stand(lines: Iterable[str]) -> tuple[str, ...]:
    """Lines between fences, which nothing in them ends; tables keep their columns, what is indented is wrapped."""
    shown: list[str] = []
    for line in lines:
        if indent := indent_of(line):
            wrapped = textwrap.wrap(one_line(line).replace("`", "'"), COMMENT_WIDTH, subsequent_indent="    ")
            shown += [indent + part for part in wrapped]
        else:
            shown.append(line)
    return ("```text", *shown, "```") if shown else ()
