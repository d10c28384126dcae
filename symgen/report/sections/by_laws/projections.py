"""Projections and inputs as laws of short matrices, in the place of closed forms that would take pages."""

from __future__ import annotations

from typing import Any

from symgen.closedform.laws.terms import DefinedFactor, IndependentRows, ListedFactor, MatrixLaw, PartFactor
from symgen.report.context import Context
from symgen.report.document import Block, InlineCode, displayed
from symgen.report.mathematics.from_law import law_layout, matrix_layout
from symgen.report.mathematics.layout import Fenced, Layout, Letter, Scripts, equation
from symgen.report.mathematics.matrices import matrix_blocks, packed
from symgen.report.mathematics.names import name_layout
from symgen.report.prose import (
    NB,
    SYMBOLS,
    ZERO,
    B,
    Mt,
    W,
    equals,
    listed,
    paragraph,
    pseudoinverse,
)

A, P, ROWS = Letter("a"), Letter("p"), Letter("i")


def projector_laws(context: Context) -> list[Block]:
    """N_B by its laws; nothing where it is written out."""
    blocks: list[Block] = []
    for law in context.laws("nullspace_projector"):
        match law.kind:
            case "minors":
                blocks += _projector_by_minors(context, law)
            case "squares":
                blocks.append(paragraph("With a matrix of the size of the constraints to invert, {} is", NB))
                blocks.append(displayed(tuple(packed((_statement(law), *_definitions(law)))), "NB"))
            case "rows":
                blocks += _projector_by_rows(context, law)
            case _:
                blocks += _projector_by_basis(context, law)
    return blocks


def _projector_by_rows(context: Context, law: MatrixLaw) -> list[Block]:
    """Which rows, and the product."""
    (rows,) = (factor for factor in law.factors if isinstance(factor, IndependentRows))
    names = [InlineCode(context.model.constraints[i].name) for i in rows.places]
    text = f"Of the rows of {{}} let the index {{}} stand for {', '.join('{}' for _ in names)}. Where these are "
    text += "independent, as they are at almost every configuration, {} is"
    statements = tuple(packed((_statement(law), *_definitions(law))))
    return [paragraph(text, B, ROWS, *names, NB), displayed(statements, "NB")]


def _projector_by_minors(context: Context, law: MatrixLaw) -> list[Block]:
    """The names of the minors, the matrix that they make, and the product."""
    (minors,) = (factor for factor in law.factors if isinstance(factor, ListedFactor))
    shape = "column" if minors.matrix.cols == 1 else "skew-symmetric matrix"
    return [
        paragraph("{} is a product of signed minors of {}, without any matrix inverse.", NB, B),
        *context.intermediates(law.intermediates, "with_nullspace_projector"),
        paragraph(f"and the {shape} of the minors"),
        *_listings(context, law),
        paragraph("{} is", NB),
        displayed((_statement(law),), "NB"),
    ]


def matrix_of_minors(context: Context, expressions: tuple[Any, ...]) -> tuple[Layout, ...]:
    """Phi and Sigma_Phi = 0, where the expressions (of SymPy) are all its entries up to their signs."""
    laws = [law for law in context.laws("nullspace_projector") if law.kind == "minors"]
    if not laws:
        return ()
    (law,) = laws
    (minors,) = (factor for factor in law.factors if isinstance(factor, ListedFactor))
    entries = {entry.subs(dict(law.intermediates)) for entry in minors.matrix} - {0}
    if {frozenset((value, -value)) for value in expressions} != {frozenset((entry, -entry)) for entry in entries}:
        return ()
    total, _ = law.intermediates[-1]
    return matrix_layout(minors.name), equals(name_layout(total.name), ZERO)


def _projector_by_basis(context: Context, law: MatrixLaw) -> list[Block]:
    """W, where it is a basis, and the product."""
    opening = paragraph("The columns of {} are a basis of the admissible velocities:", W)
    if law.divisors:
        entries = listed(tuple(context.layout.expression(entry) for entry in law.divisors))
        pattern = "Where none of {} vanishes, the columns of {} are a basis of the admissible velocities:"
        opening = paragraph(pattern, entries, W)
    elif law.kind == "kernel":
        pattern = "The columns of {} are admissible velocities, and a basis of them where they are independent:"
        opening = paragraph(pattern, W)
    return [opening, *_listings(context, law), paragraph("There {} is", NB), displayed((_statement(law),), "NB_by_W")]


def inverse_laws(context: Context) -> list[Block]:
    """The pseudoinverse of N_B M by its laws; nothing where it is written out."""
    laws = context.laws("projected_control_pseudoinverse")
    if not laws:
        return []
    statements = tuple(packed(_statement(law) for law in laws))
    if laws[0].kind == "driven":
        opening = paragraph("The columns of {} are", pseudoinverse(Mt))
        return [*_parts(context, laws[0]), opening, displayed(statements, "Mplus")]
    if laws[0].kind != "minors":
        return [paragraph("With"), displayed((*_definitions(laws[0]), *statements), "Mplus")]
    (law,) = laws
    names = context.intermediates(law.intermediates, "with_projected_control_pseudoinverse")
    return [*names, *_listings(context, law), paragraph("{} is", pseudoinverse(Mt)), displayed(statements, "Mplus")]


def _parts(context: Context, law: MatrixLaw) -> list[Block]:
    """What the indices a and p stand for."""
    driven, others = (
        listed(tuple(name_layout(context.model.coordinates[k].name) for k in factor.places))
        for factor in law.factors
        if isinstance(factor, PartFactor) and factor.whole == "B"
    )
    return [
        paragraph(
            "Each input drives a coordinate of its own. Let the index {} stand for these, {}, and {} for the "
            "others, {}.",
            A,
            driven,
            P,
            others,
        )
    ]


def input_laws(context: Context) -> list[Block]:
    """u by its law; nothing where it is written out."""
    laws = (*context.laws("multipliers"), *context.laws("inverse_dynamics"))
    if not laws:
        return []
    blocks: list[Block] = [
        paragraph(
            "The rows {} of the balance, without inputs, give the multipliers, and its rows {} the inputs:",
            P,
            A,
        ),
        displayed(tuple(packed(_statement(law) for law in laws)), "uout"),
    ]
    listings = _listings(context, laws[-1])
    return [*blocks, paragraph("with"), *listings] if listings else blocks


def _statement(law: MatrixLaw) -> Layout:
    """The quantity, or the part that the law gives, and the law."""
    symbol = SYMBOLS[law.quantity]
    left = Scripts(Fenced(symbol), Letter(law.part)) if law.part else symbol
    return equation(left, law_layout(law.term))


def _definitions(law: MatrixLaw) -> list[Layout]:
    """Factors that have laws of their own."""
    return [
        equation(matrix_layout(factor.name), law_layout(factor.term))
        for factor in law.factors
        if isinstance(factor, DefinedFactor)
    ]


def _listings(context: Context, law: MatrixLaw) -> list[Block]:
    """Factors entry by entry, each once in a report, after what they are in others."""
    blocks: list[Block] = []
    for factor in law.factors:
        if isinstance(factor, ListedFactor) and context.first(factor.name):
            symbol = matrix_layout(factor.name)
            if factor.term is not None:
                blocks.append(paragraph("with {},", equation(symbol, law_layout(factor.term))))
            blocks += matrix_blocks(symbol, factor.matrix, context.layout, context.denominators, factor.name)
    return blocks
