"""How much of their limits the inputs need for a motion: the largest share, whatever they do beside it.

The forces that inputs within limits c_i - h_i, c_i + h_i supply are a zonotope, the sum of a segment for each input
(McMullen, On zonotopes, 1971).  Along any direction of forces the load, beside what the middles c supply, is compared
with the sum of all segments; the largest ratio is that along the normal of one of the facets.  The motion is possible
exactly if it is 1 at most, and its inverse is by how much the load may grow.

A normal is orthogonal to delta - 1 columns of the equations A u = f.  Where these are many, it is written in the inputs
that are left, one more than the m - delta directions of internal force Z: y = A^T n is what is orthogonal to Z there.
Either way it is the generalized cross product of vectors, of which nothing is left but rounding where these depend on
each other.  Then no direction may count for more than it is: all segments are summed, also those that y should be
orthogonal to, and for y that is not orthogonal to Z, |Z^T y| |h| is added: with w the shortest u - c that supplies the
load, and w + Z x those that need the share s, |x| <= s |h|, so that |y . w| <= s (sum |y_i| h_i + |Z^T y| |h|).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from symgen.linear_algebra.exterior import Multivector, cross_product, unit, wedge
from symgen.linear_algebra.reflected_inputs import reflected_inputs
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.model.model import Limit
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, matvec, subtract_vectors, transpose
from symgen.symbolic.scalar import Scalar

# Dimensions in which normals are determinants: in more they lose digits that reflections keep.
MOST_BY_DETERMINANTS = 3


def utilisation(mechanics: System, generic: Genericity, limits: Sequence[Limit], force: Vector) -> Scalar:
    """The least largest |u_i - c_i| / h_i of all inputs u that supply a force; `limits` has one for each input."""
    graph = mechanics.graph
    middles, halves = _middles(mechanics, limits), _halves(mechanics, limits)
    load = subtract_vectors(force, matvec(graph, mechanics.control_matrix, middles))
    space = reflected_rows(mechanics, generic)
    if generic.delta <= MOST_BY_DETERMINANTS:
        columns = [space.restriction(column) for column in mechanics.inputs]
        pairs = _along_normals(graph, columns, space.restriction(load), halves)
    else:
        equations, restriction = reflected_inputs(space, mechanics.inputs, generic.alpha)
        shortest = equations.solve(restriction(load))
        forces = equations.internal_forces() if generic.m > generic.alpha else ()
        pairs = _across_internal_forces(graph, forces, shortest, halves, generic.m - generic.alpha)
    largest = graph.zero
    for needed, reach in pairs:
        share = graph.function("ratio_or_zero", (graph.function("abs", (needed,)), reach))
        largest = graph.function("max", (largest, share))
    return largest


def scaled(mechanics: System, generic: Genericity, limits: Sequence[Limit], force: Vector) -> Vector:
    """M c + s (f - M c) for the largest share s <= 1 with which inputs within limits supply it."""
    graph = mechanics.graph
    share = graph.function("max", (utilisation(mechanics, generic, limits, force), graph.one))
    supplied = matvec(graph, mechanics.control_matrix, _middles(mechanics, limits))
    return tuple(known + (f - known) / share for f, known in zip(force, supplied, strict=True))


def _middles(mechanics: System, limits: Sequence[Limit]) -> Vector:
    return tuple((lower + upper) / 2 for lower, upper in _ends(mechanics, limits))


def _halves(mechanics: System, limits: Sequence[Limit]) -> Vector:
    return tuple((upper - lower) / 2 for lower, upper in _ends(mechanics, limits))


def _ends(mechanics: System, limits: Sequence[Limit]) -> list[tuple[Scalar, Scalar]]:
    graph = mechanics.graph
    by_input = {limit.input: (graph.symbol(limit.lower), graph.symbol(limit.upper)) for limit in limits}
    return [by_input[item.name] for item in mechanics.model.inputs]


def _along_normals(
    graph: Graph, columns: Sequence[Vector], load: Vector, halves: Vector
) -> Iterator[tuple[Scalar, Scalar]]:
    """Load and reach along what is orthogonal to all but one of the directions, for each choice of columns."""
    for chosen in combinations(columns, len(load) - 1):
        form = unit(graph)
        for column in chosen:
            form = wedge(form, column)
        normal = {mask: graph.function("rounded", (x,)) for mask, x in form.items()}
        segments = [_product(graph, normal, column) for column in columns]
        yield _product(graph, normal, load), _reach(graph, segments, halves)


def _across_internal_forces(
    graph: Graph, forces: Matrix, shortest: Vector, halves: Vector, directions: int
) -> Iterator[tuple[Scalar, Scalar]]:
    """The same in the inputs: what is orthogonal to the internal forces of one input more than their directions."""
    length = graph.function("sqrt", (dot(graph, halves, halves),))
    for chosen in combinations(range(len(shortest)), directions + 1):
        rows = transpose(tuple(forces[i] for i in chosen), directions) if directions else ()
        across = [graph.function("rounded", (x,)) for x in cross_product(graph, rows, directions + 1)]
        left = graph.sum(graph.function("abs", (dot(graph, row, across),)) for row in rows)
        reach = _reach(graph, across, [halves[i] for i in chosen]) + left * length
        yield dot(graph, across, [shortest[i] for i in chosen]), reach


def _product(graph: Graph, normal: Multivector, vector: Vector) -> Scalar:
    (product,) = wedge(normal, vector).values() or (graph.zero,)
    return product


def _reach(graph: Graph, segments: Sequence[Scalar], halves: Sequence[Scalar]) -> Scalar:
    return graph.sum(graph.function("abs", (x,)) * half for x, half in zip(segments, halves, strict=True))
