"""Independent blocks of B: the connected components of its bipartite graph of rows and coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import comb

from symgen.records import dataclass
from symgen.symbolic.matrix import Matrix


@dataclass(frozen=True, slots=True)
class ConnectedComponent:
    """Rows and coordinates (by their places) that do not meet the others."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ConstraintBlock:
    """A component by names, with its generic rank; delta = coordinates less rank is its share of the freedom."""

    rows: tuple[str, ...]
    coordinates: tuple[str, ...]
    rank: int

    @property
    def delta(self) -> int:
        """Differential degree of freedom of the block."""
        return len(self.coordinates) - self.rank

    @property
    def null_space(self) -> str:
        """How its null space is found."""
        match self.delta:
            case 0:
                return "locked, no velocity is left"
            case 1:
                return "one direction, the cross product of the rows"
            case 2:
                return "its minors, an antisymmetric Φ"
            case _:
                minors = comb(len(self.coordinates), self.rank) * comb(len(self.rows), self.rank)
                return f"{minors} minors or Householder reflections, by counted cost"


def components(b: Matrix) -> Iterator[ConnectedComponent]:
    """The components in the order of their first rows; a row without entries is one by itself."""
    remaining = set(range(len(b)))
    while remaining:
        members = {min(remaining)}
        touched: set[int] = set()
        grown = True
        while grown:
            touched = {j for i in members for j, entry in enumerate(b[i]) if not entry.is_zero}
            more = {i for i in remaining if any(not b[i][j].is_zero for j in touched)} | members
            grown, members = more != members, more
        remaining -= members
        yield ConnectedComponent(tuple(sorted(members)), tuple(sorted(touched)))


def named(component: ConnectedComponent, rows: Sequence[str], coordinates: Sequence[str], rank: int) -> ConstraintBlock:
    """The block of a component."""
    touched = tuple(coordinates[j] for j in component.columns)
    return ConstraintBlock(tuple(rows[i] for i in component.rows), touched, rank)
