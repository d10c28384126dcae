"""Scalars as text of the model language, for messages about singular sets."""

from __future__ import annotations

from fractions import Fraction

from symgen.symbolic.exact import half_turns
from symgen.symbolic.scalar import PI, Scalar
from symgen.symbolic.traverse import cost

# Operations of a scalar up to which a message writes it out.
LONGEST_FORMULA = 160
# Digits of a number that nobody has written so.
SHOWN_DIGITS = 9
_LONG = "a pivot of"
# How what is no formula begins.
_WORDS = (_LONG, "the pivot of")


def formula(node: Scalar) -> str:
    """The scalar written out, or what it is where that would fill the screen."""
    if node.size > LONGEST_FORMULA:
        return f"{_LONG} {cost([node]).weight} operations"
    return _text(node, 0)


def quoted(text: str) -> str:
    """A formula as it stands in a sentence, where reports set what is quoted; words stay."""
    return text if text.startswith(_WORDS) else f"`{text}`"


def _text(node: Scalar, outer: int) -> str:
    """`outer` is the rank of the operation around: 0 sum, 1 what follows a minus, 2 product, 3 divisor."""
    if node.constant is not None:
        value = _number(node.constant)
        needed = ("-", outer >= 1), ("/", outer >= 2), ("*", outer >= 3)
        return _wrapped(value, any(inside and sign in value for sign, inside in needed))
    a = node.args
    match node.op:
        case "symbol":
            return str(node.payload)
        case "add":
            return _wrapped(f"{_text(a[0], 0)} + {_text(a[1], 0)}", outer >= 1)
        case "sub":
            return _wrapped(f"{_text(a[0], 0)} - {_text(a[1], 1)}", outer >= 1)
        case "neg":
            return _wrapped(f"-{_text(a[0], 2)}", outer >= 1)
        case "mul" if a[0] is a[1]:
            return f"{_text(a[0], 3)}**2"
        case "mul":
            return _wrapped(f"{_text(a[0], 2)}*{_text(a[1], 2)}", outer >= 3)
        case "div":
            return _wrapped(f"{_text(a[0], 2)}/{_text(a[1], 3)}", outer >= 2)
        case "pow":
            return f"{_text(a[0], 3)}**({node.payload})"
        case _:
            return f"{node.op}({', '.join(_text(argument, 0) for argument in a)})"


def _number(value: Fraction) -> str:
    """As it was written: with pi, as a short fraction, or else as a decimal."""
    turns = half_turns(value)
    if turns and value == turns * PI:
        times = "" if abs(turns.numerator) == 1 else f"{abs(turns.numerator)}*"
        over = "" if turns.denominator == 1 else f"/{turns.denominator}"
        return f"{'-' if turns < 0 else ''}{times}pi{over}"
    written = str(value)
    return written if len(written) <= 2 * SHOWN_DIGITS else f"{float(value):.{SHOWN_DIGITS}g}"


def _wrapped(text: str, needed: bool) -> str:
    return f"({text})" if needed else text
