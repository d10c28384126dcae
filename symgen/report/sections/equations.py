"""The section on the equations of motion: G, C, Q, B and M, paper (1)-(3)."""

from __future__ import annotations

from symgen.report.context import Context
from symgen.report.document import Block, FormulaReference, Section, displayed
from symgen.report.mathematics.layout import (
    Accent,
    Fenced,
    Fraction,
    Layout,
    Letter,
    Product,
    Row,
    Scripts,
    Sum,
    equation,
    size,
)
from symgen.report.prose import (
    HALF,
    PARTIAL,
    TWO,
    ZERO,
    B,
    B_dot,
    C,
    G,
    M,
    Q,
    Qa,
    Slot,
    T,
    U,
    bold,
    equals,
    g,
    juxtaposed,
    lam,
    listed,
    minus_sum,
    paragraph,
    plus,
    q,
    qd,
    qdd,
    say,
    transposed,
    u,
)
from symgen.report.sections.by_laws.constraints import jacobian_law, rate_law
from symgen.report.sections.recursion import recursion

D = bold("D")
# Nodes up to which the potential forces are printed where the recursion of Newton and Euler follows.
LONG_BEFORE_RECURSION = 600


def equations_of_motion(context: Context) -> Section:
    """Lagrange's equations of the first kind and their matrices."""
    names: list[Slot] = [G, C, Q]
    pattern = "Here {} is the mass matrix, {} the Coriolis matrix and {} the vector of potential forces."
    if context.model.has_applied_forces:
        pattern = "Here {} is the mass matrix, {} the Coriolis matrix, {} are the potential and {} the applied forces."
        names.append(Qa)
    blocks: list[Block] = [
        paragraph("Lagrange's equations of the first kind, paper (2), read in matrix form, paper (3),"),
        displayed((_motion(context),), "motion"),
        paragraph(pattern, *names),
        *_mass(context),
        *_coriolis(context),
        *_potential(context),
        *recursion(context),
    ]
    if context.model.rough:
        blocks += [paragraph("Friction {} grows with reactions; it stands below, with the inputs.", D)]
    if context.model.has_applied_forces:
        blocks += [paragraph("The applied forces are"), *context.quantity("applied_force", "Qa")]
    if context.model.r:
        blocks += _jacobian(context)
    if context.model.m:
        blocks += [
            paragraph("The control matrix has one column for each input, the coefficients of its power:"),
            *context.quantity("control_matrix", "M"),
        ]
    return Section(say("Equations of motion"), tuple(blocks))


def _motion(context: Context) -> Layout:
    """G q̈ + C q̇ + Q + Bᵀλ = M u + Q_a − D, without what the model has not."""
    left: list[Layout] = [juxtaposed(G, qdd), juxtaposed(C, qd), Q]
    if context.model.r:
        left.append(juxtaposed(transposed(B), lam))
    right: list[Layout] = [juxtaposed(M, u)] if context.model.m else []
    if context.model.has_applied_forces:
        right.append(Qa)
    if context.model.rough:
        return equals(plus(*left), minus_sum((plus(*right),), (D,)))
    return equals(plus(*left), plus(*right) if right else ZERO)


def _mass(context: Context) -> list[Block]:
    quadratic = equals(T, Product((HALF, transposed(qd), G, qd)))
    written = context.matrix("mass_matrix") is not None
    pattern = "Writing the kinetic energy {} as {} gives" if written else "The kinetic energy {} is {}."
    return [
        paragraph(pattern, FormulaReference("T"), quadratic),
        *context.quantity("mass_matrix", "G"),
    ]


def _coriolis(context: Context) -> list[Block]:
    if context.vanishes("coriolis_matrix"):
        return [paragraph("The mass matrix is constant; therefore {}.", equals(C, ZERO))]
    following = "" if context.matrix("coriolis_matrix") is None else " It is"
    a, b, c = Letter("a"), Letter("b"), Letter("c")
    derivatives = [
        _partial(Scripts(G, listed(pair)), Scripts(Letter("q"), None, by))
        for pair, by in (((a, b), c), ((a, c), b), ((b, c), a))
    ]
    bracket = Sum((("+", derivatives[0]), ("+", derivatives[1]), ("-", derivatives[2])))
    rate = Scripts(Accent(Letter("q"), "dot"), None, c)
    christoffel = equation(Scripts(C, listed((a, b))), Product((HALF, Fenced(bracket), rate)))
    skew = Sum((("+", Accent(G, "dot")), ("-", Product((TWO, C)))))
    return [
        paragraph("The Coriolis matrix consists of Christoffel symbols (sum over {}),", c),
        displayed((christoffel,)),
        paragraph(f"the choice that makes {{}} skew-symmetric.{following}", skew),
        *context.quantity("coriolis_matrix", "C"),
    ]


def _partial(of: Layout, by: Layout) -> Layout:
    return Fraction(Row((PARTIAL, of)), Row((PARTIAL, by)))


def _potential(context: Context) -> list[Block]:
    if context.vanishes("potential_force"):
        return [paragraph("There are no potential forces, {}.", equals(Q, ZERO))]
    gradient = equals(Q, transposed(Fenced(_partial(U, q))))
    matrix = context.matrix("potential_force")
    if context.input.frame_steps and (matrix is None or size(context.layout.matrix(matrix)) > LONG_BEFORE_RECURSION):
        return [paragraph("The potential forces, {}, are long; the recursion below has them with the rest.", gradient)]
    return [paragraph("The potential forces, {}, are", gradient), *context.quantity("potential_force", "Q")]


def _coefficients(context: Context) -> list[Block]:
    return jacobian_law(context) or list(context.quantity("constraint_jacobian", "B"))


def _jacobian(context: Context) -> list[Block]:
    kinds = {row.kind for row in context.model.constraints}
    velocity = equals(juxtaposed(B, qd), ZERO)
    references = [FormulaReference(f"constraints_{kind}") for kind in ("geometric", "nonholonomic") if kind in kinds]
    pattern = {
        frozenset({"geometric"}): "The time derivative of {} is {}, paper (1), with the coefficient matrix",
        frozenset({"nonholonomic"}): "The constraints {} read {}, paper (1), with the coefficient matrix",
        frozenset({"geometric", "nonholonomic"}): (
            "The time derivative of {} together with {} reads {}, paper (1), with the coefficient matrix"
        ),
    }[frozenset(kinds)]
    blocks: list[Block] = [paragraph(pattern, *references, velocity), *_coefficients(context)]
    if context.vanishes("constraint_jacobian_dot"):
        blocks.append(
            paragraph("{} is constant, so that accelerations satisfy {}.", B, equals(juxtaposed(B, qdd), ZERO))
        )
    else:
        acceleration = equals(plus(juxtaposed(B, qdd), juxtaposed(B_dot, qd)), ZERO)
        blocks += [paragraph("A further derivative, {}, restricts the accelerations, with", acceleration)]
        blocks += rate_law(context) or context.quantity("constraint_jacobian_dot", "Bdot")
    if "geometric" in kinds:
        blocks.append(
            paragraph("The left-hand sides of {} are collected in {}.", FormulaReference("constraints_geometric"), g)
        )
    return blocks
