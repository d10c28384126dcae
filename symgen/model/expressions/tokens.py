"""The words of an expression: numbers, names, operators, brackets, commas, each with its offset in the text."""

from __future__ import annotations

import re
import unicodedata
from typing import Literal, TypeAlias, cast

from symgen.records import dataclass

TokenKind: TypeAlias = Literal["number", "name", "operator", "end"]

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|//|[-+*/(),.])|(?P<end>$))",
    re.ASCII,
)
_ELEMENTWISE = re.compile(r"\.[*/^]")
_SPACE = re.compile(r"\s*", re.ASCII)
_LOOKALIKES = {
    "−": "-", "–": "-", "—": "-", "‐": "-", "·": "*", "×": "*", "∙": "*", "⋅": "*", "÷": "/", "∕": "/", "²": "**2",
    "³": "**3", "½": "1/2", "π": "pi", "（": "(", "）": ")", "，": ",", "∗": "*", "√": "sqrt( )",
}  # fmt: skip
_OPERATORS_ELSEWHERE = {
    "^": ("`^` is not the power", "write `**`, as in `x**2`"),
    "%": ("`%` is no operator", "write fractions and remainders out"),
    "=": ("`=` in an expression", "write the expression only; a constraint is `left - right`, and = 0 is understood"),
    "'": ("a quotation mark in an expression", "use names, numbers, operators, functions; the rate of x is `x_dot`"),
    '"': ("a quotation mark in an expression", "use names, numbers, operators, functions"),
    "[": ("square brackets in an expression", "use round parentheses"),
    "]": ("square brackets in an expression", "use round parentheses"),
    "{": ("braces in an expression", "use round parentheses"),
    "}": ("braces in an expression", "use round parentheses"),
    "&": ("`&` is no operator", "use + - * / ** and the functions of the language"),
    "|": ("`|` is no operator", "write an absolute value as sqrt(x**2)"),
}


@dataclass(frozen=True, slots=True)
class Token:
    """A word of kind `kind`; `offset` counts characters from the start of the text."""

    kind: TokenKind
    text: str
    offset: int


class ExpressionError(Exception):
    """What is wrong with an expression, at which characters of its text, and what to do."""

    def __init__(self, message: str, remedy: str, offset: int, length: int = 1) -> None:
        super().__init__(message)
        self.message, self.remedy, self.offset, self.length = message, remedy, offset, length


def tokenize(text: str) -> list[Token]:
    """The tokens of `text`, closed by one of kind "end"; raises ExpressionError."""
    tokens: list[Token] = []
    position = 0
    while True:
        match = _TOKEN.match(text, position)
        if match is None:
            start = _SPACE.match(text, position)
            raise _foreign(text, start.end() if start is not None else position)
        kind = match.lastgroup
        assert kind is not None
        offset = match.start(kind)
        tokens.append(Token(cast(TokenKind, kind), match.group(kind), offset))
        if kind == "end":
            return tokens
        position = match.end()
        if elementwise := _ELEMENTWISE.match(text, match.end()):
            raise ExpressionError(
                f"`{elementwise.group()}` is no operator", f"write `{elementwise.group()[1:].replace('^', '**')}`",
                elementwise.start(), 2,
            )  # fmt: skip
        if kind == "number" and text[position : position + 1].isidentifier():
            shown = match.group(kind)
            raise ExpressionError(
                f"an operator is missing after {shown}", f"write `{shown}*...`", offset, len(shown) + 1
            )


def _foreign(text: str, position: int) -> ExpressionError:
    character = text[position]
    if character in _LOOKALIKES:
        name = unicodedata.name(character).lower()
        return ExpressionError(
            f"the character {character!r} ({name}) is not read", f"write `{_LOOKALIKES[character]}`", position
        )
    if character in _OPERATORS_ELSEWHERE:
        return ExpressionError(*_OPERATORS_ELSEWHERE[character], position)
    if character.isascii():
        return ExpressionError(
            f"the character {character!r} is not part of the language", "use + - * / **, parentheses, names, numbers",
            position,
        )  # fmt: skip
    name = unicodedata.name(character, f"code {ord(character):#x}").lower()
    if character.isspace():
        return ExpressionError(f"the character {character!r} ({name}) is not read", "write a plain space", position)
    return ExpressionError(
        f"the character {character!r} ({name}) is not read", "spell names with the letters a-z, A-Z, digits and _",
        position,
    )  # fmt: skip
