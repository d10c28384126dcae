"""The null space of B block by block, where its rows fall into groups that share no coordinate.

N_B and B^+ are block diagonal then.  Taken together the minors of k blocks multiply in number; block by block they add.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from symgen.linear_algebra.blocks import ConnectedComponent, components
from symgen.linear_algebra.exterior import ActuationForms
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import (
    HouseholderSpace,
    InputEquations,
    MinorSpace,
    NullSpace,
    Restriction,
    has_few_minors,
)
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, identity, transpose
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True)
class _BlockOfSpace:
    """One block: where its rows and coordinates stand, and its own null space."""

    places: ConnectedComponent
    space: NullSpace

    def of_coordinates(self, x: Vector) -> Vector:
        return tuple(x[j] for j in self.places.columns)

    def of_rows(self, a: Vector) -> Vector:
        return tuple(a[i] for i in self.places.rows)


class BlockSpace:
    """Independent rows in two blocks or more, each with a null space of its own."""

    def __init__(self, graph: Graph, rows: Matrix, n: int) -> None:
        self.graph, self.rows, self.n = graph, rows, n
        self.delta = n - len(rows)
        self._parts = [_BlockOfSpace(places, _space(graph, rows, places)) for places in components(rows)]

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """Those of all blocks."""
        return tuple(guard for part in self._parts for guard in part.space.guards)

    @property
    def size(self) -> Scalar:
        """What det(B B^T) is measured by: the product of those of the blocks."""
        return self.graph.product(part.space.size for part in self._parts)

    @cached_property
    def projector(self) -> Matrix:
        """N_B (21), n x n, block diagonal up to the order of the coordinates."""
        entries = [list(row) for row in identity(self.graph, self.n)]
        for part in self._parts:
            own = part.space.projector
            for i, row in zip(part.places.columns, own, strict=True):
                for j, entry in zip(part.places.columns, row, strict=True):
                    entries[i][j] = entry
        return tuple(map(tuple, entries))

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B^+, n x r."""
        return transpose(tuple(self.lift(e) for e in identity(self.graph, len(self.rows))), self.n)

    def project(self, x: Vector) -> Vector:
        """N_B x, each block by its own way."""
        result = list(x)
        for part in self._parts:
            projected = part.space.project(part.of_coordinates(x))
            for j, entry in zip(part.places.columns, projected, strict=True):
                result[j] = entry
        return tuple(result)

    def lift(self, a: Vector) -> Vector:
        """B^+ a, each block by its own way."""
        result = [self.graph.zero] * self.n
        for part in self._parts:
            for j, entry in zip(part.places.columns, part.space.lift(part.of_rows(a)), strict=True):
                result[j] = entry
        return tuple(result)

    def lift_transposed(self, x: Vector) -> Vector:
        """(B^+)^T x, each block by its own way."""
        result = [self.graph.zero] * len(self.rows)
        for part in self._parts:
            own = part.space.lift_transposed(part.of_coordinates(x))
            for i, entry in zip(part.places.rows, own, strict=True):
                result[i] = entry
        return tuple(result)

    def actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[InputEquations, Restriction]:
        """Inputs couple the blocks: as if there were one."""
        return HouseholderSpace(self.graph, self.rows, self.n).actuation(inputs, degree)

    def listed_actuation(self, inputs: Sequence[Vector], degree: int) -> tuple[ActuationForms, Restriction]:
        """The same by determinants, however many they are."""
        return HouseholderSpace(self.graph, self.rows, self.n).listed_actuation(inputs, degree)


def _space(graph: Graph, rows: Matrix, places: ConnectedComponent) -> NullSpace:
    own = tuple(tuple(rows[i][j] for j in places.columns) for i in places.rows)
    width, rank = len(places.columns), len(places.rows)
    return MinorSpace(graph, own, width, rank) if has_few_minors(own, rank) else HouseholderSpace(graph, own, width)
