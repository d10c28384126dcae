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
        guards = forms.guards(status, space.guards, columns)
        return tuple(guard for guard in guards if guard.denominator.constant is None)
    assert isinstance(forms, ActuationForms)
    graph, denominator = mechanics.graph, forms.denominator()
    if denominator.constant is not None:
        return ()
    if mechanics.factoring.fixed(denominator):
        return (Guard(status, denominator, 1 if forms.single else 2, space.guards),)
    own = [dot(graph, column, column) for column in columns]
    bounds = magnitude(graph, own)
    # what bounds a moment about a point that moves is several times the moment: of many columns together that is more
    # than float32 can tell from a drop of the rank, so that columns count by their lengths, and these by their bounds
    loose = len(columns) > 1 and _moves(mechanics, columns)
    squares = own if loose else bounds
    scale, largest = (
        graph.sum(graph.product(xs[k] for k in subset) * forms.importance(subset) for subset in forms.subsets)
        for xs in (squares, bounds)
    )
    short = (Guard(status, scale, 2, space.guards, largest),) if loose else ()
    if isinstance(space, MinorSpace) and generic.rank < len(space.rows):
        scale = scale * graph.product(space.lengths)
        return (*short, Guard(status, forms.at_one_length(space.lengths), 2, space.guards, scale))
    if isinstance(space, MinorSpace):
        lengths = [_square(mechanics, row) for row in mechanics.constraint_jacobian]
        scale = scale * elementary_symmetric(graph, lengths, generic.rank)
    square = denominator * denominator if forms.single else denominator
    return (*short, Guard(status, square, 2, space.guards, scale))


def _moves(mechanics: Mechanics, columns: Sequence[Vector]) -> bool:
    """Whether a coordinate occurs in the columns otherwise than in angles."""
    moving, seen = set(mechanics.q), set[Scalar]()
    stack = [entry for column in columns for entry in column]
    while stack:
        node = stack.pop()
        if node in moving:
            return True
        if node not in seen and node.op not in ("sin", "cos"):
            seen.add(node)
            stack += node.args
    return False


def _square(mechanics: Mechanics, row: Vector) -> Scalar:
    """|b|^2 where the row may become short, else a bound that needs no sine or cosine."""
    square, fixed = dot(mechanics.graph, row, row), mechanics.factoring.fixed
    if any(fixed(entry) and not entry.is_zero for entry in row):
        (square,) = magnitude(mechanics.graph, [square])
    return square
