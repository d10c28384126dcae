"""`singularity`: how far the ranks of B and of the projected inputs are from dropping, between 0 and 1."""

from __future__ import annotations

from symgen.linear_algebra.exterior import ActuationForms, RowForms, small_family
from symgen.linear_algebra.minor_sums import elementary_symmetric, squared_minors
from symgen.linear_algebra.null_space.null_spaces import HouseholderSpace, NullSpace
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar
from symgen.validity.driven import driven_minors


def rank_measures(mechanics: System, generic: Genericity, space: NullSpace) -> Vector:
    """[det(B B^T) / prod |b_k|^2, e(M~)/e(M)] along a null space, with rows normalised before products are formed.

    Where rows depend on each other, inputs are projected along the rows as they are: the direction of a short one is
    that of what rounding left of it, and long ones give the projection without it.
    """
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
        along = reflected(graph, rows, n, generic.rank, everywhere=True) if dependent else turned
        driven = driven_minors(graph, unit_rows, mechanics.inputs, n)
        if driven is not None and not dependent and generic.full_actuation:
            return constraint, graph.function("ratio_or_zero", (driven[0], constraint * driven[1]))
        seen, _ = along.actuation(mechanics.inputs, generic.alpha)
        regular = graph.function("ratio_or_zero", (constraint, constraint))
        actuation = _actuation_measure(mechanics, generic, seen.square() * regular)
        return graph.function("ratio_or_zero", (constraint, possible)) if dependent else constraint, actuation
    forms = RowForms(graph, unit_rows, n, generic.rank)
    constraint = graph.one
    if r:
        constraint = graph.function("ratio_or_zero", (forms.square, possible)) if dependent else forms.square
    if not small_family(forms.forms, mechanics.inputs, generic.alpha):
        turned = reflected(graph, rows if dependent else unit_rows, n, generic.rank, everywhere=True)
        seen, _ = turned.actuation(mechanics.inputs, generic.alpha)
        regular = graph.function("ratio_or_zero", (constraint, constraint)) if r else graph.one
        return constraint, _actuation_measure(mechanics, generic, seen.square() * regular)
    along_rows = RowForms(graph, rows, n, generic.rank) if dependent else forms
    projected = ActuationForms(along_rows, mechanics.inputs, generic.alpha).square()
    if r:
        # |M_J ^ omega|^2 / |omega|^2 sums the determinants of the projected columns
        projected = graph.function("ratio_or_zero", (projected, along_rows.square))
    return constraint, _actuation_measure(mechanics, generic, projected)


def _actuation_measure(mechanics: System, generic: Genericity, projected: Scalar) -> Scalar:
    """e(M~)/e(M) from e(M~)."""
    graph, inputs = mechanics.graph, mechanics.inputs
    if generic.alpha == 0:
        return graph.one
    whole = squared_minors(graph, inputs, generic.alpha)
    rows = mechanics.constraint_jacobian
    if all(dot(graph, row, column).is_zero for row in rows for column in inputs):
        # every input drives along the constraints: nothing is lost, and two ways to round it would differ
        projected = whole
    return graph.function("ratio_or_zero", (projected, whole))
