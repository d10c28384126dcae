"""Null spaces by minors: the form Phi of a constraint Jacobian, its projector and the pseudoinverse of N_B M.

Phi_J, for a delta-subset J of the coordinates, is det[e_J, B^T]: the signed minor of B without the columns J.  For
delta = 1 it is the generalized cross product of the rows, for delta = 2 an antisymmetric matrix (decision 1).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from math import comb
from typing import TypeAlias

from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.homogeneous import common_factor, divide
from symgen.closedform.algebra.quotient import Matrix, Quotient, polynomial
from symgen.closedform.algebra.ring import TrigRing
from symgen.records import dataclass

Rows: TypeAlias = tuple[tuple[PolyElement, ...], ...]
Subset: TypeAlias = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Minors:
    """Phi_J by subset J (increasing), the common factor of all of them divided out, and that factor."""

    values: Mapping[Subset, PolyElement]
    content: PolyElement

    def signed(self, subset: Sequence[int], ring: TrigRing) -> PolyElement:
        """Phi for any order of the indices, 0 when one repeats."""
        if len(set(subset)) < len(subset):
            return ring.zero
        value = self.values[tuple(sorted(subset))]
        return value if permutation_sign(subset) > 0 else -value


def permutation_sign(sequence: Sequence[int]) -> int:
    """The sign of the permutation that sorts distinct integers."""
    inversions = sum(a > b for a, b in combinations(sequence, 2))
    return -1 if inversions % 2 else 1


def polynomial_rows(ring: TrigRing, matrix: Matrix) -> Rows:
    """Every row times its common denominator, divided by the common factor of the row (the kernel does not change)."""
    rows = []
    for row in matrix:
        bottom = common_denominator(ring, row)
        cleared = [entry * polynomial(ring, bottom) for entry in row]
        content = common_factor(ring, [entry.numerator for entry in cleared])
        rows.append(tuple(divide(ring, entry.numerator, content) for entry in cleared))
    return tuple(rows)


def common_denominator(ring: TrigRing, entries: Iterable[Quotient]) -> PolyElement:
    """A ring element that makes every entry a ring element when multiplied with it."""
    bottom = ring.one
    for entry in entries:
        bottom = ring.product(bottom, (entry * polynomial(ring, bottom)).denominator)
    return bottom


def estimated_work(rows: Rows) -> int:
    """Products of terms that all minors need at most, counted before any is built."""
    r, n = len(rows), len(rows[0]) if rows else 0
    if sum(comb(n, k) for k in range(r + 1)) > 20_000:
        return 10**9
    work = 0
    level = {0: 1}  # by sets of columns, a bit for each
    for row in rows:
        lengths = [(1 << j, len(entry)) for j, entry in enumerate(row) if entry]
        following: dict[int, int] = {}
        for columns, count in level.items():
            for column, length in lengths:
                if not columns & column:
                    following[columns | column] = following.get(columns | column, 0) + length * count
        work += sum(following.values())
        level = following
    return work


def kernel_minors(ring: TrigRing, rows: Rows, n: int) -> Minors:
    """All minors Phi_J of r rows in n columns, by Laplace expansion with shared sub-minors."""
    r = len(rows)
    level: dict[Subset, PolyElement] = {(): ring.one}
    for k, row in enumerate(rows):
        level = {columns: _expand(ring, row, columns, level, k) for columns in combinations(range(n), k + 1)}
    content = common_factor(ring, level.values())
    values = {}
    for columns, minor in level.items():
        subset = tuple(j for j in range(n) if j not in columns)
        sign = permutation_sign((*subset, *columns))
        reduced = divide(ring, minor, content)
        values[subset] = reduced if sign > 0 else -reduced
    if r == 0:
        return Minors({tuple(range(n)): ring.one}, ring.one)
    return Minors(dict(sorted(values.items())), content)


def _expand(
    ring: TrigRing, row: Sequence[PolyElement], columns: Subset, smaller: Mapping[Subset, PolyElement], k: int
) -> PolyElement:
    total = ring.zero
    for place, j in enumerate(columns):
        minor = smaller[columns[:place] + columns[place + 1 :]]
        if row[j] and minor:
            term = row[j] * minor
            total = total + term if (k + place) % 2 == 0 else total - term
    return ring.normal(total)


def square_sum(ring: TrigRing, values: Sequence[PolyElement]) -> PolyElement:
    """The sum of squares in normal form."""
    return ring.normal(sum((v * v for v in values if v), ring.zero))


def projector_numerator(ring: TrigRing, minors: Minors, n: int, delta: int) -> Rows:
    """N_B times the sum of squares of the minors: sum over (delta-1)-subsets K of Phi_iK Phi_jK."""
    rows: list[tuple[PolyElement, ...]] = []
    lines = [[minors.signed((i, *rest), ring) for rest in combinations(range(n), delta - 1)] for i in range(n)]
    for i in range(n):
        row = []
        for j in range(n):
            if j < i:
                row.append(rows[j][i])
                continue
            products = (a * b for a, b in zip(lines[i], lines[j], strict=True) if a and b)
            row.append(ring.normal(sum(products, ring.zero)))
        rows.append(tuple(row))
    return tuple(rows)


@dataclass(frozen=True, slots=True)
class Actuation:
    """Delta_J = det[M_J, B^T] by delta-subset J of the inputs, and the vectors v_L = det[e_a, M_L, B^T] by L."""

    determinants: Mapping[Subset, PolyElement]
    vectors: Mapping[Subset, tuple[PolyElement, ...]]


def actuation_minors(ring: TrigRing, minors: Minors, control: Rows, delta: int) -> Actuation:
    """Contract Phi with columns of the control matrix (Cauchy-Binet)."""
    n, m = len(control), len(control[0])
    vectors = {}
    for chosen in combinations(range(m), delta - 1):
        entries = []
        for a in range(n):
            total = ring.zero
            for rest in combinations(range(n), delta - 1):
                phi = minors.signed((a, *rest), ring)
                if phi:
                    total = total + ring.product(small_determinant(ring, control, rest, chosen), phi)
            entries.append(total)
        vectors[chosen] = tuple(entries)
    determinants = {}
    for subset in combinations(range(m), delta):
        vector = vectors[subset[1:]]
        terms = (
            ring.product(control[a][subset[0]], vector[a]) for a in range(n) if control[a][subset[0]] and vector[a]
        )
        determinants[subset] = sum(terms, ring.zero)
    return Actuation(determinants, vectors)


def small_determinant(ring: TrigRing, matrix: Rows, rows: Subset, columns: Subset) -> PolyElement:
    """The determinant of a square part of a matrix, by Laplace expansion along its first row."""
    if not rows:
        return ring.one
    total = ring.zero
    for place, j in enumerate(columns):
        entry = matrix[rows[0]][j]
        if entry:
            term = ring.product(
                entry, small_determinant(ring, matrix, rows[1:], columns[:place] + columns[place + 1 :])
            )
            total = total + term if place % 2 == 0 else total - term
    return total


def left_inverse_terms(actuation: Actuation, input_index: int) -> list[tuple[int, Subset, Subset]]:
    """(sign, J, L) of the terms Delta_J v_L of one row of the pseudoinverse: J contains the input, L = J without it."""
    terms = []
    for subset in actuation.determinants:
        if input_index in subset:
            place = subset.index(input_index)
            terms.append((1 if place % 2 == 0 else -1, subset, subset[:place] + subset[place + 1 :]))
    return terms
