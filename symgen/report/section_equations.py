"""The section on the equations of motion: G, C, Q, B and M, paper (1)-(3)."""

from __future__ import annotations

from symgen.report.context import Context
from symgen.report.document import Block, Formula, Reference, Section
from symgen.report.layout import Fraction, Layout, Letter, Numeral, Product, Row, Scripts, Sum, equation
from symgen.report.names import name_layout
from symgen.report.prose import (
    B,
    B_dot,
    C,
    G,
    M,
    Q,
    Qa,
    T,
    U,
    equals,
    g,
    juxtaposed,
    lam,
    listed,
    paragraph,
    q,
    qd,
    qdd,
    say,
    transposed,
    u,
)

ZERO = Numeral("0")
PARTIAL = Letter("∂", "upright")


def equations_of_motion(context: Context) -> Section:
    """Lagrange's equations of the first kind and their matrices."""
    constrained, driven = bool(context.model.r), bool(context.model.m)
    blocks: list[Block] = [
        paragraph("Lagrange's equations of the first kind for the energies above, paper (2) and (3), are in matrix form"),
        Formula((_motion(context),), "motion"),
        paragraph(
            "with the mass matrix {}, the Coriolis matrix {} and the potential forces {}.", G, C, Q
        ) if not context.model.applied_forces else paragraph(
            "with the mass matrix {}, the Coriolis matrix {}, the potential forces {} and the applied forces {}.", G, C, Q, Qa
        ),
        *_mass(context),
        *_coriolis(context),
        *_potential(context),
        *_applied(context),
    ]
    blocks += _jacobian(context) if constrained else []
    blocks += _control(context) if driven else []
    return Section(say("Equations of motion"), tuple(blocks))


def _motion(context: Context) -> Layout:
    """G q̈ + C q̇ + Q + Bᵀλ = M u + Q_a, without what the model has not."""
    left: list[Layout] = [juxtaposed(G, qdd), juxtaposed(C, qd), Q]
    if context.model.r:
        left.append(juxtaposed(transposed(B), lam))
    right: list[Layout] = [juxtaposed(M, u)] if context.model.m else []
    if context.model.applied_forces:
        right.append(Qa)
    return equals(_plus(left), _plus(right) if right else ZERO)


def _plus(terms: list[Layout]) -> Layout:
    return terms[0] if len(terms) == 1 else Sum(tuple(("+", term) for term in terms))


def _mass(context: Context) -> list[Block]:
    half = Fraction(Numeral("1"), Numeral("2"))
    quadratic = equals(T, Product((half, transposed(qd), G, qd)))
    return [
        paragraph("The kinetic energy {} equals {}, so that {} consists of its second derivatives:", Reference("T"), quadratic.pieces[-1], G),
        *context.quantity("mass_matrix", "G"),
    ]


def _coriolis(context: Context) -> list[Block]:
    if context.vanishes("coriolis_matrix"):
        return [paragraph("The mass matrix is constant, therefore {}.", equals(C, ZERO))]
    half = Fraction(Numeral("1"), Numeral("2"))
    a, b, c = Letter("a"), Letter("b"), Letter("c")
    terms: tuple[tuple[Letter, Letter, Letter], ...] = ((a, b, c), (a, c, b), (b, c, a))
    derivatives = [_partial(Scripts(G, listed(t[:2])), Scripts(Letter("q"), None, t[2])) for t in terms]
    bracket = Row((Letter("(", "upright"), Sum((("+", derivatives[0]), ("+", derivatives[1]), ("-", derivatives[2]))), Letter(")", "upright")))
    rate = Scripts(name_layout("q_dot"), None, c)
    christoffel = equation(Scripts(C, listed((a, b))), Product((half, bracket, rate)))
    skew = Sum((("+", _dot(G)), ("-", Product((Numeral("2"), C)))))
    return [
        paragraph("The Coriolis matrix is formed with Christoffel symbols (summed over {}),", c),
        Formula((christoffel,)),
        paragraph("the choice for which {} is skew-symmetric. It is", skew),
        *context.quantity("coriolis_matrix", "C"),
    ]


def _partial(of: Layout, by: Layout) -> Layout:
    return Fraction(Row((PARTIAL, of)), Row((PARTIAL, by)))


def _dot(node: Layout) -> Layout:
    from symgen.report.layout import Accent

    return Accent(node, "dot")


def _potential(context: Context) -> list[Block]:
    if context.vanishes("potential_force"):
        return [paragraph("There are no potential forces: {}.", equals(Q, ZERO))]
    gradient = equals(Q, transposed(Row((Letter("(", "upright"), _partial(U, q), Letter(")", "upright")))))
    return [paragraph("The potential forces {} are", gradient), *context.quantity("potential_force", "Q")]


def _applied(context: Context) -> list[Block]:
    if not context.model.applied_forces:
        return []
    return [paragraph("The applied forces are"), *context.quantity("applied_force", "Qa")]


def _jacobian(context: Context) -> list[Block]:
    kinds = {row.kind for row in context.model.constraints}
    made = {
        frozenset({"geometric"}): ("Differentiating the constraints {} gives {}, paper (1), with {}:", [Reference("constraints_geometric")]),
        frozenset({"nonholonomic"}): ("The constraints {} read {}, paper (1); the coefficients of the rates are {}:", [Reference("constraints_nonholonomic")]),
    }
    velocity = equals(juxtaposed(B, qd), ZERO)
    if len(kinds) == 2:
        opening = paragraph(
            "Differentiating {} and taking the coefficients of {} gives {}, paper (1), with {}:",
            Reference("constraints_geometric"), Reference("constraints_nonholonomic"), velocity, B,
        )
    else:
        pattern, slots = made[frozenset(kinds)]
        opening = paragraph(pattern, *slots, velocity, B)
    blocks: list[Block] = [opening, *context.quantity("constraint_jacobian", "B")]
    acceleration = equals(Sum((("+", juxtaposed(B, qdd)), ("+", juxtaposed(B_dot, qd)))), ZERO)
    if context.vanishes("constraint_jacobian_dot"):
        blocks.append(paragraph("{} is constant; accelerations satisfy {}.", B, equals(juxtaposed(B, qdd), ZERO)))
    else:
        blocks.append(paragraph("Accelerations satisfy {} with", acceleration))
        blocks += context.quantity("constraint_jacobian_dot")
    if "geometric" in kinds:
        blocks.append(paragraph("The residual of the geometric constraints is written {}.", g))
    return blocks


def _control(context: Context) -> list[Block]:
    return [
        paragraph("The control matrix has one column for each input:"),
        *context.quantity("control_matrix", "M"),
    ]
