"""Displayed matrices: whole where they fit, with a common denominator named, otherwise entry by entry."""

from __future__ import annotations

from collections import Counter
from typing import Any

import sympy

from symgen.report.document import Block, Formula
from symgen.report.from_sympy import SympyLayout
from symgen.report.layout import Array, Fraction, Layout, Letter, Numeral, Product, Punctuation, Row, Scripts, equation, size
from symgen.report.measure import page_width
from symgen.report.names import name_layout
from symgen.report.prose import paragraph

ROOM = 40.0
LARGEST = 3000
"""Nodes above which a matrix is described, not printed."""
DENOMINATOR_NAMES = ("a", "d", "h", "w", "D_0")
ZERO = Numeral("0")


def array_blocks(symbol: Layout, array: Array, label: str | None) -> tuple[Block, ...]:
    """symbol = array in one formula, or one equation per entry that is not zero."""
    whole = equation(symbol, array)
    if page_width(whole) <= ROOM:
        return (Formula((whole,), label),)
    rows = array.rows
    column = len(rows[0]) == 1
    symmetric = len(rows) == len(rows[0]) and all(rows[i][j] == rows[j][i] for i in range(len(rows)) for j in range(i))
    entries = tuple(
        equation(_entry_symbol(symbol, i, None if column else j), entry)
        for i, row in enumerate(rows)
        for j, entry in enumerate(row)
        if entry != ZERO and not (symmetric and j < i)
    )
    what = "components" if column else "entries on and above the diagonal" if symmetric else "entries"
    kind = "is symmetric; its " if symmetric and not column else "has the "
    words = f"{{}} {kind}{what} that are not zero are" if symmetric and not column else f"{{}} {kind}non-zero {what}"
    return (paragraph(words, symbol), Formula(entries, label))


def matrix_blocks(symbol: Layout, matrix: Any, layout: SympyLayout, taken: frozenset[str], label: str | None) -> tuple[Block, ...]:
    """A SymPy matrix, with the denominator most entries share set before it under a name of its own."""
    named = _common_denominator(matrix, taken)
    if named is None:
        array = layout.matrix(matrix)
        if size(array) > LARGEST:
            return (_too_long(symbol, size(array)),)
        return array_blocks(symbol, array, label)
    name, denominator, numerators = named
    array = layout.matrix(numerators)
    if size(array) > LARGEST:
        return (_too_long(symbol, size(array)),)
    where = equation(name_layout(name), layout.expression(denominator))
    over = Fraction(Numeral("1"), name_layout(name))
    whole = equation(symbol, Product((over, array)))
    if page_width(whole) <= ROOM:
        return (Formula((whole,), label), paragraph("with"), Formula((where,)))
    scaled = Product((name_layout(name), symbol))
    return (paragraph("With the common denominator"), Formula((where,)), *array_blocks(scaled, array, label))


def _entry_symbol(symbol: Layout, i: int, j: int | None) -> Layout:
    """One entry of a matrix: the symbol in parentheses where it is composed, with its indices."""
    index: Layout = Numeral(str(i + 1))
    if j is not None:
        index = Row((Numeral(str(i + 1)), Punctuation(","), Numeral(str(j + 1))))
    if isinstance(symbol, Product) and len(symbol.factors) == 2 and isinstance(symbol.factors[0], Letter):
        return Product((symbol.factors[0], _entry_symbol(symbol.factors[1], i, j)))
    if isinstance(symbol, Letter):
        return Scripts(symbol, index)
    return Scripts(Row((Letter("(", "upright"), symbol, Letter(")", "upright"))), index)


def _too_long(symbol: Layout, nodes: int) -> Block:
    """What is said instead of a formula nobody reads."""
    return paragraph(f"The closed form of {{}} has about {nodes} symbols and is not printed.", symbol)


def _common_denominator(matrix: Any, taken: frozenset[str]) -> tuple[str, Any, Any] | None:
    """A sum that divides at least two entries and most of those that are not zero: its name, itself, the numerators."""
    entries = [entry for entry in matrix if entry != 0]
    found: Counter[Any] = Counter()
    for entry in entries:
        found.update(_denominators(entry))
    shared = [factor for factor, count in found.items() if count >= 2 and 2 * count > len(entries)]
    if not shared:
        return None
    factor = max(shared, key=lambda candidate: (found[candidate], str(candidate)))
    name = next(candidate for candidate in DENOMINATOR_NAMES if candidate not in taken)
    symbol = sympy.Symbol(name)
    numerators = matrix.applyfunc(lambda entry: _times(entry, factor, symbol))
    return name, factor, numerators


def _denominators(entry: Any) -> list[Any]:
    """Sums in the denominator of an entry, to whatever power."""
    factors = entry.args if entry.is_Mul else (entry,)
    return [factor.base for factor in factors if factor.is_Pow and factor.exp.is_negative and factor.base.is_Add]


def _times(entry: Any, factor: Any, symbol: Any) -> Any:
    """entry · factor, with the factor cancelled or written by its name."""
    if entry == 0:
        return entry
    kept = []
    power = 1
    for part in entry.args if entry.is_Mul else (entry,):
        if part.is_Pow and part.base == factor and part.exp.is_Integer:
            power += int(part.exp)
        else:
            kept.append(part)
    return sympy.Mul(*kept, symbol**power)
