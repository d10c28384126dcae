"""A user's text inside comments and docstrings: whatever it holds, it ends neither of them and hides no code."""

from __future__ import annotations

import re
import textwrap
import unicodedata

# Characters of a line of a comment or docstring, without what opens and closes it.
COMMENT_WIDTH = 110


def one_line(text: str) -> str:
    """`text` on one line, without control, format (bidirectional) and surrogate characters."""
    printable = "".join(" " if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Co", "Zl", "Zp") else c for c in text)
    return " ".join(printable.split())


def c_comment(text: str) -> str:
    """One line of text that is harmless inside a C comment: no comment marks, no trigraphs, no spliced lines."""
    safe = re.sub(r"\?(?=\?)", "? ", one_line(text))
    safe = safe.replace("*/", "* /").replace("/*", "/ *")
    return safe + " ." if safe.endswith("\\") else safe


def c_comment_lines(text: str, indent: str = "") -> tuple[str, ...]:
    """Text wrapped for a C comment; continuation lines are indented by `indent`."""
    wrapped = textwrap.wrap(one_line(text), COMMENT_WIDTH, subsequent_indent=indent, break_long_words=False)
    return tuple(indent_of(line) + c_comment(line) for line in wrapped)


def docstring_lines(text: str, indent: str = "") -> tuple[str, ...]:
    """Text wrapped for a Python docstring, backslashes and quotes escaped."""
    wrapped = textwrap.wrap(one_line(text), COMMENT_WIDTH, subsequent_indent=indent, break_long_words=False)
    return tuple(line.replace("\\", "\\\\").replace('"""', '\\"\\"\\"') for line in wrapped)


def indent_of(line: str) -> str:
    """The leading blanks of a line."""
    return line[: len(line) - len(line.lstrip())]
