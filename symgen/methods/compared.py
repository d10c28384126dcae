"""Every form of q_ddot, lambda and N_B that a system has, each on a graph of its own: for comparisons and for users."""

from __future__ import annotations

from symgen.linear_algebra.null_spaces import MINOR_LIMIT, MinorSpace, NullSpace
from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.articulated import articulated
from symgen.methods.forward_dynamics.minor_motion import LARGEST_DELTA
from symgen.methods.forward_dynamics.motion import MotionMethod
from symgen.methods.forward_dynamics.motions import BY_BODIES, BY_FRAMES, MOTION_NAMES, MotionName, candidates, motion
from symgen.methods.quantity import Quantity, resting_on
from symgen.model.model import Model
from symgen.symbolic.matrix import flatten

MOTIONS = ("forward_dynamics", "multipliers")
# These work with an orthonormal basis of the null space, the others with the minors of B or its rows.
ORTHONORMAL = ("nullspace", "householder")


def motions_of(model: Model) -> dict[str, tuple[System, tuple[Quantity, ...]]]:
    """q_ddot, lambda and N_B by form name: the mechanics a form was derived on, and the quantities on their graph.

    `householder` is a form of N_B only, `minor` of all three where delta is 1 or 2.
    """
    generic = genericity(System(model))
    forms = {name: quantities_by(model, generic, name) for name in (*MOTION_NAMES, BY_FRAMES, "householder")}
    return {name: form for name, form in forms.items() if form[1]}


def quantities_by(model: Model, generic: Genericity, name: str) -> tuple[System, tuple[Quantity, ...]]:
    """One form: the mechanics it was derived on, and those of q_ddot, lambda and N_B that it has."""
    if name in (BY_FRAMES, BY_BODIES):
        found = articulated(model, generic, by_bodies=name == BY_BODIES)
        return (System(model), ()) if found is None else (found[0], _of_motion(generic, found[1]))
    mechanics = System(model)
    space = _space(mechanics, generic, name)
    return mechanics, () if space is None else _quantities(mechanics, generic, space, name)


def why_missing(generic: Genericity, quantity: str, name: str) -> str:
    """The reason for which a system lacks a form of a quantity."""
    by_minors = name == "minor"
    if name in (BY_FRAMES, BY_BODIES):
        return "it is for bodies alone with one frame for each coordinate and definite G"
    if not generic.r and not (by_minors and quantity in MOTIONS):
        return "there are no constraints"
    if by_minors and generic.minors > MINOR_LIMIT:
        return f"B has {generic.minors} minors"
    if generic.rank < generic.r:
        return "the constraint rows depend on each other"
    return f"it is for {LARGEST_DELTA} degrees of freedom at most, of which the system has {generic.delta}"


def _space(mechanics: System, generic: Genericity, name: str) -> NullSpace | None:
    graph, rows, n = mechanics.graph, mechanics.constraint_jacobian, mechanics.n
    few = generic.minors <= MINOR_LIMIT
    if rows and (name in ORTHONORMAL or (not few and name != "minor")):
        return reflected_rows(mechanics, generic)
    return MinorSpace(graph, rows, n, generic.rank) if few and (rows or name not in ORTHONORMAL) else None


def _quantities(mechanics: System, generic: Genericity, space: NullSpace, name: str) -> tuple[Quantity, ...]:
    n, r = generic.n, generic.r
    found: tuple[Quantity, ...] = ()
    if motion_name := _motion_name(generic, space, name):
        # equal functions are one node of a graph: what a form does not need must not be on it
        derivation = Derivation(mechanics, generic, space)
        own = motion_name in ("schur_qr", "minor", "nullspace")
        made = derivation.motion(motion_name) if own else motion(motion_name, mechanics, space)
        found = _of_motion(generic, made)
    if r and name in ("minor", "householder"):
        found += (Quantity("nullspace_projector", (n, n), flatten(space.projector), space.guards),)
    return found


def _of_motion(generic: Genericity, made: MotionMethod) -> tuple[Quantity, ...]:
    accelerations = resting_on(made.guards, MOTIONS[0], made.accelerations)
    multipliers = resting_on(made.guards, MOTIONS[1], made.multipliers)
    return (accelerations, multipliers) if generic.r else (accelerations,)


def _motion_name(generic: Genericity, space: NullSpace, name: str) -> MotionName | None:
    """The form of q_ddot and lambda by that name, where the system has it."""
    known = next((one for one in MOTION_NAMES if one == name), None)
    if known is None or (known == "minor" and known not in candidates(generic, space)):
        return None
    # the others need independent rows, or any rows at all
    if generic.rank < generic.r and known not in ("schur_qr", "nullspace", "shifted"):
        return None
    return None if generic.r == 0 and known in ("nullspace", "shifted") else known
