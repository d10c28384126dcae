"""Tests of ranks that are greater than those kernels are made for.

A denominator tells that a rank drops.  Where rows depend on each other on the constraints only (a parallelogram with
three cranks), or inputs span fewer directions there than elsewhere, another branch of configurations may have a greater
rank, and a kernel would drop rows or inputs that count.  So it tests how far a row sticks out of the directions taken,
in units of its length: not at all on the branch that is meant, little beside it.  Ranks that no configuration exceeds
need no test.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import ActuationForms, RowForms, small_family, square, wedge
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import has_few_minors
from symgen.linear_algebra.null_space.pivoted import PivotedReflections
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.quantity import Quantity, scalars
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost

# The inverse square of the share of its length by which a row may stick out: configurations are measured, and off the
# constraints by as much as a hundredth of it at most.
SHORTER = 10_000

Tests = tuple[tuple[Guard, ...], tuple[Guard, ...]]
"""Of the rows of B, and of the inputs."""


def with_test_of_excess(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """The quantity with those tests where its values depend on a rank that other branches may exceed.

    By minors or by reflections, whichever shares more with the quantity itself.
    """
    statuses = {one.status for guard in derived.guards for one in (guard, *guard.first)}
    solves = derived.name == "inverse_dynamics" or Status.ACTUATION_RANK in statuses
    rows = not generic.rank_is_identical and generic.rank < generic.r
    rows = rows and (solves or Status.CONSTRAINT_RANK in statuses)
    inputs = not generic.actuation_is_identical and generic.alpha < min(generic.m, generic.delta) and solves
    if not rows and not inputs:
        return derived
    tests: list[Tests] = [_by_reflections(mechanics, generic, rows, inputs)]
    few = has_few_minors(mechanics.constraint_jacobian, generic.rank)
    if few and (not inputs or _few_inputs(mechanics, generic)):
        tests.append(_by_minors(mechanics, generic, rows, inputs))
    candidates = [replace(derived, guards=(*before, *derived.guards, *after)) for before, after in tests]
    return min(candidates, key=_weight)


def _few_inputs(mechanics: System, generic: Genericity) -> bool:
    forms = RowForms(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank).forms
    return small_family(forms, mechanics.inputs, generic.alpha + 1)


def _weight(derived: Quantity) -> int:
    return cost([*scalars(derived), *(guard.scale for guard in derived.guards if guard.scale is not None)]).weight


def _by_reflections(mechanics: System, generic: Genericity, rows: bool, inputs: bool) -> Tests:
    """What is left of rows once as many reflections are taken as the rank."""
    graph, rank, alpha = mechanics.graph, generic.rank, generic.alpha
    turned = PivotedReflections(graph, mechanics.constraint_jacobian, mechanics.n, rank)

    def test(given: Sequence[Vector], left: Sequence[Vector], status: Status) -> Guard:
        most: Scalar = graph.zero
        for row, rest in zip(given, left, strict=True):
            share = graph.function("ratio_or_zero", (dot(graph, rest, rest), dot(graph, row, row)))
            most = graph.function("max", (most, share))
        return Guard(status, graph.function("max", (1 - SHORTER * most, graph.zero)), 2, scale=graph.one)

    of_rows: tuple[Guard, ...] = ()
    if rows:
        left = [row[rank:] for row in turned.rest]
        of_rows = (test(mechanics.constraint_jacobian, left, Status.CONSTRAINT_RANK),)
    if not inputs:
        return of_rows, ()
    free = tuple(turned.apply_transposed(column)[rank:] for column in mechanics.inputs)
    spanned = PivotedReflections(graph, free, generic.delta, alpha)
    return of_rows, (test(mechanics.inputs, [row[alpha:] for row in spanned.rest], Status.ACTUATION_RANK),)


def _by_minors(mechanics: System, generic: Genericity, rows: bool, inputs: bool) -> Tests:
    """Minors that are one larger than the rank, beside those of the rank."""
    graph, b = mechanics.graph, mechanics.constraint_jacobian
    forms = RowForms(graph, b, mechanics.n, generic.rank)

    def reciprocal(row: Vector) -> Scalar:
        return graph.function("ratio_or_zero", (graph.one, dot(graph, row, row)))

    def test(taken: Scalar, larger: Iterator[Scalar], status: Status) -> Guard:
        excess = SHORTER * graph.sum(larger)
        return Guard(status, graph.function("max", (taken - excess, graph.zero)), 2, scale=taken)

    of_rows: tuple[Guard, ...] = ()
    if rows:
        known = dict(zip(forms.subsets, forms.forms, strict=True))
        shares = [reciprocal(row) for row in b]
        larger = (
            square(graph, wedge(known[subset[:-1]], b[subset[-1]])) * graph.sum(shares[k] for k in subset)
            for subset in combinations(range(len(b)), generic.rank + 1)
        )
        of_rows = (test(forms.square, larger, Status.CONSTRAINT_RANK),)
    if not inputs:
        return of_rows, ()
    parts = [reciprocal(column) for column in mechanics.inputs]
    beyond = ActuationForms(forms, mechanics.inputs, generic.alpha + 1)
    larger = (
        square(graph, product) * graph.sum(parts[k] for k in subset)
        for family in beyond.products
        for subset, product in zip(beyond.subsets, family, strict=True)
    )
    taken = ActuationForms(forms, mechanics.inputs, generic.alpha).square()
    return of_rows, (test(taken, larger, Status.ACTUATION_RANK),)
