"""Scalars as text of the model language, for messages about singular sets."""

from __future__ import annotations

from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost

# Operations of a scalar up to which a message writes it out.
LONGEST_FORMULA = 160


def formula(node: Scalar) -> str:
    """The scalar written out, or what it is where that would fill the screen."""
    if node.size > LONGEST_FORMULA:
        return f"a pivot of {cost([node]).weight} operations"
    return _text(node, 0)


def _text(node: Scalar, outer: int) -> str:
    """`outer` is the rank of the operation around: 0 sum, 1 what follows a minus, 2 product, 3 divisor."""
    if node.constant is not None:
        value = str(node.constant)
        return f"({value})" if outer and ("/" in value or value.startswith("-")) else value
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


def _wrapped(text: str, needed: bool) -> str:
    return f"({text})" if needed else text
