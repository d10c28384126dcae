"""q_ddot and lambda by minors, by elimination of the accelerations, and by an orthonormal basis of the null space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from symgen.linear_algebra.constrained_inverse import ConstrainedInertia
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import MinorSpace, NullSpace
from symgen.linear_algebra.refinement import of_motion, refined
from symgen.mechanics.genericity import Genericity
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.absolute import in_absolute_angles, motion_brought_back
from symgen.methods.forward_dynamics.columns_apart import apart
from symgen.methods.forward_dynamics.held_lengths import completed_multipliers
from symgen.methods.forward_dynamics.minor_motion import LARGEST_DELTA, minor_motion
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import POSITIVE, AlongNullSpace, constraints, independent_rows
from symgen.methods.forward_dynamics.rough_motion import rough_by_basis, rough_by_elimination, rough_by_minors
from symgen.methods.forward_dynamics.schur import schur_qr
from symgen.methods.method import Method
from symgen.symbolic.matrix import Vector, matvec, subtract_vectors
from symgen.validity.definiteness import positive_definite


def _few_directions(generic: Genericity) -> bool:
    return generic.rank == generic.r and 1 <= generic.delta <= LARGEST_DELTA


def _many_directions(generic: Genericity) -> str | None:
    if _few_directions(generic):
        return None
    directions = f"it is for {LARGEST_DELTA} degrees of freedom at most, of which the system has {generic.delta}"
    return independent_rows(generic) or directions


def _by_minors(derivation: Derivation) -> bool:
    """Along minors, and where the constraints carry a load: what is left of it along a motion cancels in minors only.

    There G is not definite in every direction.
    """
    generic = derivation.generic
    if not _few_directions(generic):
        return False
    if isinstance(derivation.space, MinorSpace):
        return True
    return generic.r > 0 and not positive_definite(derivation.mechanics)


def _by_basis(derivation: Derivation) -> bool:
    """Where there are constraints, and minors are not at hand."""
    generic = derivation.generic
    return generic.r > 0 and not (_few_directions(generic) and isinstance(derivation.space, MinorSpace))


def _by_elimination(derivation: Derivation) -> bool:
    """Not even built beside a basis where G is singular somewhere.

    Equal functions are one node, and its pivots may be 0/0 where those of the other are not.
    """
    return not _by_basis(derivation) or positive_definite(derivation.mechanics)


def _solved_apart(derivation: Derivation, solved: Callable[[Problem], Motion]) -> Motion:
    """A motion worked out in absolute angles.

    There G keeps the inertias of bodies apart: that of a crank holds nothing of what the links behind it carry.  They
    are so on a graph of their own and brought here as they stand: beside each other equal functions are one node.
    """
    own = derivation.mechanics
    apart = own.apart() if own.change is not None else in_absolute_angles(own.model) or own.apart()
    problem, completed = Problem(apart, ()), completed_multipliers(apart)
    made = solved(problem)
    # symbols of absolute angles stay where these are the coordinates of this derivation
    made = replace(made, multipliers=completed(made.multipliers))
    made = motion_brought_back(own.graph, apart if own.change is None else None, made)
    apart.graph.dissolve()
    return made


def _minor(derivation: Derivation) -> Motion:
    if derivation.mechanics.model.rough:
        return rough_by_minors(derivation)
    made = _solved_apart(derivation, lambda problem: minor_motion(problem).motion)
    return replace(made, guards=(*derivation.space.guards, *made.guards))


def _schur_qr(derivation: Derivation, refining: bool = False) -> Motion:
    if derivation.mechanics.model.rough:
        return rough_by_elimination(derivation, refining)
    rank = derivation.generic.rank

    def solved(problem: Problem) -> Motion:
        columns_apart = apart(problem)
        if columns_apart is None:
            return schur_qr(problem, rank, refining=refining)
        return columns_apart.brought_back(schur_qr(columns_apart, rank, columns_apart.factor, refining))

    return _solved_apart(derivation, solved)


def _nullspace(derivation: Derivation) -> Motion:
    if derivation.mechanics.model.rough:
        return rough_by_basis(derivation)
    inertia, completed = derivation.inertia, completed_multipliers(derivation.mechanics)
    made = nullspace(Problem(derivation.mechanics, derivation.space.guards), derivation.space, inertia)
    return replace(made, multipliers=completed(made.multipliers))


def along_space(solved: Callable[[Problem, NullSpace], Motion]) -> Callable[[Derivation], Motion]:
    """What is solved along a null space, with the multipliers of rows that hold lengths."""

    def made(derivation: Derivation) -> Motion:
        completed = completed_multipliers(derivation.mechanics)
        motion = solved(Problem(derivation.mechanics, derivation.space.guards), derivation.space)
        return replace(motion, multipliers=completed(motion.multipliers))

    return made


def nullspace(problem: Problem, space: NullSpace, inertia: ConstrainedInertia) -> Motion:
    """q_ddot = K (f + G B^+ a) - B^+ a, lambda = (B^+)^T (f - G q_ddot), with one step of refinement.

    It needs G positive definite on ker B only.  Both expressions lose what masses are apart by, in f - G q_ddot most of
    all; what the equations still ask for is solved for once more.
    """

    def solve(f: Vector, c: Vector) -> tuple[Vector, Vector]:
        lifted = space.lift(c)
        pushed = matvec(problem.graph, problem.mass_matrix, lifted)
        along = inertia.solve(subtract_vectors(f, pushed))
        q_ddot = tuple(x + y for x, y in zip(along, lifted, strict=True))
        return q_ddot, reactions(problem, space, f, q_ddot)

    asked = tuple(-a for a in problem.bias)
    first = solve(problem.force, asked)
    left_over = of_motion(problem.graph, problem.mass_matrix, problem.rows, problem.force, asked)
    accelerations, multipliers = refined(problem.graph, first, left_over, solve)
    return Motion(accelerations, multipliers, (*space.guards, *_own(space, inertia)))


def _own(space: NullSpace, inertia: ConstrainedInertia) -> tuple[Guard, ...]:
    return tuple(guard for guard in inertia.guards if guard not in space.guards)


def reactions(problem: Problem, space: NullSpace, force: Vector, accelerations: Vector) -> Vector:
    """lambda = (B^+)^T (f - G q_ddot)."""
    inertial = matvec(problem.graph, problem.mass_matrix, accelerations)
    return space.lift_transposed(subtract_vectors(force, inertial))


MINOR: Method = AlongNullSpace(
    _minor,
    "its denominator is the determinant of the equations of motion",
    _many_directions,
    _by_minors,
    grows=True,
    rough=True,
)
SCHUR_QR: Method = AlongNullSpace(_schur_qr, POSITIVE, offered=_by_elimination, free=True, rough=True)
SCHUR_QR_REFINED: Method = AlongNullSpace(
    partial(_schur_qr, refining=True), POSITIVE, constraints, free=True, rough=True
)
NULLSPACE: Method = AlongNullSpace(
    _nullspace, "its pivots are those of G along the constraints", constraints, _by_basis, orthonormal=True, rough=True
)
