"""Inverses and minors of matrices that consist of blocks: the functions of the whole, from those of the blocks."""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heapify, heapreplace
from itertools import combinations
from math import comb, prod
from typing import Any

from flint import arb, arb_mat

from symgen.verify.reference.arithmetic.linear import (
    check_total,
    columns_of,
    determinant,
    gradients_of_minors,
    pivots,
    pseudoinverse,
    right_pseudoinverse,
    rows_of,
    sums_of_minors,
)
from symgen.verify.reference.configurations.parts import Part, others, piece, placed, product

# Minors that are computed one by one; more of them are coefficients of one polynomial.
MOST_DETERMINANTS = 10


def right_pseudoinverse_of_parts(matrix: Any, rank: int, parts: Sequence[Part]) -> Any:
    """B+ (n x r) of B (r x n), see `right_pseudoinverse`."""
    if len(parts) == 1:
        return right_pseudoinverse(matrix, rank)
    pieces = [piece(matrix, part.rows, part.coordinates) for part in parts]
    if rank == matrix.nrows():
        inverses = [right_pseudoinverse(x, x.nrows()) for x in pieces]
    else:
        inverses = _mean_inverses(pieces, rank)
    places = ((part.coordinates, part.rows, x) for part, x in zip(parts, inverses, strict=True))
    return placed(matrix.ncols(), matrix.nrows(), places)


def _mean_inverses(pieces: Sequence[Any], rank: int) -> list[Any]:
    """The mean over all subsets of rows, also those that have more of one block and fewer of another.

    The sum of the minors of a size of all blocks is the sum of products of those of one and those of the others.
    """
    grams = [x * x.transpose() for x in pieces]
    minors = [sums_of_minors(gram) for gram in grams]
    rests = list(others(minors, rank))
    total = product(rests[0], minors[0], rank)[rank]
    check_total(total)
    inverses = []
    for x, gram, own, rest in zip(pieces, grams, minors, rests, strict=True):
        gradient = arb_mat(gram.nrows(), gram.nrows())
        for size, slope in enumerate(gradients_of_minors(gram, own, gram.nrows()), start=1):
            if 0 <= rank - size < len(rest):
                gradient += slope * rest[rank - size]
        inverses.append(x.transpose() * gradient * (1 / total))
    return inverses


def pseudoinverse_of_parts(matrix: Any, rank: int, parts: Sequence[Part]) -> Any:
    """The Moore-Penrose inverse (m x n) of an n x m matrix of known rank, see `pseudoinverse`."""
    if len(parts) == 1:
        return pseudoinverse(matrix, rank)
    pieces = [piece(matrix, part.coordinates, part.inputs) for part in parts]
    ranks = [x.ncols() for x in pieces] if rank == matrix.ncols() else ranks_of_blocks(pieces, rank)
    inverses = (pseudoinverse(x, own) for x, own in zip(pieces, ranks, strict=True))
    places = ((part.inputs, part.coordinates, x) for part, x in zip(parts, inverses, strict=True))
    return placed(matrix.ncols(), matrix.nrows(), places)


def ranks_of_blocks(pieces: Sequence[Any], rank: int) -> list[int]:
    """How many of `rank` independent columns of the whole are those of each block: the longest that are left count."""
    ranks = [0] * len(pieces)
    left = [pivots(x) for x in pieces]
    heap = [(-size, place) for place, these in enumerate(left) for size, _ in (next(these, (0.0, 0)),)]
    heapify(heap)
    for _ in range(rank):
        size, place = heap[0]
        if size == 0:
            raise ZeroDivisionError("the matrix is of lower rank")
        ranks[place] += 1
        heapreplace(heap, (-next(left[place], (0.0, 0))[0], place))
    return ranks


def sum_of_minors(grams: Sequence[Any], size: int) -> Any:
    """The sum of the principal minors of a size of Gram matrices in a diagonal; many as coefficients of polynomials."""
    count = sum(gram.nrows() for gram in grams)
    if size == count:
        return prod((determinant(gram) for gram in grams), start=arb(1))
    if len(grams) > 1:
        whole: list[Any] = [arb(1)]
        for gram in grams:
            whole = product(whole, sums_of_minors(gram), size)
        return whole[size] if size < len(whole) else arb(0)
    (gram,) = grams
    if comb(count, size) > MOST_DETERMINANTS:
        return sums_of_minors(gram)[size]
    total = arb(0)
    for subset in combinations(range(count), size):
        total += determinant(rows_of(columns_of(gram, subset), subset))
    return total
