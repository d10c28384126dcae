"""Methods of q_ddot and lambda, which come together: along a null space of B, or each in its own way.

Valid wherever the system has a motion: `minor` (independent rows, delta of 1 or 2), `schur_qr` where G is positive
definite everywhere, else `nullspace`; of bodies also `articulated`.  What they divide by vanishes by theorem only where
B loses rank or the motion is not determined; those that start from the inverse of G need G positive definite in all
directions, which is minimised over configurations and parameters (`validity/definiteness.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction

from symgen.linear_algebra.null_space.null_spaces import has_few_minors
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.admission import DECIMALS, ByTheorem, Singular, Validity
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.motion import Motion
from symgen.methods.graphs import forget_others
from symgen.methods.method import Candidate
from symgen.methods.quantity import resting_on
from symgen.methods.spaces import along_minors, along_reflections
from symgen.methods.system import MethodInput
from symgen.methods.table import Use, methods
from symgen.methods.workspace import Workspace
from symgen.model.quantities import MOTIONS
from symgen.records import dataclass
from symgen.runtime.effort import TooLongError, at_most, worth_trying
from symgen.validity.definiteness import Indefinite, indefinite
from symgen.validity.formula import formula, quoted

# What `minor` is worth in operations where coordinates have several units: it alone does not add what has different
# units up, as norms and reflections do (float32 q_ddot of a robot on wheels: 2 units of error in place of 24).
MINOR_WORTH = Fraction(1, 4)
# What errors that act like turns of joints are worth in operations.
STRUCTURED_WORTH = Fraction(1, 20)
BY_FRAMES = "articulated"
STRUCTURED = "its pivots are inertias met along the joints, positive where G is definite, and those of B"
BY_BODIES_ALONE = "it is for bodies alone with one frame for each coordinate and definite G"
NO_FRICTION = "friction grows with reactions, which it does not form"
POSITIVE = "its pivots are those of G, which is positive definite everywhere, and those of B"


def independent_rows(generic: Genericity) -> str | None:
    """Why methods that need independent constraints do not apply, or None."""
    return "the constraint rows depend on each other" if generic.rank < generic.r else None


def constraints(generic: Genericity) -> str | None:
    """Why methods that need constraints do not apply, or None."""
    return None if generic.r else "there are no constraints"


@dataclass(frozen=True, slots=True)
class AlongNullSpace(ByTheorem):
    """A method of q_ddot and lambda along a null space of B.

    `theorem` says why it is valid at every regular state: those that are `free` of the constraints are so where G is
    positive definite in every direction.  `lacking` says why a system does not have it, `offered` whether it may be
    chosen along the null space of a derivation.  Alone it has an `orthonormal` basis, or the minors of B.  What `grows`
    may double with each row: it takes minors alone, and is given up where there are others.  A `rough` one has friction
    that grows with reactions.
    """

    solved: Callable[[Derivation], Motion]
    theorem: str
    lacking: Callable[[Genericity], str | None] | None = None
    offered: Callable[[Derivation], bool] | None = None
    free: bool = False
    orthonormal: bool = False
    grows: bool = False
    rough: bool = False

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """q_ddot or lambda on a graph that both have in common, or why the system does not have them so."""
        return _shared(workspace, self, self._alone, quantity)

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """A theorem, or the state at which G is not definite."""
        del workspace, first_only
        pivot = indefinite(candidate.system.mechanics) if self.free else None
        singular = () if pivot is None else (_singular(candidate.system.mechanics, pivot),)
        return Validity(0, 0, singular, "" if singular else self.theorem)

    def _alone(self, workspace: Workspace) -> tuple[System, Motion] | str:
        generic = workspace.generic
        if workspace.model.rough and not self.rough:
            return NO_FRICTION
        if self.lacking is not None and (reason := self.lacking(generic)):
            return reason
        mechanics = System(workspace.model)
        few = has_few_minors(mechanics.constraint_jacobian, generic.rank) and not self.orthonormal
        along = (along_minors if few or self.grows else along_reflections)(mechanics, generic)
        return along if isinstance(along, str) else (mechanics, self.solved(along))


@dataclass(frozen=True, slots=True)
class WithoutNullSpace(ByTheorem):
    """A method of q_ddot and lambda that needs no null space, and brings its own system."""

    solved: Callable[[Workspace], tuple[System, Motion] | str]
    theorem: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """q_ddot or lambda on a graph that both have in common, or why the system does not have them so."""
        return NO_FRICTION if workspace.model.rough else _shared(workspace, self, self.solved, quantity)


def motions_along(derivation: Derivation) -> dict[str, Motion]:
    """Those that may be chosen by themselves along the null space of a derivation, on its graph."""
    offered: dict[str, AlongNullSpace] = {}
    for row in methods(MOTIONS[0], Use.CHOSEN):
        one = row.load()
        if isinstance(one, AlongNullSpace) and one.offered is not None and one.offered(derivation):
            offered[row.name] = one
    motions: dict[str, Motion] = {}
    for name, one in offered.items():
        if not one.grows or len(offered) == 1:
            motions[name] = one.solved(derivation)
            continue
        with suppress(TooLongError), at_most(worth_trying(0)):
            motions[name] = one.solved(derivation)
    if derivation.generic.rank:
        return motions
    # rows that hold nothing press on nothing
    still = (derivation.graph.zero,) * derivation.r
    return {name: replace(one, multipliers=still) for name, one in motions.items()}


def motions_alone() -> list[str]:
    """The names of those that may be chosen by themselves and need no null space."""
    return [row.name for row in methods(MOTIONS[0], Use.CHOSEN) if not isinstance(row.load(), AlongNullSpace)]


def _shared(
    workspace: Workspace, key: object, solved: Callable[[Workspace], tuple[System, Motion] | str], quantity: str
) -> Candidate | str:
    """One of both quantities; what was solved stays in the workspace for the other one."""
    if key not in workspace.motions:
        solution = solved(workspace)
        workspace.motions[key] = solution if isinstance(solution, str) else _kept(workspace.generic, *solution)
    kept = workspace.motions[key]
    return kept if isinstance(kept, str) else kept[quantity]


def _kept(generic: Genericity, mechanics: System, made: Motion) -> dict[str, Candidate]:
    """q_ddot, and lambda where there are constraints, and nothing else on their graph."""
    both = {name: resting_on(made.guards, name, made.part(name)) for name in MOTIONS[: 1 + bool(generic.r)]}
    forget_others(mechanics, both.values())
    system = MethodInput(mechanics, generic)
    return {name: Candidate(system, quantity, made.divisors) for name, quantity in both.items()}


def failing_motions(mechanics: System) -> tuple[tuple[str, str], ...]:
    """The methods of q_ddot and lambda that fail at regular states of a system, and where."""
    pivot = indefinite(mechanics)
    if pivot is None:
        return ()
    why = Validity(0, 0, (_singular(mechanics, pivot),)).explanation
    made = ((row.name, row.load()) for row in methods(MOTIONS[0]))
    return tuple((name, why) for name, one in made if isinstance(one, AlongNullSpace) and one.free)


def one_unit(mechanics: System) -> bool:
    """Whether all coordinates are angles in one unit, or lengths in one unit."""
    return len({(c.unit, c.is_angle) for c in mechanics.model.coordinates}) == 1


def cost_factor(name: str, mechanics: System) -> Fraction:
    """The factor by which the counted cost of a method is taken."""
    if name == BY_FRAMES:
        return 1 - STRUCTURED_WORTH
    return 1 - MINOR_WORTH * (name == "minor" and not one_unit(mechanics))


def _singular(mechanics: System, indefinite: Indefinite) -> Singular:
    """In words: the pivot of G is the inertia a coordinate has when those before it are free."""
    coordinate = mechanics.model.coordinates[indefinite.coordinate].name
    pivot = f"the pivot of {coordinate} in G"
    if not indefinite.pivot.is_zero:
        pivot += f", {quoted(formula(indefinite.pivot))}"
    return Singular(pivot, tuple((name, round(value, DECIMALS)) for name, value in indefinite.state))
