"""The null-space form: a closed basis W of ker B, then u = (W^T M)^+ W^T tau with delta x delta determinants.

B q_dot = 0 is first reduced by steps that cannot fail (`rates`).  Of the small rest a basis is the cross product of its
rows where one direction is left; where more are, some rates have to be solved for by Cramer's rule, and the basis fails
where their determinant vanishes although the rest keeps its rank: every such choice is a form of its own, and its
determinant one of its pivots.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations, islice

from symgen.dynamics.exterior import ActuationForms, RowForms, cross_product
from symgen.dynamics.forms.form import Form, form
from symgen.dynamics.forms.rates import reduced_rates
from symgen.dynamics.forms.system import System
from symgen.dynamics.guards import Guard
from symgen.graph.matrix import Matrix, Vector, matmul, transpose
from symgen.graph.scalar import Graph, Scalar
from symgen.graph.traverse import cost
from symgen.ir.kernel import Status

# Beyond this size the determinants of the rest cost more than reflections.
LARGEST_REST = 4
MOST_CHOICES = 6


@dataclass(frozen=True, slots=True)
class _Basis:
    """W (n x delta) and the determinants that must not vanish for its columns to be independent."""

    columns: Matrix
    pivots: Vector


def nullspace_form(system: System, allowed: Callable[[Scalar], bool]) -> Form | str:
    """The form along the first choice of rates whose determinant is `allowed`, or along the first of all."""
    reason = system.driven or system.regular
    if reason is not None:
        return reason
    graph, mechanics, generic = system.mechanics.graph, system.mechanics, system.generic
    choices = list(islice(_bases(system), MOST_CHOICES))
    if not choices:
        return f"more than {LARGEST_REST} constraint rows are left that no safe step solves"
    basis = next((choice for choice in choices if all(map(allowed, choice.pivots))), choices[0])
    w = transpose(basis.columns, generic.delta)
    free = RowForms(graph, (), generic.delta, 0)
    inputs = transpose(matmul(graph, w, mechanics.control_matrix, generic.m), generic.m)
    forms = ActuationForms(free, inputs, generic.alpha)
    force = tuple(row[0] for row in matmul(graph, w, tuple((f,) for f in mechanics.balance), 1))
    guard = Guard(Status.ACTUATION_RANK, forms.denominator(), 1 if forms.single else 2)
    made = form("nullspace", "inverse_dynamics", forms.solve(force), (guard,), system.given)
    pivots = tuple(pivot for pivot in basis.pivots if pivot not in made.divisors and pivot.constant is None)
    return replace(made, divisors=(*made.divisors, *pivots))


def _bases(system: System) -> Iterator[_Basis]:
    graph, mechanics, delta = system.mechanics.graph, system.mechanics, system.generic.delta
    rest = reduced_rates(graph, system.definite, mechanics.constraint_jacobian, mechanics.n)
    if not rest.core:
        yield _Basis(rest.motion, ())
        return
    if len(rest.core) > LARGEST_REST:
        return
    if delta == 1:
        kernel = cross_product(graph, rest.core, rest.width)
        yield _Basis(matmul(graph, rest.motion, tuple((x,) for x in kernel), 1), ())
        return
    found = [_solved(graph, rest.core, chosen) for chosen in combinations(range(rest.width), len(rest.core))]
    kernels = [entry for entry in found if entry is not None]
    for vectors, determinant in sorted(kernels, key=lambda entry: cost(x for v in entry[0] for x in v).weight):
        columns = matmul(graph, rest.motion, transpose(vectors, rest.width), delta)
        yield _Basis(columns, (determinant,))


def _solved(graph: Graph, core: Matrix, chosen: tuple[int, ...]) -> tuple[Matrix, Scalar] | None:
    """Null vectors of the rest with the rates `chosen` solved for, and det C_S; None where that is always 0.

    The vector of a free rate f is the cross product of the rows on the columns S and f.
    """
    width = len(core[0])
    vectors: list[Vector] = []
    determinant = graph.zero
    for free in (j for j in range(width) if j not in chosen):
        places = sorted((*chosen, free))
        part = cross_product(graph, tuple(tuple(row[j] for j in places) for row in core), len(places))
        determinant = part[places.index(free)]
        if determinant.is_zero:
            return None
        values = dict(zip(places, part, strict=True))
        vectors.append(tuple(values.get(j, graph.zero) for j in range(width)))
    return tuple(vectors), determinant
