"""Breaks long formulas into lines: at relations first, then between terms, then factors, last inside parentheses.

Widths are estimates, in em for pages and in characters for the terminal; a line is never planned wider than its room,
except where a single letter or number is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from symgen.records import dataclass
from symgen.report.mathematics.layout import (
    CLOSING,
    Application,
    Delimiter,
    Fenced,
    Fraction,
    Layout,
    Numeral,
    Product,
    Punctuation,
    Relation,
    Root,
    Row,
    Scripts,
    Sign,
    Sum,
)

Measure: TypeAlias = Callable[[Layout], float]
GLUED = 99
"""Depth of a piece that must stay on the line of the one before it."""
KEPT_WHOLE = 0.6
"""A piece narrower than this part of the room is not taken apart."""
ONE = Numeral("1")
LOOK_BACK = 0.5
"""How much of a full line may move to the next one to break at a better place."""


@dataclass(frozen=True, slots=True)
class Piece:
    """Something that stays whole; `depth` tells how bad a break before it is (0 = best, GLUED = forbidden)."""

    node: Layout
    depth: int


def break_lines(node: Layout, measure: Measure, room: float, indent: float = 2.0) -> tuple[Row, ...]:
    """The node on as many lines as it needs; lines after the first have `indent` less room."""
    if measure(node) <= room:
        return (Row((node,)),)
    pieces = _pieces(node, 0, 0, measure, room - indent)
    lines: list[Row] = []
    while pieces:
        space = room if not lines else room - indent
        count = _fitting(pieces, measure, space)
        lines.append(Row(tuple(piece.node for piece in pieces[:count])))
        pieces = pieces[count:]
    return tuple(lines)


def _fitting(pieces: list[Piece], measure: Measure, space: float) -> int:
    """How many pieces go on this line: as many as fit, fewer where that makes the break better."""
    used, count = 0.0, 0
    ends: list[float] = []
    while count < len(pieces):
        used += measure(pieces[count].node)
        if used > space and count:
            break
        ends.append(used)
        count += 1
    if count == len(pieces):
        return count
    candidates = [k for k in range(1, count + 1) if pieces[k].depth < GLUED and ends[k - 1] >= LOOK_BACK * space]
    if not candidates:
        candidates = [k for k in range(1, count + 1) if pieces[k].depth < GLUED]
    if candidates:
        return min(candidates, key=lambda k: (pieces[k].depth, -k))
    return next((k for k in range(count + 1, len(pieces)) if pieces[k].depth < GLUED), len(pieces))


def _pieces(node: Layout, first: int, level: int, measure: Measure, room: float) -> list[Piece]:
    """The node taken apart as far as needed: the first piece has depth `first`, the others `level` or more."""
    if level and measure(node) <= KEPT_WHOLE * room:
        return [Piece(node, first)]
    match node:
        case Row(pieces=inner):
            return _row(inner, first, level, measure, room)
        case Sum(terms=terms):
            return _sum(terms, first, level, measure, room)
        case Product(factors=factors):
            return _product(factors, first, level, measure, room)
        case Fenced(body=body, fence=fence):
            return _fenced(body, fence, None, first, level, measure, room)
        case Scripts(base=Fenced(body=body, fence=fence), lower=None, upper=upper):
            return _fenced(body, fence, upper, first, level, measure, room)
        case Application(function=function, argument=argument):
            return [Piece(function, first), *_pieces(argument, GLUED, level + 1, measure, room)]
        case Fraction(numerator=numerator, denominator=denominator) if measure(node) > room:
            return _fraction(numerator, denominator, first, level, measure, room)
        case Root(radicand=radicand) if measure(node) > room:
            half = Scripts(Fenced(radicand), None, Fraction(ONE, Numeral("2")))
            return _pieces(half, first, level, measure, room)
        case _:
            return [Piece(node, first)]


def _row(inner: tuple[Layout, ...], first: int, level: int, measure: Measure, room: float) -> list[Piece]:
    """A row: breaks before relations and after punctuation; a short left-hand side keeps its relation."""
    pieces: list[Piece] = []
    for position, node in enumerate(inner):
        before = inner[position - 1] if position else None
        breakable = isinstance(node, Relation) or isinstance(before, Punctuation)
        here = first if position == 0 else level if breakable else GLUED
        pieces.extend(_pieces(node, here, level + 1, measure, room))
    if len(pieces) > 1 and isinstance(pieces[1].node, Relation) and measure(pieces[0].node) < KEPT_WHOLE * room:
        pieces[1] = Piece(pieces[1].node, GLUED)
    return pieces


def _sum(terms: tuple[tuple[str, Layout], ...], first: int, level: int, measure: Measure, room: float) -> list[Piece]:
    """A sum: breaks before the signs, worse ones inside its terms."""
    pieces: list[Piece] = []
    for position, (sign, term) in enumerate(terms):
        here = level + 1 if position else first
        if position or sign == "-":
            pieces.append(Piece(Sign("-" if sign == "-" else "+", prefix=position == 0), here))
            here = GLUED
        pieces.extend(_pieces(term, here, level + 2, measure, room))
    return pieces


def _product(factors: tuple[Layout, ...], first: int, level: int, measure: Measure, room: float) -> list[Piece]:
    """A product: runs of narrow factors stay together, breaks come before multiplication points."""
    pieces: list[Piece] = []
    run: list[Layout] = []
    for factor in factors:
        # a number alone does not end a line
        most = room if all(isinstance(one, Numeral) for one in run) else KEPT_WHOLE * room
        if run and measure(Product((*run, factor))) > most:
            pieces += _run(run, first if not pieces else None, level, measure, room)
            run = []
        run.append(factor)
    return [*pieces, *_run(run, first if not pieces else None, level, measure, room)]


def _run(run: list[Layout], first: int | None, level: int, measure: Measure, room: float) -> list[Piece]:
    """Factors that stay together, after a multiplication point where they are not the first."""
    node = run[0] if len(run) == 1 else Product(tuple(run))
    if first is not None:
        return _pieces(node, first, level + 1, measure, room) if len(run) == 1 else [Piece(node, first)]
    rest = _pieces(node, GLUED, level + 1, measure, room) if len(run) == 1 else [Piece(node, GLUED)]
    return [Piece(Sign("·"), level + 1), *rest]


def _fenced(
    body: Layout, fence: str, upper: Layout | None, first: int, level: int, measure: Measure, room: float
) -> list[Piece]:
    """Both delimiters alone, the body between them open to breaks."""
    return [
        Piece(Delimiter(fence), first),
        *_pieces(body, GLUED, level + 2, measure, room),
        Piece(Delimiter(CLOSING[fence], upper), GLUED),
    ]


def _fraction(top: Layout, bottom: Layout, first: int, level: int, measure: Measure, room: float) -> list[Piece]:
    """A fraction too wide for a line: 1/denominator before the numerator, or the denominator to the power −1."""
    numerator: Layout = Fenced(top) if isinstance(top, Sum) else top
    if measure(bottom) <= KEPT_WHOLE * room:
        return _pieces(Product((Fraction(ONE, bottom), numerator)), first, level, measure, room)
    inverse = Scripts(Fenced(bottom), None, Sum((("-", ONE),)))
    return _pieces(inverse if top == ONE else Product((numerator, inverse)), first, level, measure, room)
