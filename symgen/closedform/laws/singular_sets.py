"""Which singular sets are said by determinants: those that were not worked out, or are long."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, islice
from math import comb

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import transpose
from symgen.closedform.algebra.quotient import Matrix
from symgen.closedform.exact import Exact
from symgen.closedform.forms import ClosedForms
from symgen.closedform.laws.bases import own_columns
from symgen.closedform.laws.determinants import (
    BlockDeterminant,
    can_be_printed,
    determinant_blocks,
    unit_rows,
    vanishing,
)
from symgen.closedform.laws.known import KnownNames
from symgen.closedform.singular import Kind, SingularSet
from symgen.records import dataclass

MOST_CHOICES = 6
"""More choices of as many inputs as there are directions are not listed."""

LONGEST_SET = 400
"""Equations of singular configurations with more operations together are printed as determinants."""


@dataclass(frozen=True, slots=True)
class DeterminantSet:
    """Where something loses rank: all of `products` vanish at once, each where one of its determinants does.

    For the rows of B these are some of the determinants of as many columns, which all vanish at once where B B^T is
    singular.  A product without factors vanishes nowhere, nor does the set then.
    """

    kind: Kind
    products: tuple[tuple[BlockDeterminant, ...], ...]

    @property
    def empty(self) -> bool:
        """Whether there is no such configuration."""
        return not all(self.products)


def derive_determinant_sets(forms: ClosedForms) -> tuple[DeterminantSet, ...]:
    """The singular sets that are long as expressions, as determinants; for independent rows of B."""
    exact = forms.exact
    if not exact.model.constraints or exact.structure.constraint_rank < exact.model.r:
        return ()
    short = {one.kind for one in forms.singular_sets if not _is_long(one)}
    known = KnownNames(forms)
    sets: dict[Kind, DeterminantSet] = {}
    for kind, count, rows in _given(exact):
        if kind not in short and 0 < count <= MOST_CHOICES:
            blocks = (determinant_blocks(exact, known.speller, given) for given in rows)
            products = tuple(vanishing(product) for product in blocks if product is not None)
            if products and all(map(can_be_printed, products)):
                sets[kind] = DeterminantSet(kind, products)
    if "constraint" not in short:
        sets["constraint"] = DeterminantSet("constraint", _some_of_b(exact, known, tuple(sets.values())))
    return tuple(sets[kind] for kind in ORDER if kind in sets)


ORDER: tuple[Kind, ...] = ("constraint", "input", "measured", "task", "parameter")


def _is_long(one: SingularSet) -> bool:
    """Whether a set was not worked out, or takes more lines than determinants do."""
    if one.decided and not one.vanishing:
        return False
    return not one.vanishing or sum(int(value.count_ops()) for value in one.vanishing) > LONGEST_SET


def _some_of_b(
    exact: Exact, known: KnownNames, others: tuple[DeterminantSet, ...]
) -> tuple[tuple[BlockDeterminant, ...], ...]:
    """Products that vanish where the rank of B drops: those of whatever is stacked on it, and of its own columns."""
    own = own_columns(exact)
    free = () if own is None else tuple(j for j in range(exact.model.n) if j not in own)
    alone = determinant_blocks(exact, known.speller, unit_rows(exact, free)) if own is not None else None
    products = [product for one in others for product in one.products]
    distinct = dict.fromkeys(products if alone is None else (vanishing(alone), *products))
    return tuple(islice(filter(can_be_printed, distinct), MOST_CHOICES))


def _given(exact: Exact) -> Iterator[tuple[Kind, int, Iterator[Matrix]]]:
    """Kinds of rows that are stacked on B, in how many choices of delta of them, and these."""
    model, delta = exact.model, exact.delta

    def choices(kind: Kind, rows: Matrix) -> tuple[Kind, int, Iterator[Matrix]]:
        return kind, comb(len(rows), delta), combinations(rows, delta)

    if model.inputs and exact.full_actuation:
        yield choices("input", transpose(exact.mechanics.control))
    if model.measured:
        yield choices("measured", unit_rows(exact, tuple(model.measured_places)))
    if model.task and not model.task_leaves.rates:
        rows = _task(exact)
        if rows:
            yield choices("task", rows)
    if model.independent_velocities:
        names = [c.name for c in model.coordinates]
        yield choices("parameter", unit_rows(exact, tuple(map(names.index, model.independent_velocities))))


def _task(exact: Exact) -> Matrix:
    """The derivatives of the task, where they can be made."""
    try:
        return exact.mechanics.task_jacobian
    except TooLargeError:
        return ()
