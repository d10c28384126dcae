"""Friction that grows with the reactions it changes: the fixed point behind the inputs of a model with rough places."""

from __future__ import annotations

from symgen.model.model import Model
from symgen.report.document import Block, InlineCode, InlineMath, Table, displayed
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import Application, Fenced, Fraction, Layout, Letter, Scripts
from symgen.report.prose import (
    B,
    M,
    Mt,
    bold,
    equals,
    juxtaposed,
    lam,
    listed,
    minus_sum,
    number,
    paragraph,
    plus,
    pseudoinverse,
    qd,
    say,
    tau,
    transposed,
    u,
)

D, s, R = bold("D"), bold("s"), bold("R")
i, j, kappa = Letter("i"), Letter("j"), Letter("κ")


def _of(letter: Layout, index: Layout) -> Layout:
    return Scripts(letter, index)


def friction_of_reactions(model: Model) -> list[Block]:
    """What friction adds to the load, how it is worked out, and where it locks; nothing without rough places."""
    steps = model.friction_steps
    if not model.rough or steps is None:
        return []
    d_j, n_j, s_j = _of(Letter("d"), j), _of(Letter("n"), j), _of(s, j)
    way = Application(Letter("tanh", "upright"), Fenced(Fraction(juxtaposed(transposed(s_j), qd), _of(Letter("w"), j))))
    friction = equals(D, juxtaposed(_of(Letter("Σ"), j), s_j, d_j, n_j))
    size = equals(d_j, juxtaposed(_of(Letter("μ"), j), _of(Letter("ρ"), j), way))
    rest = juxtaposed(pseudoinverse(transposed(B)), Fenced(minus_sum((juxtaposed(M, u),), (tau, D))))
    R_0, R_j = _of(R, listed((i, number(0)))), _of(R, listed((i, j)))
    whole = plus(R_0, juxtaposed(_of(Letter("Σ"), j), R_j, d_j, n_j))
    load = equals(_of(Letter("n"), i), Fenced(whole, "|"))
    shares = juxtaposed(_of(Letter("Σ"), j), Fenced(juxtaposed(R_j, d_j), "|"))
    share = Application(_of(Letter("max", "upright"), i), shares)
    rows = tuple(
        (
            (InlineCode(place.name),),
            (InlineMath(expression_layout(place.coefficient)),),
            (InlineMath(expression_layout(place.radius)),),
            (InlineMath(expression_layout(place.velocity)),),
            (InlineMath(expression_layout(place.width)),),
        )
        for place in model.rough
    )
    heads = tuple(say(x) for x in ("Place", "Coefficient", "Radius", "Rate", "Width"))
    worked_out, too_few = "no place changes the load of another one, so that they are explicit", ""
    if not steps.explicit:
        worked_out = f"they are worked out place by place, {steps.steps} times, which leaves less than a rounding"
        too_few = ", or one time more changes a load,"
    return [
        paragraph(
            "Friction of pins and guides grows with the reactions that they carry, and changes them (Remark 3 of the "
            "paper). The inputs supply it beside the load, as it is with the reactions that come of them:"
        ),
        displayed((equals(u, juxtaposed(pseudoinverse(Mt), Fenced(plus(tau, D)))), friction, size), "D"),
        *((displayed((equals(lam, rest),), "lambda_D"),) if model.r else ()),
        Table(heads, rows, (0, 1, 1, 1, 1)),
        paragraph(
            "A guide counts as a pin of radius 1. The loads {} are the sizes of reactions, which are affine in them; a "
            "pin or guide that changes its own load is solved for as a quadratic equation.",
            n_j,
        ),
        displayed((load, equals(kappa, share)), "loads"),
        paragraph(
            "A change of the loads comes back as the share {} of it at most, so that for less than 1 there is one "
            f"solution. At {steps.points} configurations all over the ranges {{}} is {steps.kappa:.2g} at most with "
            f"all places sliding; {worked_out}. Where {{}} reaches one half{too_few} the function returns {{}} and "
            "leaves its result as it was.",
            kappa,
            kappa,
            kappa,
            InlineCode("FRICTION_LOCK"),
        ),
    ]
