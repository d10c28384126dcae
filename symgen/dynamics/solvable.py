"""Where input equations can be solved: the guard of their determinants.

Their size is Hadamard's bound: a determinant is at most the product of the lengths of what it is made of (Horn and
Johnson, Matrix Analysis, 7.8).  Reflections keep the columns' lengths; minors are made of the rows of B as well, whose
own lengths count, because a short row is no loss of rank.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.dynamics.exterior import ActuationForms
from symgen.dynamics.genericity import Genericity
from symgen.dynamics.guards import Guard, magnitude
from symgen.dynamics.mechanics import Mechanics
from symgen.dynamics.pivoted import elementary_symmetric
from symgen.dynamics.reflected_inputs import ReflectedInputs
from symgen.dynamics.spaces import InputEquations, MinorSpace, NullSpace
from symgen.graph.matrix import Vector, dot
from symgen.graph.scalar import Scalar
from symgen.ir.kernel import Status


def solvable(
    mechanics: Mechanics,
    generic: Genericity,
    space: NullSpace,
    forms: InputEquations,
    columns: Sequence[Vector],
    status: Status,
) -> tuple[Guard, ...]:
    """The guard with `status` of the determinants of `columns`; a drop of the rank of B is named first."""
    if isinstance(forms, ReflectedInputs):
        guard = forms.guard(status, space.guards, columns)
        return () if guard.denominator.constant is not None else (guard,)
    assert isinstance(forms, ActuationForms)
    graph, denominator = mechanics.graph, forms.denominator()
    if denominator.constant is not None:
        return ()
    if mechanics.factoring.fixed(denominator):
        return (Guard(status, denominator, 1 if forms.single else 2, space.guards),)
    squares = magnitude(graph, [dot(graph, column, column) for column in columns])
    scale = graph.sum(
        graph.product(squares[k] for k in subset) * forms.importance(subset) for subset in forms.subsets
    )
    if isinstance(space, MinorSpace) and generic.rank < len(space.rows):
        scale = scale * graph.product(space.lengths)
        return (Guard(status, forms.at_one_length(space.lengths), 2, space.guards, scale),)
    if isinstance(space, MinorSpace):
        lengths = [_square(mechanics, row) for row in mechanics.constraint_jacobian]
        scale = scale * elementary_symmetric(graph, lengths, generic.rank)
    return (Guard(status, denominator * denominator if forms.single else denominator, 2, space.guards, scale),)


def _square(mechanics: Mechanics, row: Vector) -> Scalar:
    """|b|^2 where the row may become short, else a bound that needs no sine or cosine."""
    square, fixed = dot(mechanics.graph, row, row), mechanics.factoring.fixed
    if any(fixed(entry) and not entry.is_zero for entry in row):
        (square,) = magnitude(mechanics.graph, [square])
    return square
