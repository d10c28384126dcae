"""The section on singular configurations: constraints, inputs, what is given, and the chosen velocities."""

from __future__ import annotations

from symgen.closedform.singular import SingularSet
from symgen.report.context import Context
from symgen.report.document import Block, Section, displayed
from symgen.report.mathematics.layout import Relation, Row, size
from symgen.report.mathematics.matrices import packed
from symgen.report.prose import SYMBOLS, ZERO, Slot, paragraph, say

OPENING = {
    "constraint": "At constraint singularities the rank of {} drops and {} does not exist",
    "input": "At input singularities the degree of actuation drops and {} is not continuous",
    "parameter": "Where the chosen velocities depend on each other {} does not exist, a singularity of the "
    "parametrization alone",
    "measured": "What is measured does not determine the other rates everywhere",
    "task": "The task does not determine the rates everywhere",
    "open_task": "The task loses rank where it cannot be moved in some direction",
}
# Symbols, numbers and operations of equations that are printed; of longer ones only the number is.
LARGEST_LOCUS = 1500


def singular(context: Context) -> Section:
    """Where ranks drop."""
    blocks: list[Block] = []
    for locus in context.input.singular_sets:
        blocks += _one(context, locus)
    if not blocks:
        blocks.append(paragraph("Without constraints, inputs and chosen velocities no rank can drop."))
    return Section(say("Singular configurations"), tuple(blocks))


def _one(context: Context, locus: SingularSet) -> list[Block]:
    if locus.decided and not locus.vanishing:
        return [paragraph(_nowhere(locus.kind), *_slots(locus))]
    if not locus.vanishing:
        return [paragraph(OPENING[locus.kind] + "; {}.", *_slots(locus), locus.explanation.rstrip("."))]
    equations = tuple(Row((context.layout.expression(value), Relation("="), ZERO)) for value in locus.vanishing)
    if locus.decided:
        return [paragraph(OPENING[locus.kind] + "; this happens where", *_slots(locus)), displayed(equations)]
    nodes = sum(size(line) for line in equations)
    if nodes > LARGEST_LOCUS:
        many = f"; these are the common zeros of {len(equations)} expressions with {nodes} symbols, not printed."
        return [paragraph(OPENING[locus.kind] + many, *_slots(locus))]
    opening = paragraph(
        OPENING[locus.kind] + "; this happens where all of these expressions vanish at once:", *_slots(locus)
    )
    return [opening, displayed(tuple(packed(equations)))]


def _slots(locus: SingularSet) -> list[Slot]:
    if locus.kind in ("measured", "task", "open_task"):
        return []
    symbol = SYMBOLS[locus.quantity]
    if locus.kind != "constraint":
        return [symbol]
    return [SYMBOLS["constraint_jacobian"], SYMBOLS["nullspace_projector"]]


def _nowhere(kind: str) -> str:
    return {
        "constraint": "The rank of {} is the same in all configurations, so that {} exists everywhere.",
        "input": "There are no input singularities: {} exists in all configurations.",
        "parameter": "The chosen velocities are independent everywhere, and {} always exists.",
        "measured": "What is measured determines the other rates in all configurations.",
        "task": "The task determines the rates in all configurations.",
        "open_task": "The task can be moved in all directions from every configuration.",
    }[kind]
