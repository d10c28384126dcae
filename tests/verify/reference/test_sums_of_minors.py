"""Sums of principal minors are the same one by one and as a coefficient of the characteristic polynomial."""

from __future__ import annotations

import random
from itertools import combinations

import pytest
from flint import arb, arb_mat

from symgen.verify.reference.arithmetic.blocks import sum_of_minors
from symgen.verify.reference.arithmetic.linear import columns_of, determinant, rows_of
from symgen.verify.reference.arithmetic.tape import precision


@pytest.mark.parametrize("size", [3, 4])
def test_both_ways_agree(size: int) -> None:
    source = random.Random(size)
    with precision(160):
        rows = arb_mat(7, 7, [source.uniform(-1, 1) for _ in range(49)])
        gram = rows.transpose() * rows
        total = sum(determinant(rows_of(columns_of(gram, s), s)) for s in combinations(range(7), size))
        assert abs(float(sum_of_minors([gram], size) - total)) < 1e-35


@pytest.mark.parametrize("bits", [128, 512])
def test_of_a_singular_matrix_more_bits_give_more_digits(bits: int) -> None:
    source = random.Random(5)
    with precision(bits):
        rows = [[source.uniform(-1, 1) for _ in range(6)] for _ in range(4)]
        dependent = [arb(a) / 3 + arb(b) / 7 for a, b in zip(rows[0], rows[3], strict=True)]
        matrix = arb_mat(5, 6, [*(x for row in rows for x in row), *dependent])
        value = determinant(matrix * matrix.transpose())
        assert value.contains(0)
        assert float(value.rad()) < 2.0 ** (16 - bits)
