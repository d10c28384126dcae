"""Parts of a system that nothing couples: machines side by side, each with coordinates, rows and inputs of its own.

Matrices of many machines consist of blocks, and what is worked out of them does: inverses and determinants of blocks
take as much as there are machines, those of the whole the cube of it.  What is coupled is read from which entries the
Taylor arithmetic leaves empty, never from values.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb_mat


@dataclass(frozen=True, slots=True)
class Part:
    """Numbers of what belongs together, each in rising order."""

    coordinates: tuple[int, ...]
    rows: tuple[int, ...] = ()
    inputs: tuple[int, ...] = ()
    bodies: tuple[int, ...] = ()


def parts(
    n: int,
    rows: Sequence[Iterable[int]],
    inputs: Sequence[Iterable[int]] = (),
    bodies: Sequence[Iterable[int]] = (),
    pairs: Iterable[tuple[int, int]] = (),
) -> tuple[Part, ...]:
    """The parts of n coordinates, of which every row, input and body touches some, and pairs are coupled.

    What touches none belongs to the first part.
    """
    leader = list(range(n))

    def root(j: int) -> int:
        while leader[j] != j:
            leader[j] = leader[leader[j]]
            j = leader[j]
        return j

    kinds = [[sorted(these) for these in kind] for kind in (rows, inputs, bodies)]
    for these in (*(these for kind in kinds for these in kind), *pairs):
        for j in these[1:]:
            first, second = sorted((root(these[0]), root(j)))
            leader[second] = first
    members: dict[int, list[list[int]]] = {}
    for j in range(n):
        members.setdefault(root(j), [[], [], [], []])[0].append(j)
    for place, kind in enumerate(kinds, start=1):
        for number, these in enumerate(kind):
            members.setdefault(root(these[0]) if these else 0, [[], [], [], []])[place].append(number)
    return tuple(Part(*map(tuple, these)) for _, these in sorted(members.items()))


def touched(registers: Sequence[int], columns: int, empty: int) -> list[list[int]]:
    """The columns of each row of a matrix of registers that are not the empty one."""
    rows = len(registers) // columns if columns else 0
    return [[j for j in range(columns) if registers[i * columns + j] != empty] for i in range(rows)]


def piece(matrix: Any, rows: Sequence[int], columns: Sequence[int]) -> Any:
    """Some rows and columns of a matrix; all of them are the matrix itself."""
    if len(rows) == matrix.nrows() and len(columns) == matrix.ncols():
        return matrix
    return arb_mat(len(rows), len(columns), [matrix[i, j] for i in rows for j in columns])


def placed(
    rows: int, columns: int, pieces: Iterable[tuple[Sequence[int], Sequence[int], Any]]
) -> Any:
    """The matrix of pieces at their rows and columns, 0 elsewhere."""
    whole = arb_mat(rows, columns)
    for at_rows, at_columns, block in pieces:
        if len(at_rows) == rows and len(at_columns) == columns:
            return block
        for a, i in enumerate(at_rows):
            for b, j in enumerate(at_columns):
                whole[i, j] = block[a, b]
    return whole


def others(polynomials: Sequence[Sequence[Any]], degree: int) -> Iterator[list[Any]]:
    """For every polynomial the product of all others, up to a degree."""
    behind: list[list[Any]] = [[1]]
    for polynomial in reversed(polynomials[1:]):
        behind.append(product(behind[-1], polynomial, degree))
    before: list[Any] = [1]
    for polynomial in polynomials:
        yield product(before, behind.pop(), degree)
        before = product(before, polynomial, degree)


def product(first: Sequence[Any], second: Sequence[Any], degree: int) -> list[Any]:
    """Of two polynomials by their coefficients, up to a degree."""
    coefficients: list[Any] = [0] * min(degree + 1, len(first) + len(second) - 1)
    for i, x in enumerate(first[: len(coefficients)]):
        for j, y in enumerate(second[: len(coefficients) - i]):
            coefficients[i + j] += x * y
    return coefficients
