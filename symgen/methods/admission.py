"""Where a method is valid: a theorem, or a proof for each of its denominators and pivots, or else a search."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from symgen.methods.system import MethodInput
from symgen.records import dataclass
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.transplant import transplanted
from symgen.validity.formula import formula, quoted
from symgen.validity.proof import Proof
from symgen.validity.resolution import distinguishable
from symgen.validity.search import SEARCH_STARTS, ZeroSearch

if TYPE_CHECKING:
    from symgen.methods.method import Candidate
    from symgen.methods.workspace import Workspace

# Decimals of a state in a message.
DECIMALS = 6
LOST = "a denominator is a small difference of large terms, which single precision takes for zero at regular states"
FAILS = "this method is singular where"


@dataclass(frozen=True, slots=True)
class Singular:
    """A denominator, as text, that vanishes at a regular state: coordinates (and parameters) rounded for reading."""

    where_zero: str
    state: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class Validity:
    """How many denominators are proved harmless, how many were searched in vain, and which are singular.

    `theorem` says why none has to be looked at, where that is known of a method as a whole.  `lost` says that a
    denominator is so small among its terms that single precision could not tell it from zero anywhere.
    """

    proved: int
    searched: int
    singular: tuple[Singular, ...]
    theorem: str = ""
    lost: bool = False

    @property
    def admitted(self) -> bool:
        """Whether it is valid wherever the ranks of B and M~ are what they generically are, in float32 too."""
        return not self.singular and not self.lost

    @property
    def explanation(self) -> str:
        """One sentence for the report, derivation.json and the terminal."""
        if self.singular:
            places = " or ".join(f"{quoted(entry.where_zero)} = 0" for entry in self.singular)
            return f"{FAILS} {places}, although B and M~ keep their ranks"
        if self.lost:
            return LOST
        if self.theorem:
            return self.theorem
        parts = []
        if self.proved:
            parts.append(f"{self.proved} proved to vanish only where a rank drops")
        if self.searched:
            parts.append(f"{self.searched} searched for other zeros from {SEARCH_STARTS} starts without finding one")
        return f"denominators and pivots: {', '.join(parts)}" if parts else "nothing is divided by"


def proof_for(system: MethodInput, measures: Sequence[Scalar]) -> Proof:
    """The rules about a system's scalars; `measures` may live on another graph."""
    return Proof(system.definite, [p.name for p in system.mechanics.model.parameters], measures)


class ByTheorem:
    """A method that is valid at every regular state for a reason that needs no look at its denominators."""

    theorem: str

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """By theorem."""
        del workspace, candidate, first_only
        return Validity(0, 0, (), self.theorem)

    def least_cost(self, system: MethodInput) -> int:
        """Nothing is known before it is built."""
        del system
        return 0


def ranks(workspace: Workspace, candidate: Candidate) -> list[Scalar]:
    """Denominators that vanish only where a rank drops, by theorem: minors of B and of the inputs."""
    del candidate
    return workspace.minor_measures


def unknown(system: MethodInput) -> int:
    """The least cost of a method of which nothing is known before it is built."""
    del system
    return 0


@dataclass(frozen=True, slots=True)
class OfInputs:
    """A method of u: each denominator is proved harmless, by `measures` that are so by theorem, or searched for zeros.

    `least` is a bound of what it counts.
    """

    solved: Callable[[Workspace], Candidate | str]
    measures: Callable[[Workspace, Candidate], list[Scalar]] = ranks
    least: Callable[[MethodInput], int] = unknown

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """u, or why this system does not have it by this method."""
        del quantity
        return self.solved(workspace)

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """Whether it is valid at every regular state, in single precision too."""
        judgement = validity_of(candidate, self.measures(workspace, candidate), first_only)
        guards = candidate.derived.guards
        if judgement.admitted and guards and not distinguishable(guards, workspace.generic.n, workspace.points):
            return replace(judgement, lost=True)
        return judgement

    def least_cost(self, system: MethodInput) -> int:
        """What it cannot count less than."""
        return self.least(system)


def validity_of(candidate: Candidate, measures: Sequence[Scalar], first_only: bool) -> Validity:
    """What is known of the divisors of a candidate; with `first_only` one singular denominator is enough."""
    system = candidate.system
    proof = proof_for(system, measures)
    left = sorted(proof.unproved(candidate.divisors), key=lambda divisor: divisor.size)
    proved = len(candidate.divisors) - len(left)
    singular: list[Singular] = []
    searched = 0
    if left:
        search = ZeroSearch(system.mechanics, system.generic)
        here = transplanted(system.mechanics.graph, measures)
        for divisor in left:
            if proof.shown(divisor):
                proved += 1  # a rank measure times a pivot that has been named already
                continue
            zero = search.zero_of(divisor)
            if zero is not None:
                state = tuple((name, round(value, DECIMALS)) for name, value in zero.point)
                singular.append(Singular(formula(divisor), state))
                proof.add(factor * measure for measure in here for factor in (divisor, divisor * divisor))
                if first_only:
                    break
            else:
                searched += 1
    return Validity(proved, searched, tuple(singular))
