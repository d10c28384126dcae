"""Whatever a description holds, it stays inside its comment or docstring."""

from __future__ import annotations

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symgen.backends.comments import c_comment, c_comment_lines, docstring_lines, one_line

NASTY = [
    "*/ int x; /*",
    "/*/",
    "**//**",
    "??/",
    "???/",
    "ends in \\",
    'quotes """ and \\',
    "{{ x }}",
    "a\n\rb\0",
    "\u202egnp",
]


@pytest.mark.parametrize("text", NASTY)
def test_c_comment_of_nasty_text(text: str) -> None:
    check_c(text)


@given(st.text(alphabet="*/\\? \n\"'a\u202e"))
def test_c_comment_of_any_text(text: str) -> None:
    check_c(text)


def check_c(text: str) -> None:
    for line in (c_comment(text), *c_comment_lines(text)):
        assert not any(mark in line for mark in ("*/", "/*", "??", "\n", "\u202e"))
        assert not line.endswith("\\")


@given(st.text(alphabet="\\\"' a\n{}N"))
def test_docstring_keeps_the_text(text: str) -> None:
    body = "\n".join(docstring_lines(text))
    tree = ast.parse(f'"""x: {body}\nend\n"""')
    (statement,) = tree.body
    assert isinstance(statement, ast.Expr)
    value = ast.literal_eval(statement.value)
    assert value.split() == f"x: {one_line(text)} end".split()


def test_long_text_is_wrapped() -> None:
    assert all(len(line) <= 116 for line in c_comment_lines("word " * 100))
