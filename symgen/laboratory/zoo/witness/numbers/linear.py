"""Linear algebra of the witness: bases by pivoted Gram-Schmidt, solutions of least norm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb_mat

Vector = list[Any]
Matrix = list[Vector]
_HALF = 0.5
# rows that vanish but for the rounding of the numbers in the file
NOTHING = 1e-12


def inner(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """a . b."""
    return sum((x * y for x, y in zip(a, b, strict=True)), 0)


def times(a: Sequence[Sequence[Any]], x: Sequence[Any]) -> Vector:
    """a x."""
    return [inner(row, x) for row in a]


def transposed(a: Sequence[Sequence[Any]], columns: int) -> Matrix:
    """The transpose; `columns` for a matrix without rows."""
    return [[row[k] for row in a] for k in range(columns)]


def size(a: Sequence[Any]) -> float:
    """The Euclidean norm as a float."""
    return float(inner(a, a)) ** 0.5 if a else 0.0


def basis(
    vectors: Sequence[Sequence[Any]], rank: int, whole: Sequence[float] | None = None
) -> tuple[Matrix, list[float]]:
    """Orthonormal vectors that span the `rank` leading ones, and what share of its length each had left when taken.

    The most that is left is taken, times the share that this is: by shares alone what rounding leaves of a vector that
    is 0 would count as much as any, by lengths alone what it leaves of a long one that depends on others. `whole` are
    the lengths of vectors of which only a part is given.
    """
    sizes = [size(vector) for vector in vectors]
    lengths = [length for length, rest in zip(whole or sizes, sizes, strict=True) if rest > NOTHING]
    left = [list(vector) for vector, rest in zip(vectors, sizes, strict=True) if rest > NOTHING]
    taken: Matrix = []
    pivots: list[float] = []
    while len(taken) < rank and left:
        sizes = [size(vector) for vector in left]
        shares = [rest / length for rest, length in zip(sizes, lengths, strict=True)]
        best = max(range(len(left)), key=lambda k: sizes[k] * shares[k])
        if sizes[best] == 0:
            break
        pivots.append(shares[best])
        del lengths[best]
        chosen = left.pop(best)
        length = inner(chosen, chosen) ** _HALF
        direction = [x / length for x in chosen]
        taken.append(direction)
        # twice, so that what is left is orthogonal to the last digit
        for _ in range(2):
            left = [_without(vector, direction) for vector in left]
    return taken, pivots


def _without(vector: Vector, direction: Vector) -> Vector:
    share = inner(vector, direction)
    return [x - share * d for x, d in zip(vector, direction, strict=True)]


def complement(taken: Matrix, n: int, one: Any) -> Matrix:
    """Orthonormal vectors that complete `taken` to a basis of n dimensions."""
    units = [[one if i == k else one * 0 for i in range(n)] for k in range(n)]
    for _ in range(2):
        for direction in taken:
            units = [_without(unit, direction) for unit in units]
    added: Matrix = []
    while len(added) < n - len(taken):
        sizes = [size(unit) for unit in units]
        best = max(range(len(units)), key=sizes.__getitem__)
        chosen = units.pop(best)
        for direction in (*taken, *added):
            chosen = _without(chosen, direction)
        length = inner(chosen, chosen) ** _HALF
        added.append([x / length for x in chosen])
        units = [_without(unit, added[-1]) for unit in units]
    return added


def solve(a: Sequence[Sequence[Any]], b: Sequence[Any]) -> Vector:
    """The solution of a regular square system in balls."""
    return list(arb_mat(a).solve(arb_mat([[x] for x in b])).entries()) if a else []


def determinant(a: Sequence[Sequence[Any]]) -> Any:
    """The determinant in balls; the characteristic polynomial knows it where elimination would divide by 0."""
    return (-1) ** len(a) * arb_mat(a).charpoly()[0] if a else 1


def least(
    a: Sequence[Sequence[Any]], b: Sequence[Any], columns: int, rank: int, whole: Sequence[float] | None = None
) -> tuple[Vector, list[float]]:
    """Of all x with the least |a x - b| the smallest, a being of this rank; and what `basis` says of its columns."""
    if not rank or not columns:
        return [0] * columns, []
    span, pivots = basis(transposed(a, columns), rank, whole)
    inside = [[inner(direction, column) for column in transposed(a, columns)] for direction in span]
    gram = [[inner(x, y) for y in inside] for x in inside]
    weights = solve(gram, times(span, b))
    return [inner(weights, column) for column in transposed(inside, columns)], pivots
