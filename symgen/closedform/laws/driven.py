"""u where each input drives a coordinate of its own: what these carry, less what constraints bring from the others."""

from __future__ import annotations

from sympy import ImmutableDenseMatrix

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.exact import Exact
from symgen.closedform.laws.known import KnownNames
from symgen.closedform.laws.projections import INVERSE
from symgen.closedform.laws.terms import (
    LawDifference,
    LawFactor,
    LawInverse,
    LawMatrix,
    LawOpposite,
    LawTerm,
    LawUnit,
    ListedFactor,
    MatrixLaw,
    PartFactor,
    flipped,
    product,
)
from symgen.model.quantities import MULTIPLIERS

LONGEST_LISTED_LOAD = 100
"""A load tau with more terms than this stays G qdd + C qd + Q - Q_a, whose parts are printed."""

INPUTS = "inverse_dynamics"


def driven_coordinates(exact: Exact) -> tuple[int, ...] | None:
    """The coordinate that each input drives, in the order of the inputs; None where one drives several, or two one."""
    columns = zip(*exact.mechanics.control, strict=True)
    places = [[i for i, entry in enumerate(column) if entry] for column in columns]
    if any(len(place) != 1 for place in places) or len({i for (i,) in places}) < len(places):
        return None
    return tuple(i for (i,) in places)


def laws_of_driven_coordinates(exact: Exact, known: KnownNames) -> tuple[MatrixLaw, ...]:
    """u = M_a^-1 (tau_a - B_a^T B_p^-T tau_p), the same as columns of the pseudoinverse, and lambda.

    The rows a of tau + B^T lambda = M u have the inputs, the others, p, give lambda.  For as many inputs as directions.
    Where rows of B depend on each other B_p has more of them than columns, and B_p (B_p^T B_p)^-1 stands for B_p^-T:
    lambda is the smallest then.
    """
    driven = driven_coordinates(exact) if exact.model.inputs else None
    square = exact.model.m == exact.delta and exact.full_actuation and exact.model.r
    if driven is None or not square:
        return ()
    others = tuple(i for i in range(exact.model.n) if i not in driven)
    gears, load = exact.mechanics.control, _listed_load(exact, known)
    unit = all(gears[i][k].numerator == gears[i][k].denominator == 1 for k, i in enumerate(driven))
    columns = (PartFactor("B_a", "B", driven), PartFactor("B_p", "B", others))
    parts: tuple[LawFactor, ...] = columns if unit else (*columns, PartFactor("M_a", "M", driven))
    rows: tuple[LawFactor, ...] = (*load, PartFactor("tau_a", "tau", driven), PartFactor("tau_p", "tau", others))
    geared: tuple[LawTerm, ...] = () if unit else (LawInverse(LawMatrix("M_a")),)
    independent = exact.structure.constraint_rank == exact.model.r
    squares = LawInverse(product(flipped("B_p"), "B_p"))
    held: tuple[LawTerm, ...] = (LawInverse(flipped("B_p")),) if independent else (LawMatrix("B_p"), squares)
    carried = LawDifference(LawMatrix("tau_a"), product(flipped("B_a"), *held, "tau_p"))
    return (
        MatrixLaw(INVERSE, "driven", geared[0] if geared else LawUnit(), parts, part="a"),
        MatrixLaw(INVERSE, "driven", LawOpposite(product(*geared, flipped("B_a"), *held)), parts, part="p"),
        MatrixLaw(INPUTS, "driven", product(*geared, carried) if geared else carried, (*parts, *rows)),
        MatrixLaw(MULTIPLIERS, "driven", LawOpposite(product(*held, "tau_p")), (*parts, *rows)),
    )


def _listed_load(exact: Exact, known: KnownNames) -> tuple[ListedFactor, ...]:
    """tau, where it can be read."""
    try:
        terms = sum(len(entry.numerator) for (entry,) in exact.load)
    except TooLargeError:
        return ()
    if terms > LONGEST_LISTED_LOAD:
        return ()
    naming = known.naming()
    entries = [[known.quotient(naming.symbol(f"tau_{i + 1}"), e)] for i, (e,) in enumerate(exact.load)]
    return (ListedFactor("tau", ImmutableDenseMatrix(entries)),)
