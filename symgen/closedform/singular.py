"""Singular configurations: where constraints, actuation or chosen velocities lose rank, as factored determinants.

What is measured, and a task, have singularities of their own: where they do not determine the rest, and of a task that
leaves directions open where it loses rank.
"""

from __future__ import annotations

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
from symgen.closedform.algebra.quotient import Matrix
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
    """Constraint singularities, input singularities, and those of the chosen independent velocities."""
    singular_sets: list[SingularSet] = []
    try:
        with exact.ring.work.limited("the singular configurations"):
            _collect(model, exact, speller, singular_sets)
    except TooLargeError as large:
        singular_sets.append(SingularSet("constraint", "constraint_jacobian", (), False, f"not worked out: {large}"))
    return tuple(singular_sets)


def _collect(model: Model, exact: Exact, speller: Speller, sets: list[SingularSet]) -> None:
    if model.constraints:
        minors = [v for one in exact.minor_sets for v in one.values.values()]
        contents = [one.content for one in exact.minor_sets]
        content = contents[0] if len(contents) == 1 else exact.ring.one
        sets.append(
            _common_zeros(exact, speller, "constraint", "constraint_jacobian", minors, content, "the rank of B drops")
        )
    if model.inputs and exact.structure.degree_of_actuation == exact.delta:
        deltas = [v for one in exact.actuations for v in one.determinants.values()]
        text = "the degree of actuation drops"
        quantity = "projected_control_pseudoinverse"
        sets.append(_common_zeros(exact, speller, "input", quantity, deltas, exact.ring.one, text))
    _collect_given(model, exact, speller, sets)
    if model.independent_velocities:
        complement = exact.complement(model.independent_velocities)
        if complement is not None:
            bottom = common_denominator(exact.ring, [e for row in complement for e in row])
            text = "the chosen velocities become dependent (a property of the choice, not of the mechanism)"
            sets.append(
                _common_zeros(exact, speller, "parameter", "orthogonal_complement", [bottom], exact.ring.one, text)
            )


def _collect_given(model: Model, exact: Exact, speller: Speller, sets: list[SingularSet]) -> None:
    """Those of what is measured and of the task: where they do not determine the rest, or lose rank if it is open."""
    given: list[tuple[Kind, str, Matrix]] = []
    if model.measured:
        units = identity(exact.ring, model.n)
        given.append(("measured", "what is measured", tuple(units[k] for k in model.measured_places)))
    leaves = model.task_leaves
    if model.task and not leaves.rates:
        given.append(("task", "the task", exact.mechanics.task_jacobian))
    elif model.task and not leaves.idle:
        given.append(("open_task", "the task", exact.mechanics.task_jacobian))
    for kind, what, slopes in given:
        values = exact.determined_by(slopes)
        text = f"{what} {'loses rank' if kind == 'open_task' else 'does not determine the rest'}"
        name = f"velocity_from_{'measured' if kind == 'measured' else 'task'}"
        sets.append(_common_zeros(exact, speller, kind, name, values, exact.ring.one, text))


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
