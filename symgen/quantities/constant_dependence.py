"""Rows that are sums of others with the same numbers everywhere, such as a row that is written down twice.

The numbers y of y^T B = 0 are found in a prime field, at points where coordinates and parameters are residues, and
read back as fractions: what holds of residues at random holds of the rows (Schwartz and Zippel).  So there are points
enough once one more tells nothing new.  Rows that depend on each other on the constraints alone have no such numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import count
from typing import TypeAlias

from symgen.linear_algebra.residue_rows import ReducedRows, with_row
from symgen.symbolic.angles.circle import FIELD
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.matrix import Matrix

Numbers: TypeAlias = tuple[Fraction, ...]

# Numerators and denominators are below this: a residue at random is next to never such a fraction.
LONGEST_NUMBER = 100_000_000_000_000_000_000


def numbers_of_dependent_rows(rows: Matrix, factors: Sequence[Fraction]) -> tuple[Numbers, ...]:
    """A basis of the numbers y with y^T B = 0, of rows that stand here times `factors`.

    Empty where a point says nothing, or where the numbers are no short fractions.
    """
    prime = FIELD.prime
    scales = [FIELD.number(1 / factor) or 0 for factor in factors]
    known: dict[int, Sequence[int]] = {}
    for seed in count():
        values = ExactValues(seed)([entry for row in rows for entry in row])
        whole = [value for value in values if isinstance(value, int)]
        if len(whole) < len(values):
            return ()
        columns, before = len(values) // len(rows), len(known)
        by_row = [whole[start : start + columns] for start in range(0, len(whole), columns)]
        for column in zip(*by_row, strict=True):
            scaled = [scale * value % prime for scale, value in zip(scales, column, strict=True)]
            known = with_row(known, scaled, prime)
        if len(known) == before:
            break
    vectors = [[_fraction(x, prime) for x in vector] for vector in _null_space(known, len(rows), prime)]
    basis = [tuple(x for x in vector if x is not None) for vector in vectors]
    return tuple(basis) if all(len(vector) == len(rows) for vector in basis) else ()


def projector(basis: Sequence[Numbers]) -> tuple[Numbers, ...]:
    """The orthogonal projector onto what is at right angles to these vectors, which do not depend on each other."""
    size = len(basis[0])
    made = [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]
    for vector in basis:
        # Gram and Schmidt, without roots
        left = [sum((row[j] * vector[j] for j in range(size)), Fraction(0)) for row in made]
        square = sum((x * x for x in left), Fraction(0))
        made = [[made[i][j] - left[i] * left[j] / square for j in range(size)] for i in range(size)]
    return tuple(map(tuple, made))


def _null_space(pivots: ReducedRows, size: int, prime: int) -> list[list[int]]:
    """A basis of what satisfies all of them, one residue 1 and others 0 where nothing is determined."""
    basis = []
    for free in (k for k in range(size) if k not in pivots):
        vector = [int(k == free) for k in range(size)]
        for place, row in pivots.items():
            vector[place] = -row[free] % prime
        basis.append(vector)
    return basis


def _fraction(residue: int, prime: int) -> Fraction | None:
    """The fraction of a residue whose numerator and denominator are short, if there is one (Wang 1981)."""
    (last, below), (rest, denominator) = (prime, 0), (residue, 1)
    while rest > LONGEST_NUMBER:
        quotient = last // rest
        last, rest = rest, last - quotient * rest
        below, denominator = denominator, below - quotient * denominator
    return None if abs(denominator) > LONGEST_NUMBER or not denominator else Fraction(rest, denominator)
