"""Inputs that are independent even without rows: what rows hold is solved for, so that work grows with the few rows.

With B of full row rank and M~ = N M of full column rank, M has full column rank too, and the u of least |N (tau - M u)|
is M+ (tau - B' lambda) with (B R B') lambda = B R tau, R = I - M M+.  M+ consists of blocks: inputs that share no
coordinate.  A chain of many drives with one loop takes systems of the loop's few rows, where M~ has the size of the
chain and no entry that is 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb

from symgen.verify.reference.arithmetic.linear import determinant, solve
from symgen.verify.reference.configurations.parts import Part, parts, piece, placed


@dataclass(frozen=True)
class Driven:
    """A part of a system with more inputs than rows: B (r x n) and M (n x m), both of full rank, and M's blocks."""

    rows: Any
    control: Any
    blocks: Sequence[Part]

    def inputs(self, load: Any) -> Any:
        """u (m x 1) of least |N (tau - M u)| for tau (n x 1)."""
        if not self.rows.nrows():
            return self._along_inputs(load)
        across = self.rows.transpose()
        rest, held = self._beside_inputs(load), self._beside_inputs(across)
        multipliers = solve(self.rows * held, self.rows * rest)
        return self._along_inputs(load - across * multipliers)

    def share(self) -> Any:
        """det(M~'M~)/det(M'M), which is det(B R B')/det(B B')."""
        if not self.rows.nrows():
            return arb(1)
        across = self.rows.transpose()
        return determinant(self.rows * self._beside_inputs(across)) / determinant(self.rows * across)

    def _along_inputs(self, columns: Any) -> Any:
        """M+ times columns (n x k)."""
        width = range(columns.ncols())
        return placed(
            self.control.ncols(),
            columns.ncols(),
            (
                (block.inputs, width, solve(own.transpose() * own, own.transpose() * piece(columns, places, width)))
                for block, places, own in self._pieces()
            ),
        )

    def _beside_inputs(self, columns: Any) -> Any:
        """R times columns (n x k)."""
        width, along = range(columns.ncols()), self._along_inputs(columns)
        pieces = ((places, width, own * piece(along, block.inputs, width)) for block, places, own in self._pieces())
        return columns - placed(self.control.nrows(), columns.ncols(), pieces)

    def _pieces(self) -> Iterator[tuple[Part, Sequence[int], Any]]:
        """Each block with inputs, the coordinates that these act on, and its own M."""
        for block in self.blocks:
            if block.inputs:
                yield block, block.coordinates, piece(self.control, block.coordinates, block.inputs)


def blocks_of_inputs(part: Part, acted_on: Sequence[Sequence[int]]) -> tuple[Part, ...]:
    """The blocks of M of a part by its own numbers, from the coordinates that each input of the system acts on."""
    place = {j: k for k, j in enumerate(part.coordinates)}
    return parts(len(place), (), [[place[j] for j in acted_on[control]] for control in part.inputs])
