"""Remarks 1 and 6: operations of the orthogonal complement and of the projector, counted by performing them."""

from __future__ import annotations

from dataclasses import dataclass

import pytest


@dataclass
class Counter:
    """Dense matrices without values: only their sizes and the operations spent on them."""

    multiplications: int = 0
    additions: int = 0

    def product(self, left: tuple[int, int], right: tuple[int, int]) -> tuple[int, int]:
        """Count the scalar operations of a dense matrix product."""
        assert left[1] == right[0]
        for _ in range(left[0]):
            for _ in range(right[1]):
                self.multiplications += left[1]
                self.additions += left[1] - 1
        return left[0], right[1]

    def difference(self, shape: tuple[int, int]) -> None:
        self.additions += shape[0] * shape[1]


SIZES = [(n, r) for n in range(2, 12) for r in range(1, n)]


@pytest.mark.parametrize(("n", "r"), SIZES)
def test_remark_1_orthogonal_complement(n: int, r: int) -> None:
    """B_1^{-1} B_2 with the inverse given."""
    counter = Counter()
    assert counter.product((r, r), (r, n - r)) == (r, n - r)
    assert counter.multiplications == r**2 * (n - r)
    assert counter.additions == r * (n - r) * (r - 1)


@pytest.mark.parametrize(("n", "r"), SIZES)
def test_remark_6_projector(n: int, r: int) -> None:
    """I - B^T (B B^T)^{-1} B with the inverse given, no symmetry used."""
    counter = Counter()
    counter.product((r, n), (n, r))
    right = counter.product((r, r), (r, n))
    counter.difference(counter.product((n, r), right))
    assert counter.multiplications == r * n * (n + 2 * r)
    assert counter.additions == n**2 * r + 2 * r**2 * n - r * n - r**2
