"""The section on degrees of freedom and actuation, paper (4), (5), (26)."""

from __future__ import annotations

from symgen.report.context import Context, sentence
from symgen.report.document import Block, InlineCode, Items, Section, Text
from symgen.report.mathematics.layout import Numeral, Relation, Row, Sum
from symgen.report.prose import (
    B,
    alpha,
    delta_diff,
    delta_loc,
    equals,
    number,
    paragraph,
    rho,
    say,
    small_m,
    small_r,
    worded,
)

ACTUATION = {
    "non-redundantly full-actuated": "every motion the constraints admit is produced by exactly one set of inputs.",
    "redundantly full-actuated": "every motion the constraints admit is produced by many sets of inputs; the "
    "smallest one is taken.",
    "non-redundantly under-actuated": "some motions the constraints admit cannot be produced; the inputs come as "
    "near as possible.",
    "redundantly under-actuated": "some motions cannot be produced although inputs compete for others.",
}


def freedom(context: Context) -> Section:
    """Local and differential degree of freedom, degree of actuation, integrability."""
    model, structure = context.model, context.structure
    geometric = sum(row.kind == "geometric" for row in model.constraints)
    blocks: list[Block] = []
    if not model.r:
        blocks.append(
            paragraph(
                "Without constraints both degrees of freedom equal the number of coordinates, {}.",
                equals(delta_loc, delta_diff, number(model.n)),
            )
        )
    else:
        blocks.append(_counted(context, geometric))
        if structure.constraint_rank < model.r:
            blocks.append(
                paragraph(
                    "The {} rows of {} have the generic rank {}: the constraints depend on each other (Remark 7 of "
                    "the paper). "
                    "None is dropped, since at some configurations each of them is needed; the multipliers are not "
                    "unique, and the "
                    "smallest ones are computed.",
                    equals(small_r, number(model.r)),
                    B,
                    equals(rho, number(structure.constraint_rank)),
                )
            )
    if model.m:
        blocks.append(_actuation(context))
    if context.input.integrability:
        blocks += [
            paragraph("Integrability of the constraints in the rates (Frobenius; object of non-holonomy, paper (12)):"),
            Items(tuple(_integrable(row.row, row.verdict, row.explanation) for row in context.input.integrability)),
        ]
    return Section(say("Degrees of freedom and actuation"), tuple(blocks))


def _counted(context: Context, geometric: int) -> Block:
    structure, n = context.structure, context.model.n
    local = _difference(structure.local_freedom, n, structure.geometric_rank)
    differential = _difference(structure.differential_freedom, n, structure.constraint_rank)
    if geometric == 0:
        return paragraph(
            "There are no geometric constraints: the local degree of freedom is {}. The constraints of the "
            "velocities lower the "
            "differential degree of freedom to {}, paper (5).",
            Row((delta_loc, *local)),
            Row((delta_diff, *differential)),
        )
    if geometric == context.model.r:
        return paragraph(
            "All constraints are geometric: the degree of freedom is {}, and {} has the same value, paper (4) and (5).",
            Row((delta_loc, *local)),
            delta_diff,
        )
    return paragraph(
        "The geometric constraints leave the local degree of freedom {}, paper (4); all constraints together lower the "
        "differential degree of freedom to {}, paper (5).",
        Row((delta_loc, *local)),
        Row((delta_diff, *differential)),
    )


def _difference(
    result: int, n: int, rank: int
) -> tuple[Relation, Sum | Numeral, Relation, Numeral] | tuple[Relation, Numeral]:
    """= n − rank = result."""
    if rank == 0:
        return Relation("="), number(result)
    return Relation("="), Sum((("+", number(n)), ("-", number(rank)))), Relation("="), number(result)


def _actuation(context: Context) -> Block:
    structure, m = context.structure, context.model.m
    meaning = ACTUATION.get(structure.actuation, "")
    return paragraph(
        f"For {{}} the generic degree of actuation, paper (26), is {{}}. The system is {structure.actuation}"
        + (f": {meaning}" if meaning else "."),
        equals(small_m, number(m)),
        equals(alpha, number(structure.degree_of_actuation)),
    )


def _integrable(row: str, verdict: str, explanation: str) -> Text:
    if not explanation:
        return say("{} is {}.", InlineCode(row), verdict)
    why = sentence(explanation)
    return (*say("{} is {}: ", InlineCode(row), verdict), *worded(why[0].lower() + why[1:]))
