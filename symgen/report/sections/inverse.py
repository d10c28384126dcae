"""The section on inverse dynamics: M̃, its pseudoinverse and the inputs u, paper (21), (27), (28)."""

from __future__ import annotations

from symgen.report.context import Context
from symgen.report.document import Block, FormulaReference, Section, displayed
from symgen.report.mathematics.layout import Fenced, Layout
from symgen.report.prose import (
    NB,
    B,
    G,
    M,
    Mt,
    Qa,
    V,
    W,
    delta_diff,
    equals,
    juxtaposed,
    minus_sum,
    nu,
    paragraph,
    pseudoinverse,
    qd,
    qdd,
    say,
    small_m,
    tau,
    transposed,
    u,
)
from symgen.report.prose import C as CORIOLIS
from symgen.report.prose import Q as POTENTIAL
from symgen.report.sections.allocation import allocated_inputs
from symgen.report.sections.by_laws.projections import input_laws, inverse_laws
from symgen.report.sections.rough import friction_of_reactions


def inverse_dynamics(context: Context) -> Section:
    """From a motion to the inputs that produce it."""
    if not context.model.m:
        return Section(say("Inverse dynamics"), (paragraph("Without inputs there is no inverse dynamics."),))
    structure, m, allocation = context.structure, context.model.m, context.model.allocation
    full = structure.degree_of_actuation == structure.differential_freedom
    blocks: list[Block] = [*_projected_control(context)]
    blocks.append(_pseudoinverse(context, full))
    blocks += inverse_laws(context) or context.quantity("projected_control_pseudoinverse", "Mplus")
    blocks += [
        paragraph("The {} that produce a motion are, paper (27),", _which_inputs(context)),
        displayed((equals(u, juxtaposed(pseudoinverse(Mt), tau)), equals(tau, _balance(context))), "u"),
    ]
    if context.model.r:
        blocks.append(
            paragraph(
                "The factor {} in front of {} that the paper prints is not needed, since {}.",
                NB,
                tau,
                equals(juxtaposed(pseudoinverse(Mt), NB), pseudoinverse(Mt)),
            )
        )
    if allocation is not None:
        blocks += allocated_inputs(context.model, allocation, structure.degree_of_actuation == m)
    blocks += friction_of_reactions(context.model)
    blocks += _inputs_written_out(context)
    if full and m == structure.differential_freedom:
        # W stands for a basis that is listed, where there is one
        basis = V if any(law.kind in ("basis", "kernel") for law in context.laws("nullspace_projector")) else W
        wt = transposed(basis)
        blocks.append(
            paragraph(
                "Since {} is a basis of the admissible velocities with {}, the numbers {} are velocities along the "
                "inputs and "
                "{} is the mass seen by them (Remark 10 of the paper).",
                equals(basis, transposed(Fenced(pseudoinverse(Mt)))),
                equals(qd, juxtaposed(basis, nu)),
                equals(nu, juxtaposed(transposed(M), qd)),
                juxtaposed(wt, G, basis),
            )
        )
    return Section(say("Inverse dynamics"), tuple(blocks))


def _pseudoinverse(context: Context, full: bool) -> Block:
    """What M̃⁺ is in this case of actuation."""
    if not full:
        return paragraph(
            "The degree of actuation is smaller than the number of independent velocities. {} is the "
            "Moore–Penrose inverse "
            "at this rank; the inputs then come as near as possible to the demanded motion, and the residual "
            "tells what "
            "they cannot supply.",
            pseudoinverse(Mt),
        )
    if context.model.m > context.structure.differential_freedom:
        return paragraph(
            "There are more inputs than independent velocities. The Moore–Penrose inverse {} selects the "
            "smallest inputs. "
            "The paper splits {} into columns, (28), and must switch between splittings; with any basis {} of "
            "the null "
            "space of {} the same matrix is {}, without a choice.",
            pseudoinverse(Mt),
            Mt,
            W,
            B,
            _by_basis(),
        )
    if not context.model.r:
        return paragraph(
            "There are as many inputs as coordinates. Where {} is regular, its pseudoinverse is the inverse.", Mt
        )
    return paragraph(
        "There are as many inputs as independent velocities, {}. Where {} has full rank, its pseudoinverse {} "
        "is the left "
        "inverse; with any basis {} of the null space of {} it is {}, because {}.",
        equals(small_m, delta_diff),
        Mt,
        pseudoinverse(Mt),
        W,
        B,
        _by_basis(),
        equals(juxtaposed(pseudoinverse(Mt), NB), pseudoinverse(Mt)),
    )


def _by_basis() -> Layout:
    wt = transposed(W)
    return juxtaposed(pseudoinverse(Fenced(juxtaposed(wt, M))), wt)


def _balance(context: Context) -> Layout:
    return minus_sum(
        (juxtaposed(G, qdd), juxtaposed(CORIOLIS, qd), POTENTIAL), (Qa,) if context.model.has_applied_forces else ()
    )


def _projected_control(context: Context) -> list[Block]:
    if not context.model.r:
        return [paragraph("Without constraints the projected control matrix is the control matrix, {}.", equals(Mt, M))]
    control, projected = context.matrix("control_matrix"), context.matrix("projected_control_matrix")
    if control is not None and projected is not None and control == projected:
        return [
            paragraph(
                "The columns of {} are admissible velocities already; the projected control matrix is {}.",
                M,
                equals(Mt, juxtaposed(NB, M), M),
            )
        ]
    blocks: list[Block] = [paragraph("The projected control matrix, paper (21), is {}.", equals(Mt, juxtaposed(NB, M)))]
    if projected is not None and not context.laws("nullspace_projector"):
        blocks += context.quantity("projected_control_matrix", "Mtilde")
    return blocks


def _which_inputs(context: Context) -> str:
    """Of all that produce a motion those that (27) gives."""
    if context.model.rough:
        return "inputs without friction of reactions"
    return "smallest inputs" if context.model.allocation is not None else "inputs"


def _inputs_written_out(context: Context) -> list[Block]:
    laws = input_laws(context)
    if laws:
        return laws
    if context.matrix("inverse_dynamics") is None or not context.full:
        evaluated = FormulaReference("D" if context.model.rough else "u")
        return (
            [paragraph("The generated code evaluates {} without forming {} or any inverse.", evaluated, NB)]
            if context.model.r
            else []
        )
    return [
        paragraph("With everything inserted, the inputs are explicit functions of the motion:"),
        *context.quantity("inverse_dynamics", "uout"),
    ]
