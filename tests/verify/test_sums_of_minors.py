"""Sums of principal minors are the same one by one and as a coefficient of the characteristic polynomial."""

from __future__ import annotations

import random
from itertools import combinations

import pytest
from flint import arb_mat

from symgen.verify.reference_linear import columns_of, determinant, rows_of
from symgen.verify.reference_measures import sum_of_minors
from symgen.verify.reference_tape import precision


@pytest.mark.parametrize("size", [3, 4])
def test_both_ways_agree(size: int) -> None:
    source = random.Random(size)
    with precision(160):
        rows = arb_mat(7, 7, [source.uniform(-1, 1) for _ in range(49)])
        gram = rows.transpose() * rows
        total = sum(determinant(rows_of(columns_of(gram, s), s)) for s in combinations(range(7), size))
        assert abs(float(sum_of_minors(gram, size) - total)) < 1e-35
