"""The section on singular configurations: constraints, inputs, what is given, and the chosen velocities."""

from __future__ import annotations

from collections.abc import Sequence

from sympy import Expr, Symbol

from symgen.closedform.laws.singular_sets import DeterminantSet
from symgen.closedform.singular import Kind, SingularSet
from symgen.report.context import Context
from symgen.report.document import Block, Section, displayed
from symgen.report.mathematics.layout import Fenced, Layout, Letter, Relation, Row, Scripts, size
from symgen.report.mathematics.matrices import packed
from symgen.report.prose import SYMBOLS, ZERO, B, equals, juxtaposed, number, paragraph, say, transposed
from symgen.report.sections.by_laws.determinants import MEANING, Determinants
from symgen.report.sections.by_laws.projections import ROWS, matrix_of_minors

OPENING = {
    "constraint": "At constraint singularities the rank of {} drops and {} does not exist",
    "input": "At input singularities the degree of actuation drops and {} is not continuous",
    "parameter": "Where the chosen velocities depend on each other {} does not exist, a singularity of the "
    "parametrization alone",
    "measured": "What is measured does not determine the other rates everywhere",
    "task": "The task does not determine the rates everywhere",
    "open_task": "The task loses rank where it cannot be moved in some direction",
}
ORDER: tuple[Kind, ...] = ("constraint", "input", "measured", "task", "open_task", "parameter")
# Symbols, numbers and operations of equations that are printed; of longer ones only the number is.
LARGEST_LOCUS = 1500


def singular(context: Context) -> Section:
    """Where ranks drop."""
    expressions = {one.kind: one for one in context.input.singular_sets}
    blocks, determinants = sets_by_determinants(context)
    for kind in ORDER:
        if kind in determinants:
            blocks += determinants[kind]
        elif by_squares := dependent_rows_lose_rank(context, kind):
            blocks += by_squares
        elif kind in expressions:
            blocks += _one(context, expressions[kind])
    if not blocks:
        blocks.append(paragraph("Without constraints, inputs and chosen velocities no rank can drop."))
    return Section(say("Singular configurations"), tuple(blocks))


def sets_by_determinants(context: Context) -> tuple[list[Block], dict[Kind, list[Block]]]:
    """Determinants that have names, and what is said of each kind of set that determinants are for."""
    printed = Determinants(context)
    return printed.definitions(), {one.kind: _by_determinants(printed, one) for one in context.input.determinants}


def dependent_rows_lose_rank(context: Context, kind: Kind) -> list[Block]:
    """Sets that were not worked out of rows that depend on each other, by squares of parts of B; nothing for others."""
    known = any(one.kind == kind and (one.vanishing or one.decided) for one in context.input.singular_sets)
    rank = context.structure.constraint_rank
    if known or rank == context.model.r:
        return []
    if kind == "constraint":
        text = "; this happens where {} for every choice {} of {} of the rows of {}."
        part = Scripts(B, ROWS)
        square = equals(Fenced(juxtaposed(part, transposed(part)), "|"), ZERO)
        return [paragraph(OPENING[kind] + text, *_slots(kind), square, ROWS, number(rank), B)]
    if kind == "input" and any(law.kind == "driven" for law in context.laws("projected_control_pseudoinverse")):
        text = "; this happens where {}, {} being the columns of the coordinates that no input drives. {}"
        part = Scripts(B, Letter("p"))
        square = equals(Fenced(juxtaposed(transposed(part), part), "|"), ZERO)
        return [paragraph(OPENING[kind] + text, *_slots(kind), square, part, MEANING[kind])]
    return []


def _by_determinants(printed: Determinants, one: DeterminantSet) -> list[Block]:
    if one.empty:
        return [paragraph(_nowhere(one.kind), *_slots(one.kind))]
    return printed.conditions(one, OPENING[one.kind], *_slots(one.kind))


def _one(context: Context, locus: SingularSet) -> list[Block]:
    if locus.decided and not locus.vanishing:
        return [paragraph(_nowhere(locus.kind), *_slots(locus.kind))]
    if not locus.vanishing:
        why = locus.explanation.rstrip(".")
        return [paragraph(OPENING[locus.kind] + "; {}.{}", *_slots(locus.kind), why, measured_by(locus))]
    minors = matrix_of_minors(context, locus.vanishing)
    if minors and not locus.decided:
        where = "; this happens where {} vanishes, that is where {}."
        return [paragraph(OPENING[locus.kind] + where, *_slots(locus.kind), *minors)]
    names = [Symbol(coordinate.name) for coordinate in context.model.coordinates]
    shown = dict.fromkeys(without_parameters(value, names) for value in locus.vanishing)
    equations = tuple(Row((context.layout.expression(value), Relation("="), ZERO)) for value in shown)
    if locus.decided:
        return [paragraph(OPENING[locus.kind] + "; this happens where", *_slots(locus.kind)), displayed(equations)]
    nodes = sum(size(line) for line in equations)
    if nodes > LARGEST_LOCUS:
        many = f"; these are the common zeros of {len(equations)} expressions with {nodes} symbols, not printed."
        return [paragraph(OPENING[locus.kind] + many, *_slots(locus.kind))]
    opening = paragraph(
        OPENING[locus.kind] + "; this happens where all of these expressions vanish at once:", *_slots(locus.kind)
    )
    return [opening, displayed(tuple(packed(equations)))]


def without_parameters(value: Expr, coordinates: Sequence[Symbol]) -> Expr:
    """What vanishes where a product does, without its sign and the factors that no coordinate is in."""
    _, factor = value.as_independent(*coordinates, as_Add=False)
    return -factor if factor.could_extract_minus_sign() else factor


def measured_by(locus: SingularSet) -> str:
    """What tells in numbers where a set is that was not worked out."""
    if locus.kind not in ("constraint", "input"):
        return ""
    return " The quantity singularity (0 there) says in numbers how far away a configuration is."


def _slots(kind: Kind) -> list[Layout]:
    """The symbols in the sentences of a kind."""
    quantities = {
        "constraint": ("constraint_jacobian", "nullspace_projector"),
        "input": ("projected_control_pseudoinverse",),
        "parameter": ("orthogonal_complement",),
    }.get(kind, ())
    return [SYMBOLS[quantity] for quantity in quantities]


def _nowhere(kind: str) -> str:
    return {
        "constraint": "The rank of {} is the same in all configurations, so that {} exists everywhere.",
        "input": "There are no input singularities: {} exists in all configurations.",
        "parameter": "The chosen velocities are independent everywhere, and {} always exists.",
        "measured": "What is measured determines the other rates in all configurations.",
        "task": "The task determines the rates in all configurations.",
        "open_task": "The task can be moved in all directions from every configuration.",
    }[kind]
