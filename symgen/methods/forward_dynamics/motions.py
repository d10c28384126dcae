"""The forms of q_ddot and lambda that a null space offers, and which of them may be chosen by counted cost.

Valid wherever the system has a motion: `minor` (independent rows, delta of 1 or 2), `schur_qr` where G is positive
definite everywhere, else `nullspace`.  `schur_ldl`, `shifted` and `kkt` are there to be compared with: the first two
lose digits with the square of the condition number of B, the last is long.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from math import comb
from typing import Literal, TypeAlias

from symgen.linear_algebra.constrained_inverse import ConstrainedInertia
from symgen.linear_algebra.null_spaces import MinorSpace, NullSpace
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.held_lengths import completed_multipliers
from symgen.methods.forward_dynamics.minor_motion import LARGEST_DELTA, MinorMotion, minor_motion
from symgen.methods.forward_dynamics.motion import MotionMethod, Problem
from symgen.methods.forward_dynamics.projected_motion import kkt, nullspace, shifted
from symgen.methods.forward_dynamics.schur import schur_ldl, schur_qr
from symgen.symbolic.traverse import cost
from symgen.validity.definiteness import positive_definite

MotionName: TypeAlias = Literal["minor", "schur_qr", "schur_ldl", "nullspace", "shifted", "kkt"]
MOTION_NAMES: tuple[MotionName, ...] = ("minor", "schur_qr", "schur_ldl", "nullspace", "shifted", "kkt")
MOST_MINORS = 70
# What `minor` is worth in operations where coordinates have several units: it alone does not add what has different
# units up, as norms and reflections do (float32 q_ddot of a robot on wheels: 2 units of error in place of 24).
MINOR_WORTH = Fraction(1, 4)
BY_FRAMES = "articulated"  # of bodies only, without a null space: forms/articulated.py
BY_BODIES = "articulated_refined"  # the same, refined by Newton and Euler's equations


def candidates(generic: Genericity, space: NullSpace) -> tuple[MotionName, ...]:
    """The forms among which counted cost may decide; `schur_qr` only where `positive_definite` says so."""
    by_minors = isinstance(space, MinorSpace) and 1 <= generic.delta <= LARGEST_DELTA
    if generic.r == 0:
        return ("minor", "schur_qr") if by_minors else ("schur_qr",)
    if generic.rank < generic.r:
        return ("schur_qr", "nullspace")
    return ("minor", "schur_qr") if by_minors else ("schur_qr", "nullspace")


def few_minors(generic: Genericity) -> bool:
    """Whether minors of the rows are at hand although the null space is not built from them."""
    return 1 <= generic.delta <= LARGEST_DELTA and comb(generic.n, generic.n // 2) <= MOST_MINORS


def cheapest(
    motions: Mapping[MotionName, MotionMethod], part: Literal["accelerations", "multipliers"], mechanics: System
) -> MotionMethod:
    """The candidate that counts least, outputs and tested denominators together, exact cancellation worth some.

    `nullspace` is normwise accurate in the units that B is given in, and loses what masses and lengths are apart by: it
    is left for systems in which G is definite along the constraints only.
    """
    counted = {
        name: cost((*getattr(one, part), *(guard.denominator for guard in one.guards))).weight
        for name, one in motions.items()
    }
    weights = {name: count * cost_factor(name, mechanics) for name, count in counted.items()}
    order = sorted(motions, key=lambda name: (name == "nullspace", weights[name]))
    usable = (name for name in order if name != "schur_qr" or len(order) == 1 or positive_definite(mechanics))
    return motions[next(usable)]


def one_unit(mechanics: System) -> bool:
    """Whether all coordinates are angles in one unit, or lengths in one unit."""
    return len({(c.unit, c.is_angle) for c in mechanics.model.coordinates}) == 1


def cost_factor(name: str, mechanics: System) -> Fraction:
    """The factor by which the counted cost of a form is taken."""
    return 1 - MINOR_WORTH * (name == "minor" and not one_unit(mechanics))


def motion(
    name: MotionName, mechanics: System, space: NullSpace, inertia: ConstrainedInertia | None = None
) -> MotionMethod:
    """One form along a null space; `nullspace` needs the constrained inverse of G that belongs to it."""
    completed = completed_multipliers(mechanics)
    made = _motion(name, Problem(mechanics, space.guards), space, inertia)
    return replace(made, multipliers=completed(made.multipliers), name=name)


def _motion(name: MotionName, problem: Problem, space: NullSpace, inertia: ConstrainedInertia | None) -> MotionMethod:
    match name:
        case "minor":
            return inertia.motion if isinstance(inertia, MinorMotion) else minor_motion(problem).motion
        case "schur_qr":
            return schur_qr(problem, problem.n - space.delta)
        case "schur_ldl":
            return schur_ldl(problem)
        case "nullspace":
            assert inertia is not None
            return nullspace(problem, space, inertia)
        case "shifted":
            return shifted(problem, space)
        case "kkt":
            return kkt(problem)
