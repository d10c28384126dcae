"""Singular sets as determinants of small matrices: rows are stacked on B, and what is left falls into blocks.

Velocities that some rows X say (the rates of driven coordinates, of measured ones, of a task) determine all others
where [X; B] is regular.  Its determinant is a product over its diagonal blocks, up to its sign.
"""

from __future__ import annotations

from math import prod

from sympy import Expr, ImmutableDenseMatrix, Integer, Mul

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import determinant
from symgen.closedform.algebra.quotient import Matrix, Quotient, polynomial
from symgen.closedform.exact import Exact
from symgen.closedform.laws.bases import entry_of
from symgen.closedform.laws.condensed import condensed
from symgen.closedform.singular import essential_factors
from symgen.closedform.spelling import Speller
from symgen.linear_algebra.triangular_blocks import DiagonalBlock, triangular_blocks
from symgen.records import dataclass

MOST_BLOCK_PRODUCTS = 100
"""Products of terms in a determinant up to which it is multiplied out, to see what factors it has."""

MOST_CONDENSING = 4000
"""Products of terms for making a determinant smaller: what takes more is not short."""

WIDEST_CONDENSED = 18
"""Operations in the longest entries of the columns of a determinant up to which it fits on a page."""

MOST_LISTED_ROWS = 10
"""A determinant of more rows is wider than a page; it is printed where it is one of whole columns of B."""

LONGEST_FACTOR = 40
"""A determinant with more operations is printed as that of its matrix."""


@dataclass(frozen=True, slots=True)
class BlockDeterminant:
    """A factor of det [X; B]: of a part, with `entry_symbol`s of B and entries of X, or of a condensed one.

    `columns` are the places of its coordinates, none of a condensed one; `whole`: it has all rows of B and none of X.
    `zero` is an expression that vanishes where it does, 1 where that is nowhere; None where it is long.
    """

    matrix: ImmutableDenseMatrix
    columns: tuple[int, ...]
    whole: bool
    zero: Expr | None


def determinant_blocks(exact: Exact, speller: Speller, given: Matrix) -> tuple[BlockDeterminant, ...] | None:
    """The blocks whose determinants multiply to |det [X; B]|, X given (delta x n); None where it vanishes by nature.

    For independent rows of B.
    """
    whole = (*given, *exact.mechanics.jacobian)
    blocks = triangular_blocks([[bool(entry) for entry in row] for row in whole])
    if blocks is None:
        return None
    return tuple(one for block in blocks for one in _of_block(exact, speller, whole, len(given), block))


def _of_block(
    exact: Exact, speller: Speller, whole: Matrix, above: int, block: DiagonalBlock
) -> tuple[BlockDeterminant, ...]:
    """A block, or what it is multiplied of once rows that share a column are one, where that is short."""
    plain = _block(exact, speller, whole, above, block)
    if plain.zero is not None:
        return (plain,)
    try:
        with exact.ring.work.limited("determinants with shared columns", MOST_CONDENSING):
            return _condensed(exact, speller, whole, block) or (plain,)
    except TooLargeError:
        return (plain,)


def _condensed(
    exact: Exact, speller: Speller, whole: Matrix, block: DiagonalBlock
) -> tuple[BlockDeterminant, ...]:
    """The smaller determinant and the factors of its rows; nothing where it is no smaller, or wide."""
    part = tuple(tuple(whole[i][j] for j in sorted(block.columns)) for i in block.rows)
    if not all(entry.is_polynomial for row in part for entry in row):
        return ()
    smaller, contents = condensed(exact.ring, part)
    if not contents:
        return ()
    spelled = _spelled(speller, smaller)
    columns = (spelled.col(j) for j in range(spelled.cols))
    if sum(max(int(entry.count_ops()) for entry in column) for column in columns) > WIDEST_CONDENSED:
        return ()
    factors = (((polynomial(exact.ring, content),),) for content in contents)
    return (
        BlockDeterminant(spelled, (), False, _zero(exact, speller, smaller)),
        *(BlockDeterminant(_spelled(speller, factor), (), False, _zero(exact, speller, factor)) for factor in factors),
    )


def _spelled(speller: Speller, matrix: Matrix) -> ImmutableDenseMatrix:
    return ImmutableDenseMatrix([[speller.quotient(entry) for entry in row] for row in matrix])


def _block(exact: Exact, speller: Speller, whole: Matrix, above: int, block: DiagonalBlock) -> BlockDeterminant:
    columns = sorted(block.columns)
    part = tuple(tuple(whole[i][j] for j in columns) for i in block.rows)
    jacobian = exact.mechanics.jacobian
    named = [
        [speller.quotient(whole[i][j]) if i < above else entry_of(speller, jacobian, i - above, j) for j in columns]
        for i in block.rows
    ]
    whole_rows = set(block.rows) == set(range(above, len(whole)))
    return BlockDeterminant(ImmutableDenseMatrix(named), tuple(columns), whole_rows, _zero(exact, speller, part))


def _zero(exact: Exact, speller: Speller, part: Matrix) -> Expr | None:
    """The product of the factors of a determinant that can vanish, where that is short."""
    if len(part) > 1 and _products(part) > MOST_BLOCK_PRODUCTS:
        return None
    try:
        with exact.ring.work.limited("determinants of blocks"):
            factors = essential_factors(exact.ring, determinant(exact.ring, part).numerator)
    except TooLargeError:
        return None
    zero = Mul(*(_upright(speller.shorter(factor)[1]) for factor in factors))
    return zero if len(part) == 1 or zero.count_ops() <= LONGEST_FACTOR else None


def _products(part: Matrix) -> int:
    """Products of terms in all products of one entry from each row."""
    return prod(sum(len(entry.numerator) for entry in row) for row in part)


def _upright(expression: Expr) -> Expr:
    return -expression if expression.could_extract_minus_sign() else expression


def vanishing(product: tuple[BlockDeterminant, ...]) -> tuple[BlockDeterminant, ...]:
    """Those of a product that vanish somewhere."""
    return tuple(block for block in product if block.zero != Integer(1))


def can_be_printed(product: tuple[BlockDeterminant, ...]) -> bool:
    """Whether all determinants of a product have a name, or entries that fit on a page."""
    return all(block.zero is not None or block.whole or block.matrix.rows <= MOST_LISTED_ROWS for block in product)


def unit_rows(exact: Exact, places: tuple[int, ...]) -> Matrix:
    """The rates of coordinates as rows."""
    one, nothing = exact.mechanics.translator.constant(1), exact.mechanics.translator.constant(0)

    def row(place: int) -> tuple[Quotient, ...]:
        return tuple(one if j == place else nothing for j in range(exact.model.n))

    return tuple(map(row, places))
