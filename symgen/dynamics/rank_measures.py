"""`singularity`: how far the ranks of B and of the projected inputs are from dropping, between 0 and 1."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

from symgen.dynamics.blocks import components
from symgen.dynamics.driven import driven_minors
from symgen.dynamics.exterior import ActuationForms, RowForms, small_family, square, unit, wedge_all
from symgen.dynamics.genericity import Genericity
from symgen.dynamics.mechanics import Mechanics
from symgen.dynamics.pivoted import elementary_symmetric, reflected
from symgen.dynamics.spaces import HouseholderSpace, NullSpace
from symgen.graph.matrix import Vector, dot, matmul, transpose
from symgen.graph.scalar import Graph, Scalar


def rank_measures(mechanics: Mechanics, generic: Genericity, space: NullSpace) -> Vector:
    """[det(B B^T) / prod |b_k|^2, e(M~)/e(M)] along a null space, with rows normalised before products are formed."""
    graph, n, r = mechanics.graph, mechanics.n, mechanics.r
    rows = mechanics.constraint_jacobian
    lengths = [graph.function("sqrt", (dot(graph, row, row),)) for row in rows]
    unit_rows = tuple(
        tuple(graph.function("ratio_or_zero", (x, length)) for x in row)
        for row, length in zip(rows, lengths, strict=True)
    )
    present = [graph.function("ratio_or_zero", (length, length)) for length in lengths]
    possible = elementary_symmetric(graph, present, generic.rank)
    dependent = generic.rank < r
    if isinstance(space, HouseholderSpace):
        turned = reflected(graph, unit_rows, n, generic.rank, everywhere=True)
        constraint = turned.square
        driven = driven_minors(graph, unit_rows, mechanics.inputs, n)
        if driven is not None and not dependent and generic.full_actuation:
            return constraint, graph.function("ratio_or_zero", (driven[0], constraint * driven[1]))
        seen, _ = turned.actuation(mechanics.inputs, generic.alpha)
        regular = graph.function("ratio_or_zero", (constraint, constraint))
        actuation = _actuation_measure(mechanics, generic, seen.square() * regular)
        return graph.function("ratio_or_zero", (constraint, possible)) if dependent else constraint, actuation
    forms = RowForms(graph, unit_rows, n, generic.rank)
    constraint = graph.one
    if r:
        constraint = graph.function("ratio_or_zero", (forms.square, possible)) if dependent else forms.square
    if not small_family(forms.forms, mechanics.inputs, generic.alpha):
        turned = reflected(graph, unit_rows, n, generic.rank, everywhere=True)
        seen, _ = turned.actuation(mechanics.inputs, generic.alpha)
        regular = graph.function("ratio_or_zero", (constraint, constraint)) if r else graph.one
        return constraint, _actuation_measure(mechanics, generic, seen.square() * regular)
    projected = ActuationForms(forms, mechanics.inputs, generic.alpha).square()
    if r:
        # |M_J ^ omega|^2 / |omega|^2 sums the determinants of the projected columns
        projected = graph.function("ratio_or_zero", (projected, forms.square))
    return constraint, _actuation_measure(mechanics, generic, projected)


def _actuation_measure(mechanics: Mechanics, generic: Genericity, projected: Scalar) -> Scalar:
    """e(M~)/e(M) from e(M~)."""
    graph, inputs = mechanics.graph, mechanics.inputs
    if generic.alpha == 0:
        return graph.one
    whole = _squared_minors(graph, inputs, generic.alpha)
    return graph.function("ratio_or_zero", (projected, whole))


def _squared_minors(graph: Graph, columns: Sequence[Vector], degree: int) -> Scalar:
    """The sum of the squared minors of that size: all of them where they are few, else by blocks of columns."""
    if small_family([[0]], columns, degree):
        return graph.sum(
            square(graph, wedge_all(unit(graph), [columns[k] for k in subset]))
            for subset in combinations(range(len(columns)), degree)
        )
    # those of columns that share no coordinate multiply
    sums = [graph.one, *(graph.zero for _ in range(degree))]
    for block in components(transpose(tuple(columns), len(columns[0]))):
        own = _of_block(graph, [columns[k] for k in block.columns], degree)
        sums = [graph.sum(sums[k - i] * x for i, x in enumerate(own[: k + 1])) for k in range(degree + 1)]
    return sums[degree]


def _of_block(graph: Graph, columns: Sequence[Vector], degree: int) -> list[Scalar]:
    """The sums of squared minors of each size up to `degree`, from traces of powers of A^T A (Newton's identities)."""
    if len(columns) == 1:
        return [graph.one, dot(graph, columns[0], columns[0])]
    gram = tuple(tuple(dot(graph, a, b) for b in columns) for a in columns)
    power, traces, found = gram, list[Scalar](), [graph.one]
    for k in range(1, min(degree, len(columns)) + 1):
        power = gram if k == 1 else matmul(graph, power, gram, len(columns))
        traces.append(graph.sum(power[i][i] for i in range(len(columns))))
        terms = (found[k - i] * traces[i - 1] * (-1) ** (i - 1) for i in range(1, k + 1))
        found.append(graph.sum(terms) * Fraction(1, k))
    return found
