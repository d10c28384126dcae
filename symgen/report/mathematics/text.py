"""Layout as plain Unicode text for the terminal: one line for formulas, a grid for matrices."""

from __future__ import annotations

from itertools import pairwise

from symgen.report.mathematics.breaking import break_lines
from symgen.report.mathematics.layout import (
    CLOSING,
    Accent,
    Application,
    Array,
    Delimiter,
    Fenced,
    Fraction,
    Gap,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Relation,
    Root,
    Row,
    Scripts,
    Sign,
    Sum,
    separator,
)

UPPER = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
LOWER = str.maketrans("0123456789-,", "₀₁₂₃₄₅₆₇₈₉₋,")
MARKS = {"dot": "\u0307", "ddot": "\u0308", "bar": "\u0304", "tilde": "\u0303"}
SIGNS = {"+": "+", "-": "−", "·": "·"}
CONTINUATION = "    "


def text_math(node: Layout) -> str:
    """The node on a single line; matrices as [a, b; c, d]."""
    match node:
        case Numeral(text=text) | Letter(text=text):
            return text
        case Relation(text=text):
            return f" {text} "
        case Sign(text=text, prefix=prefix):
            return SIGNS[text] if prefix else f" {SIGNS[text]} "
        case Punctuation(text=text):
            return f"{text} "
        case Gap():
            return "   "
        case Delimiter(text=text, upper=upper):
            return text + ("" if upper is None else _raised(upper))
        case Scripts(base=base, lower=lower, upper=upper):
            below = "" if lower is None else _lowered(lower)
            return f"{text_math(base)}{below}{'' if upper is None else _raised(upper)}"
        case Accent(base=base, mark=mark):
            inner = text_math(base)
            return inner[0] + MARKS[mark] + inner[1:]
        case Fraction(numerator=numerator, denominator=denominator):
            return f"{_grouped(numerator, (Product, Application))}/{_grouped(denominator, ())}"
        case Root(radicand=radicand):
            return f"√({text_math(radicand)})"
        case Fenced(body=body, fence=fence):
            return f"{fence}{text_math(body)}{CLOSING[fence]}"
        case Application(function=function, argument=argument):
            return f"{text_math(function)}{'' if isinstance(argument, Fenced) else ' '}{text_math(argument)}"
        case Product(factors=factors):
            parts = [text_math(factors[0])]
            for left, right in pairwise(factors):
                parts += (_gap(left, right), text_math(right))
            return "".join(parts)
        case Sum(terms=terms):
            return "".join(_term(*term, first=k == 0) for k, term in enumerate(terms))
        case Row(pieces=pieces):
            return "".join(text_math(piece) for piece in pieces)
        case Array(rows=rows, fence=fence):
            inside = "; ".join(", ".join(text_math(entry) for entry in row) for row in rows)
            return f"[{inside}]" if fence == "(" else f"|{inside}|"


def terminal_width(node: Layout) -> float:
    """Columns the node takes on one line; combining dots take none."""
    return float(columns(text_math(node)))


def columns(text: str) -> int:
    """Columns a text takes in the terminal."""
    return len(text) - sum(text.count(mark) for mark in MARKS.values())


def text_lines(node: Layout, width: int, names: tuple[Layout, ...] = ()) -> list[str]:
    """The node wrapped to `width` columns; a matrix as a grid where it fits, otherwise entry by entry.

    `names` are those of the rows of a column, where they have some.
    """
    prefix, array = _split(node)
    if array is not None:
        grid = _grid(array)
        head = text_math(Row(prefix))
        if columns(grid[0]) + columns(head) <= width:
            middle = (len(grid) - 1) // 2
            return [(head if k == middle else " " * columns(head)) + line for k, line in enumerate(grid)]
        kind = "determinant" if array.fence == "|" else "matrix"
        lines = [f"{head}{len(array.rows)}×{len(array.rows[0])} {kind}, entries that are not zero:"]
        for i, row in enumerate(array.rows):
            for j, entry in enumerate(row):
                if entry != Numeral("0"):
                    place = Letter(f"  {text_math(names[i])}" if names else f"  [{i + 1},{j + 1}]")
                    lines += text_lines(Row((place, Relation("="), entry)), width)
        return lines
    rows = break_lines(node, terminal_width, float(width), float(len(CONTINUATION)))
    return [(CONTINUATION if k else "") + text_math(row).strip("\n").rstrip() for k, row in enumerate(rows)]


def _split(node: Layout) -> tuple[tuple[Layout, ...], Array | None]:
    """What stands before the matrix at the end of a row, and the matrix."""
    if isinstance(node, Array) and node.rows:
        return (), node
    if isinstance(node, Row) and node.pieces:
        before, array = _split(node.pieces[-1])
        return (*node.pieces[:-1], *before), array
    return (), None


def _grid(array: Array) -> list[str]:
    """The lines of a matrix with columns aligned."""
    cells = [[text_math(entry) for entry in row] for row in array.rows]
    widths = [max(columns(cell) for cell in column) for column in zip(*cells, strict=True)]
    left, right = ("|", "|") if array.fence == "|" else ("[", "]")
    lines = []
    for row in cells:
        padded = (cell + " " * (width - columns(cell)) for cell, width in zip(row, widths, strict=True))
        lines.append(f"{left} {'  '.join(padded)} {right}")
    return lines


def _gap(left: Layout, right: Layout) -> str:
    """What stands between two factors in the terminal."""
    kind = separator(left, right)
    return {"point": "·", "thin": " ", "": "" if isinstance(left, Numeral) else " "}[kind]


def _raised(node: Layout) -> str:
    """A superscript: small digits where they exist, otherwise ^(…)."""
    text = text_math(node)
    digits = text.replace("−", "-")
    if all(character in "0123456789-" for character in digits):
        return digits.translate(UPPER)
    if text in ("T", "+"):
        return {"T": "ᵀ", "+": "⁺"}[text]
    return f"^{text}" if len(text) == 1 else f"^({text})"


def _lowered(node: Layout) -> str:
    """A subscript: small digits where they exist, otherwise _name."""
    text = text_math(node).replace(", ", ",")
    if all(character in "0123456789," for character in text):
        return text.translate(LOWER)
    return f"_{text.replace(' ', '_')}"


def _grouped(node: Layout, plain: tuple[type, ...]) -> str:
    """A side of a fraction on one line: parentheses unless it is one thing."""
    text = text_math(node)
    if isinstance(node, (Numeral, Letter, Scripts, Accent, Fenced, Root, *plain)):
        return text
    return f"({text})"


def _term(sign: str, term: Layout, first: bool) -> str:
    """A term of a sum with its sign; a leading plus is left out."""
    body = text_math(term)
    return (f"−{body}" if sign == "-" else body) if first else f" {SIGNS[sign]} {body}"
