"""Mathematics as it is set on a page: a small frozen tree between SymPy (or the model's syntax tree) and four printers.

The tree says what stands where (a fraction, a subscript, a matrix), not what it means; sums and products stay
recognizable because lines are broken there.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from symgen.records import dataclass

Style: TypeAlias = Literal["italic", "upright", "bold"]
Fence: TypeAlias = Literal["(", "[", "|", ""]
CLOSING: dict[str, str] = {"(": ")", "[": "]", "|": "|", "": ""}


@dataclass(frozen=True, slots=True)
class Numeral:
    """Digits, perhaps with a decimal point; `rounded` where the number has more of them."""

    text: str
    rounded: bool = False


@dataclass(frozen=True, slots=True)
class Letter:
    """A letter or word: italic for variables, bold for matrices, upright for words and functions."""

    text: str
    style: Style = "italic"


@dataclass(frozen=True, slots=True)
class Relation:
    """=, ≠, ≤, ∈ and the like, set with space on both sides."""

    text: str


@dataclass(frozen=True, slots=True)
class Sign:
    """+, − or · standing free, where a sum or product was taken apart to break a line; `prefix` binds to the right."""

    text: Literal["+", "-", "·"]
    prefix: bool = False


@dataclass(frozen=True, slots=True)
class Punctuation:
    """A comma or a word between formulas, set with space after it."""

    text: str


@dataclass(frozen=True, slots=True)
class Gap:
    """Wide space between equations that share a line."""


@dataclass(frozen=True, slots=True)
class Scripts:
    """A base with a subscript, a superscript, or both."""

    base: Layout
    lower: Layout | None = None
    upper: Layout | None = None


@dataclass(frozen=True, slots=True)
class Accent:
    """A mark over a letter: one dot, two dots, a bar or a tilde."""

    base: Layout
    mark: Literal["dot", "ddot", "bar", "tilde"]


@dataclass(frozen=True, slots=True)
class Fraction:
    """Numerator over denominator."""

    numerator: Layout
    denominator: Layout


@dataclass(frozen=True, slots=True)
class Root:
    """A square root."""

    radicand: Layout


@dataclass(frozen=True, slots=True)
class Fenced:
    """Something between parentheses, brackets or bars."""

    body: Layout
    fence: Fence = "("


@dataclass(frozen=True, slots=True)
class Application:
    """A function before its argument, which carries its own parentheses where it needs them."""

    function: Layout
    argument: Layout


@dataclass(frozen=True, slots=True)
class Product:
    """Factors side by side."""

    factors: tuple[Layout, ...]


@dataclass(frozen=True, slots=True)
class Sum:
    """Terms with their signs; the first sign is printed only where it is negative."""

    terms: tuple[tuple[Literal["+", "-"], Layout], ...]


@dataclass(frozen=True, slots=True)
class Row:
    """Pieces in a row without space of their own, for example an equation."""

    pieces: tuple[Layout, ...]


@dataclass(frozen=True, slots=True)
class Array:
    """A matrix with its parentheses, or a determinant between bars."""

    rows: tuple[tuple[Layout, ...], ...]
    fence: Literal["(", "|"] = "("


@dataclass(frozen=True, slots=True)
class Delimiter:
    """One parenthesis alone, where the line was broken between it and its partner; `upper` is a power of the group."""

    text: str
    upper: Layout | None = None


Layout: TypeAlias = (
    Numeral
    | Letter
    | Relation
    | Sign
    | Punctuation
    | Gap
    | Scripts
    | Accent
    | Fraction
    | Root
    | Fenced
    | Application
    | Product
    | Sum
    | Row
    | Array
    | Delimiter
)


def minus(node: Layout) -> Layout:
    """The node with its sign turned; a sum is set in parentheses."""
    if isinstance(node, Sum):
        if len(node.terms) == 1:
            sign, body = node.terms[0]
            return body if sign == "-" else Sum((("-", body),))
        return Sum((("-", Fenced(node)),))
    return Sum((("-", node),))


def signed(node: Layout) -> tuple[Literal["+", "-"], Layout]:
    """The node as a term of a sum: its sign and the rest."""
    if isinstance(node, Sum) and len(node.terms) == 1:
        return node.terms[0]
    return "+", node


def total(nodes: tuple[Layout, ...]) -> Layout:
    """The sum of nodes, nested sums opened."""
    terms: list[tuple[Literal["+", "-"], Layout]] = []
    for node in nodes:
        terms.extend(node.terms if isinstance(node, Sum) else (("+", node),))
    return terms[0][1] if len(terms) == 1 and terms[0][0] == "+" else Sum(tuple(terms))


def equation(left: Layout, right: Layout) -> Row:
    """left = right."""
    return Row((left, Relation("="), right))


def begins_with_digit(node: Layout) -> bool:
    """Whether the first thing on the line is a digit, so that a number before it would run into it."""
    match node:
        case Numeral():
            return True
        case Scripts(base=base):
            return begins_with_digit(base)
        case Product(factors=factors):
            return begins_with_digit(factors[0])
        case _:
            return False


def separator(left: Layout, right: Layout) -> Literal["", "thin", "point"]:
    """What stands between two factors: nothing, a thin space, or a multiplication point."""
    if begins_with_digit(right):
        return "point"
    if isinstance(left, Fraction) and isinstance(right, Fraction):
        return "point"
    if any(_wants_air(node) for node in (left, right)):
        return "thin"
    return ""


def _wants_air(node: Layout) -> bool:
    """Functions, fractions and words stand apart from their neighbours."""
    match node:
        case Application() | Fraction() | Root() | Array():
            return True
        case Letter(text=text):
            return len(text) > 1
        case Scripts(base=base) | Accent(base=base):
            return _wants_air(base)
        case _:
            return False


def tall(node: Layout) -> bool:
    """Whether the node is higher than a line, so that its parentheses must grow."""
    match node:
        case Fraction() | Root() | Array():
            return True
        case Scripts(base=base) | Accent(base=base):
            return tall(base)
        case Fenced(body=body):
            return tall(body)
        case Application(function=function, argument=argument):
            return tall(function) or tall(argument)
        case Product(factors=children) | Row(pieces=children):
            return any(tall(child) for child in children)
        case Sum(terms=terms):
            return any(tall(term) for _, term in terms)
        case _:
            return False


def size(node: Layout) -> int:
    """The number of nodes, a measure of how much there is to read."""
    match node:
        case Scripts(base=base, lower=lower, upper=upper):
            return 1 + size(base) + (size(lower) if lower else 0) + (size(upper) if upper else 0)
        case Fraction(numerator=left, denominator=right) | Application(function=left, argument=right):
            return 1 + size(left) + size(right)
        case Accent(base=inner) | Root(radicand=inner) | Fenced(body=inner):
            return 1 + size(inner)
        case Product(factors=children) | Row(pieces=children):
            return 1 + sum(size(child) for child in children)
        case Sum(terms=terms):
            return 1 + sum(size(term) for _, term in terms)
        case Array(rows=rows):
            return 1 + sum(size(entry) for row in rows for entry in row)
        case _:
            return 1


def rounded(node: Layout) -> bool:
    """Whether a number in the node has more digits than are set."""
    match node:
        case Numeral(rounded=fewer):
            return fewer
        case Scripts(base=base, lower=lower, upper=upper):
            return any(rounded(part) for part in (base, lower, upper) if part is not None)
        case Fraction(numerator=left, denominator=right) | Application(function=left, argument=right):
            return rounded(left) or rounded(right)
        case Accent(base=inner) | Root(radicand=inner) | Fenced(body=inner):
            return rounded(inner)
        case Product(factors=children) | Row(pieces=children):
            return any(rounded(child) for child in children)
        case Sum(terms=terms):
            return any(rounded(term) for _, term in terms)
        case Array(rows=rows):
            return any(rounded(entry) for row in rows for entry in row)
        case Delimiter(upper=upper):
            return upper is not None and rounded(upper)
        case _:
            return False
