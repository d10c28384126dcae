"""Singular configurations: where constraints, actuation or chosen velocities lose rank, as factored determinants.

What is measured, and a task, have singularities of their own: where they do not determine the rest, and of a task that
leaves directions open where it loses rank.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal, TypeAlias

from sympy import Expr, Integer
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.homogeneous import (
    common_factor,
    divide,
    factorise,
    homogeneous,
    never_zero,
    parity_classes,
)
from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import identity
from symgen.closedform.algebra.minors import common_denominator
from symgen.closedform.algebra.ring import TrigRing
from symgen.closedform.exact import Exact
from symgen.closedform.spelling import Speller
from symgen.model.model import Model
from symgen.records import dataclass

Kind: TypeAlias = Literal["constraint", "input", "parameter", "measured", "task", "open_task"]

MOST_PRINTED = 30
"""More expressions than this are not listed."""

LARGEST_SQUARE_SUM = 4000
"""Products of terms up to which a sum of squares is expanded to see that it has no zeros."""


@dataclass(frozen=True, slots=True)
class SingularSet:
    """Where something loses rank: all of `vanishing` are zero at once.

    Where `decided`, there is one product, or nothing when that never happens; otherwise common zeros were not worked
    out and `vanishing` is empty when there are too many expressions.
    """

    kind: Kind
    quantity: str
    vanishing: tuple[Expr, ...]
    decided: bool
    explanation: str


def derive_singular_sets(model: Model, exact: Exact, speller: Speller) -> tuple[SingularSet, ...]:
    """Constraint singularities, input singularities, and those of what is given and of chosen velocities.

    The first that is too much work is the last, and empty.
    """
    singular_sets: list[SingularSet] = []
    begun: tuple[Kind, str] = ("constraint", "constraint_jacobian")
    try:
        with exact.ring.work.limited("the singular configurations"):
            for kind, quantity, vanishing in _rank_losses(model, exact):
                begun = kind, quantity
                common = vanishing()
                if common is not None:
                    singular_sets.append(_common_zeros(exact, speller, kind, quantity, *common))
    except TooLargeError as large:
        singular_sets.append(SingularSet(*begun, (), False, f"not worked out: {large}"))
    return tuple(singular_sets)


# What vanishes at once, a factor that was taken out of all of it, and what happens there.
Common: TypeAlias = tuple[list[PolyElement], PolyElement, str]
RankLoss: TypeAlias = tuple[Kind, str, Callable[[], Common | None]]


def _rank_losses(model: Model, exact: Exact) -> Iterator[RankLoss]:
    """What may lose rank, and what vanishes there when it is asked for; None where it has no rank to lose."""
    if model.constraints:
        yield "constraint", "constraint_jacobian", lambda: _of_constraints(exact)
    if model.inputs and exact.structure.degree_of_actuation == exact.delta:
        yield "input", "projected_control_pseudoinverse", lambda: _of_inputs(exact)
    yield from _of_given(model, exact)
    if model.independent_velocities:
        yield "parameter", "orthogonal_complement", lambda: _of_chosen(model, exact)


def _of_constraints(exact: Exact) -> Common:
    minors = [v for one in exact.minor_sets for v in one.values.values()]
    contents = [one.content for one in exact.minor_sets]
    return minors, contents[0] if len(contents) == 1 else exact.ring.one, "the rank of B drops"


def _of_inputs(exact: Exact) -> Common:
    deltas = [v for one in exact.actuations for v in one.determinants.values()]
    return deltas, exact.ring.one, "the degree of actuation drops"


def _of_chosen(model: Model, exact: Exact) -> Common | None:
    complement = exact.complement(model.independent_velocities)
    if complement is None:
        return None
    bottom = common_denominator(exact.ring, [e for row in complement for e in row])
    text = "the chosen velocities become dependent (a property of the choice, not of the mechanism)"
    return [bottom], exact.ring.one, text


def _of_given(model: Model, exact: Exact) -> Iterator[RankLoss]:
    """Those of what is measured and of the task: where they do not determine the rest, or lose rank if it is open."""
    if model.measured:
        units = identity(exact.ring, model.n)
        measured = tuple(units[k] for k in model.measured_places)
        text = "what is measured does not determine the rest"
        yield "measured", "velocity_from_measured", lambda: (exact.determined_by(measured), exact.ring.one, text)
    leaves = model.task_leaves
    if model.task and not (leaves.rates and leaves.idle):
        kind: Kind = "open_task" if leaves.rates else "task"
        said = f"the task {'loses rank' if leaves.rates else 'does not determine the rest'}"
        yield kind, "velocity_from_task", lambda: (_of_task(exact), exact.ring.one, said)


def _of_task(exact: Exact) -> list[PolyElement]:
    return exact.determined_by(exact.mechanics.task_jacobian)


def essential_factors(ring: TrigRing, p: PolyElement) -> tuple[PolyElement, ...]:
    """The distinct factors that can vanish: not parameters alone, not sums of squares without common zeros."""
    names = set(ring.angle_positions) | set(ring.opaque_position)
    coordinates = {i for name, i in ring.position.items() if name in ring.configuration}
    return tuple(
        factor
        for factor, _ in factorise(ring, p)[1]
        if set(ring.shape(factor)) & (names | coordinates) and not positive(ring, factor)
    )


def positive(ring: TrigRing, p: PolyElement) -> bool:
    """Whether p is certainly free of zeros (parameters other than 0)."""
    classes = parity_classes(ring, ring.normal(p))
    return len(classes) == 1 and never_zero(ring, homogeneous(ring, classes[0]))


def _common_zeros(
    exact: Exact,
    speller: Speller,
    kind: Kind,
    quantity: str,
    values: list[PolyElement],
    content: PolyElement,
    text: str,
) -> SingularSet:
    """The common zeros of ring elements, one shared factor taken out."""
    ring = exact.ring
    values = [v for v in values if v]
    single = len(values) == 1
    divisor = ring.one if single else common_factor(ring, values)
    shared = ring.product(values[0] if single else ring.normal(divisor), ring.normal(content))
    factors = essential_factors(ring, shared)
    rest = [] if single else [divide(ring, v, divisor) for v in values]
    never = single or any(not essential_factors(ring, v) for v in rest)
    if not never and sum(len(v) ** 2 for v in rest) <= LARGEST_SQUARE_SUM:
        total = ring.normal(sum((v * v for v in rest), ring.zero))
        never = not essential_factors(ring, total)
    spelled = tuple(_unsigned(speller.polynomial(ring.normal(f))) for f in factors)
    if never:
        if not spelled:
            return SingularSet(kind, quantity, (), True, f"{text} nowhere")
        product: Expr = Integer(1)
        for factor in spelled:
            product *= factor
        return SingularSet(kind, quantity, (product,), True, f"{text} where this product vanishes")
    if len(values) > MOST_PRINTED:
        return SingularSet(kind, quantity, (), False, f"{text} where all {len(values)} minors vanish at once")
    printed = tuple(_unsigned(speller.polynomial(v)) for v in values)
    return SingularSet(kind, quantity, printed, False, f"{text} where all of these vanish at once")


def _unsigned(expression: Expr) -> Expr:
    return -expression if expression.could_extract_minus_sign() else expression
