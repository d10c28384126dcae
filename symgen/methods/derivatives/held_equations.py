"""Derivatives of what equations determine, from the equations and not from the steps that solve them.

Where unknowns solve residuals that are linear in them, they change by `shares` d`residuals`: the residuals are
differentiated with the unknowns held, and what a unit of each does to the unknowns is linear and costs little beside
the steps.  What these are made of, such as minors or pivots, is not differentiated.
"""

from __future__ import annotations

from collections.abc import Mapping

from symgen.records import dataclass
from symgen.symbolic.accumulation import shortest_jacobian
from symgen.symbolic.calculus import gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, matmul
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute


@dataclass(frozen=True, slots=True)
class Slopes:
    """Derivatives, a row each, and what the residuals' own derivatives divide by is read from: `own`."""

    rows: Matrix
    own: Matrix

    def with_values(self, graph: Graph, held: Mapping[Scalar, Scalar]) -> Slopes:
        """The same with values for symbols that were held."""
        return Slopes(tuple(tuple(substitute(graph, row, held)) for row in self.rows), self.own)


def all_slopes(shares: Matrix, residuals: Vector, by: Vector) -> Slopes:
    """The derivatives of all unknowns by symbols, a row each."""
    graph = by[0].graph
    entries = shortest_jacobian(graph, residuals, by)
    return Slopes(matmul(graph, shares, entries, len(by)), entries)


def weighted_slopes(shares: Matrix, residuals: Vector, by: Vector) -> Slopes:
    """The same of a single row of shares, in one reverse sweep in which they are held."""
    graph, (row,) = by[0].graph, shares
    held = [x if x.constant is not None else graph.stand_in(f"share {k}") for k, x in enumerate(row)]
    entries: Matrix = (tuple(gradient(graph, dot(graph, held, residuals), by)),)
    return Slopes(entries, entries).with_values(graph, dict(zip(held, row, strict=True)))
