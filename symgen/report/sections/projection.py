"""The section on the null space of B and the projected equations, paper (21), Remark 9, and (8)."""

from __future__ import annotations

from symgen.report.context import Context
from symgen.report.document import Block, Section, displayed
from symgen.report.mathematics.layout import Accent, Fenced, Layout, Scripts, Sum
from symgen.report.mathematics.names import name_layout
from symgen.report.prose import (
    IDENTITY,
    NB,
    TWO,
    ZERO,
    B,
    B_dot,
    C,
    F,
    G,
    M,
    Mt,
    NB_dot,
    Q,
    Qa,
    Slot,
    bold,
    delta_diff,
    equals,
    inverse,
    juxtaposed,
    lam,
    listed,
    number,
    paragraph,
    plus,
    pseudoinverse,
    qd,
    qdd,
    say,
    small_n,
    transposed,
    u,
)
from symgen.report.sections.by_laws.projections import projector_laws

X = bold("X")


def projection(context: Context) -> Section:
    """N_B and its derivative, and the equations without multipliers."""
    if not context.model.r:
        text = "There are no constraints; the projector is the identity, {}, and {} needs no projection."
        blocks: tuple[Block, ...] = (paragraph(text, equals(NB, IDENTITY), _balance(context)),)
        return Section(say("Null space"), blocks)
    definition = equals(NB, Sum((("+", IDENTITY), ("-", juxtaposed(pseudoinverse(B), B)))))
    body: list[Block] = [
        paragraph(
            "The orthogonal projector onto the admissible velocities, the null space of {}, is {}; it is symmetric "
            "and idempotent, and {}.",
            B,
            definition,
            equals(juxtaposed(B, NB), ZERO),
        ),
        *_pseudoinverse(context),
        *_projector(context),
        *_derivative(context),
        *_projected(context),
    ]
    if context.model.independent_velocities and context.form("orthogonal_complement") is not None:
        body += _complement(context)
    return Section(say("Null space and projected equations"), tuple(body))


def _balance(context: Context) -> Layout:
    """G q̈ + C q̇ + Q − Q_a."""
    balance = plus(juxtaposed(G, qdd), juxtaposed(C, qd), Q)
    if not context.model.has_applied_forces:
        return balance
    return Sum((("+", juxtaposed(G, qdd)), ("+", juxtaposed(C, qd)), ("+", Q), ("-", Qa)))


def _pseudoinverse(context: Context) -> list[Block]:
    if context.structure.constraint_rank < context.model.r:
        return [paragraph("{} is the Moore–Penrose inverse of rank ρ.", pseudoinverse(B))]
    gram = inverse(Fenced(juxtaposed(B, transposed(B))))
    formula = equals(pseudoinverse(B), juxtaposed(transposed(B), gram))
    blocks: list[Block] = [paragraph("As long as the rows of {} are independent, {}.", B, formula)]
    written = context.matrix("constraint_pseudoinverse") is not None and not context.laws("constraint_pseudoinverse")
    if context.full and written:
        blocks += [paragraph("In closed form"), *context.quantity("constraint_pseudoinverse", "Bplus")]
    return blocks


def _projector(context: Context) -> list[Block]:
    form, laws = context.form("nullspace_projector"), projector_laws(context)
    if form is None or laws:
        return laws
    if form.matrix is None:
        return [*context.quantity("nullspace_projector", "NB")]
    if form.intermediates:
        opening = paragraph(
            "In the signed minors of {}, named below, it is a quotient of polynomials without any matrix inverse.", B
        )
    else:
        opening = paragraph(
            "In closed form, derived from the minors of {} in exact arithmetic without a matrix inverse,", B
        )
    return [opening, *context.quantity("nullspace_projector", "NB")]


def _derivative(context: Context) -> list[Block]:
    if context.vanishes("nullspace_projector_dot"):
        return [paragraph("The projector is constant, {}.", equals(NB_dot, ZERO))]
    formula = equals(NB_dot, Sum((("-", X), ("-", transposed(X)))))
    where = equals(X, juxtaposed(pseudoinverse(B), B_dot, NB))
    blocks: list[Block] = [
        paragraph("Its time derivative is symmetric, {} with {} (Remark 9 of the paper).", formula, where)
    ]
    if context.full and context.matrix("nullspace_projector_dot") is not None:
        blocks += [paragraph("In closed form it is"), *context.quantity("nullspace_projector_dot", "NBdot")]
    return blocks


def _projected(context: Context) -> list[Block]:
    left = juxtaposed(NB, Fenced(_balance(context)))
    right: Layout = juxtaposed(Mt, u) if context.model.m else ZERO
    rank = equals(delta_diff, number(context.structure.differential_freedom))
    pattern = (
        "Multiplying the equations of motion by {} removes the multipliers {}, since {}. What remains, paper (21), "
        "is valid wherever "
        "the rank of {} is that of its neighbourhood:"
    )
    zero = equals(juxtaposed(NB, transposed(B)), ZERO)
    return [
        paragraph(pattern, NB, lam, zero, B),
        displayed((equals(left, right),), "projected"),
        paragraph("Their number is {}, their rank {}.", equals(small_n, number(context.model.n)), rank),
        paragraph(
            "Measured velocities and accelerations need not satisfy the constraints; they are projected first, {} "
            "and {} (Remark 9).",
            equals(qd, juxtaposed(NB, _measured(qd))),
            equals(qdd, plus(juxtaposed(NB, _measured(qdd)), juxtaposed(NB_dot, qd))),
        ),
    ]


def _measured(vector: Layout) -> Layout:
    """A measured vector carries the index 0."""
    return Scripts(vector, ZERO)


def _complement(context: Context) -> list[Block]:
    velocities = listed(tuple(name_layout(f"{name}_dot") for name in context.model.independent_velocities))
    second = Scripts(qd, TWO)
    return [
        paragraph(
            "For comparison, the minimal formulation chooses the velocities {} as independent; then {} with, paper "
            "(7) and (8),",
            equals(second, Fenced(velocities)),
            equals(qd, juxtaposed(F, second)),
        ),
        *context.quantity("orthogonal_complement", "F"),
        paragraph(
            "It exists only where these velocities are independent. The reduced matrices, paper (9), follow as {}, "
            "{}, {} and {}.",
            *_reduced(),
        ),
    ]


def _reduced() -> list[Slot]:
    ft = transposed(F)
    inner = plus(juxtaposed(C, F), juxtaposed(G, Accent(F, "dot")))
    return [
        equals(Accent(G, "bar"), juxtaposed(ft, G, F)),
        equals(Accent(C, "bar"), juxtaposed(ft, Fenced(inner))),
        equals(Accent(Q, "bar"), juxtaposed(ft, Q)),
        equals(Accent(M, "bar"), juxtaposed(ft, M)),
    ]
