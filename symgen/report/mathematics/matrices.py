"""Displayed matrices: whole where they fit, with a common denominator named, otherwise entry by entry."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

import sympy

from symgen.report.document import ROOM, Block, displayed
from symgen.report.mathematics.from_sympy import SympyLayout
from symgen.report.mathematics.layout import (
    Accent,
    Array,
    Fenced,
    Fraction,
    Gap,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Row,
    Scripts,
    equation,
    size,
)
from symgen.report.mathematics.measure import page_width
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.setting import power
from symgen.report.prose import paragraph

MOST_NODES = 3000
"""Nodes above which a matrix is described, not printed."""
ITS_SYMBOL = 6.0
"""Em that the symbol of an entry takes of its line."""
DENOMINATOR_NAMES = ("a", "d", "h", "w")
ZERO = Numeral("0")


def array_blocks(
    symbol: Layout, array: Array, label: str | None, names: tuple[Layout, ...] = ()
) -> tuple[Block, ...]:
    """symbol = array in one formula, or one equation per entry that is not zero; `names` are those of its rows."""
    whole = equation(symbol, array)
    if page_width(whole) <= ROOM:
        return (displayed((whole,), label),)
    rows = array.rows
    column = len(rows[0]) == 1
    symmetric = len(rows) == len(rows[0]) and all(rows[i][j] == rows[j][i] for i in range(len(rows)) for j in range(i))
    entries = tuple(
        equation(_named(symbol, names[i]) if names else _entry_symbol(symbol, i, None if column else j), entry)
        for i, row in enumerate(rows)
        for j, entry in enumerate(row)
        if entry != ZERO and not (symmetric and j < i)
    )
    remarks = []
    if symmetric and not column:
        remarks.append("those below the diagonal follow by symmetry")
    if any(entry == ZERO for row in rows for entry in row):
        remarks.append("those not listed are zero")
    manner = "component by component" if column else "entry by entry"
    opening = paragraph(f"{{}}, {'; '.join([manner, ' and '.join(remarks)] if remarks else [manner])}:", symbol)
    return (opening, displayed(packed(entries), label))


def packed(equations: Iterable[Layout]) -> Iterator[Layout]:
    """Short equations side by side, as many as a line holds."""
    line: list[Layout] = []
    for node in equations:
        extended: list[Layout] = [*line, Punctuation(","), Gap(), node] if line else [node]
        if line and page_width(Row(tuple(extended))) > ROOM:
            yield Row(tuple(line))
            extended = [node]
        line = extended
    if line:
        yield Row(tuple(line))


class Denominators:
    """The denominators named so far in a report, so that each is defined once."""

    def __init__(self, taken: frozenset[str], intermediates: frozenset[str]) -> None:
        self._taken = taken | intermediates
        self._intermediates = intermediates
        self._named: dict[Any, str] = {}

    def common(self, matrix: Any, functions: bool = False) -> tuple[Any, int] | None:
        """A sum or intermediate that divides most entries that are not zero, at least two, and its usual power.

        With `functions` one of these will do, too.
        """
        entries = [entry for entry in matrix if entry != 0]
        powers: Counter[tuple[Any, int]] = Counter()
        for entry in entries:
            powers.update(self._denominators(entry, functions))
        by_base: Counter[Any] = Counter()
        for (base, _), count in powers.items():
            by_base[base] += count
        shared = [factor for factor, count in by_base.items() if count >= 2 and 2 * count > len(entries)]
        if not shared:
            return None
        factor = max(shared, key=lambda candidate: (by_base[candidate], str(candidate)))
        return factor, max((count, exponent) for (base, exponent), count in powers.items() if base == factor)[1]

    def _denominators(self, entry: Any, functions: bool) -> list[tuple[Any, int]]:
        """Sums and intermediates in the denominator of an entry, with their powers."""
        powers = (f for f in (entry.args if entry.is_Mul else (entry,)) if f.is_Pow and f.exp.is_Integer and f.exp < 0)
        bases = ((f.base, -int(f.exp)) for f in powers)
        return [
            (base, power)
            for base, power in bases
            if base.is_Add or str(base) in self._intermediates or (functions and base.is_Function)
        ]

    def name(self, factor: Any) -> tuple[str, bool]:
        """The name of a denominator, and whether it is new."""
        if factor.is_Symbol:
            return factor.name, False
        known = self._named.get(factor)
        if known is not None:
            return known, False
        used = self._taken | set(self._named.values())
        name = next((name for name in DENOMINATOR_NAMES if name not in used), f"D_{len(self._named)}")
        self._named[factor] = name
        return name, True


def matrix_blocks(
    symbol: Layout, matrix: Any, layout: SympyLayout, denominators: Denominators, label: str | None,
    names: tuple[Layout, ...] = (),
) -> tuple[Block, ...]:  # fmt: skip
    """A SymPy matrix, with the denominator most entries share set before it under a name of its own.

    `names` are those of the rows of a column, where they have some.
    """
    shared = denominators.common(matrix)
    if shared is None:
        array = layout.matrix(matrix)
        if any(page_width(entry) > ROOM - ITS_SYMBOL for row in array.rows for entry in row):
            # a fraction would be broken into a product with a reciprocal
            shared = denominators.common(matrix, functions=True)
    if shared is None:
        if size(array) > MOST_NODES:
            return (_too_long(symbol, size(array)),)
        return array_blocks(symbol, array, label, names)
    factor, exponent = shared
    name, new = denominators.name(factor)
    array = layout.matrix(matrix.applyfunc(lambda entry: _times(entry, factor, sympy.Symbol(name), exponent)))
    if size(array) > MOST_NODES:
        return (_too_long(symbol, size(array)),)
    letter = name_layout(name)
    scale = letter if exponent == 1 else power(letter, Numeral(str(exponent)))
    where = equation(letter, layout.expression(factor))
    whole = equation(symbol, Product((Fraction(Numeral("1"), scale), array)))
    if page_width(whole) <= ROOM:
        if not new:
            return (displayed((whole,), label),)
        return (displayed((whole,), label), paragraph("with"), displayed((where,), f"denominator_{name}"))
    opening: tuple[Block, ...] = ()
    if new:
        opening = (paragraph("With the common denominator"), displayed((where,), f"denominator_{name}"))
    return (*opening, *array_blocks(Product((scale, symbol)), array, label, names))


def _entry_symbol(symbol: Layout, i: int, j: int | None) -> Layout:
    """One entry of a matrix: the symbol in parentheses where it is composed, with its indices."""
    index: Layout = Numeral(str(i + 1))
    if j is not None:
        index = Row((Numeral(str(i + 1)), Punctuation(","), Numeral(str(j + 1))))
    if isinstance(symbol, Product) and len(symbol.factors) == 2:
        return Product((symbol.factors[0], _entry_symbol(symbol.factors[1], i, j)))
    if isinstance(symbol, (Letter, Accent)):
        return Scripts(symbol, index)
    return Scripts(Fenced(symbol), index)


def _named(symbol: Layout, name: Layout) -> Layout:
    """One entry of a column whose entries have names, with the factor that stands before the column."""
    return Product((symbol.factors[0], name)) if isinstance(symbol, Product) else name


def _too_long(symbol: Layout, nodes: int) -> Block:
    """What is said instead of a formula nobody reads."""
    return paragraph(f"The closed form of {{}} has about {nodes} symbols and is not printed.", symbol)


def _times(entry: Any, factor: Any, symbol: Any, exponent: int) -> Any:
    """entry · factor**exponent, with the factor cancelled or written by its name."""
    if entry == 0:
        return entry
    kept = []
    remaining = exponent
    for part in entry.args if entry.is_Mul else (entry,):
        if part.is_Pow and part.base == factor and part.exp.is_Integer:
            remaining += int(part.exp)
        else:
            kept.append(part)
    return sympy.Mul(*kept, symbol**remaining).xreplace({factor: symbol})
