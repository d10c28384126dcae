"""Whether a form may be chosen by itself: a proof for each of its denominators and pivots, or else a search."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.methods.form import Method
from symgen.methods.system import MethodInput
from symgen.records import dataclass
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.transplant import transplanted
from symgen.validity.formula import formula
from symgen.validity.proof import Proof
from symgen.validity.search import STARTS, ZeroSearch

DECIMALS = 6  # of a state in a message
LOST = "a denominator is a small difference of large terms, which single precision takes for zero at regular states"
FAILS = "this form is singular where"


@dataclass(frozen=True, slots=True)
class Singular:
    """A denominator, as text, that vanishes at a regular state: coordinates (and parameters) rounded for reading."""

    where_zero: str
    state: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class Verdict:
    """How many denominators are proved harmless, how many were searched in vain, and which are singular.

    `theorem` says why none has to be looked at, where that is known of a form as a whole.  `lost` says that a
    denominator is so small among its terms that single precision could not tell it from zero anywhere.
    """

    proved: int
    searched: int
    singular: tuple[Singular, ...]
    theorem: str = ""
    lost: bool = False

    @property
    def admitted(self) -> bool:
        """Whether the form is valid wherever the ranks of B and M~ are what they generically are, in float32 too."""
        return not self.singular and not self.lost

    @property
    def explanation(self) -> str:
        """One sentence for the report, derivation.json and the terminal."""
        if self.singular:
            places = " or ".join(f"{entry.where_zero} = 0" for entry in self.singular)
            return f"{FAILS} {places}, although B and M~ keep their ranks"
        if self.lost:
            return LOST
        if self.theorem:
            return self.theorem
        parts = []
        if self.proved:
            parts.append(f"{self.proved} proved to vanish only where a rank drops")
        if self.searched:
            parts.append(f"{self.searched} searched for other zeros from {STARTS} starts without finding one")
        return f"denominators and pivots: {', '.join(parts)}" if parts else "nothing is divided by"


def proof_for(system: MethodInput, measures: Sequence[Scalar]) -> Proof:
    """The rules about a system's scalars; `measures` may live on another graph."""
    return Proof(system.definite, [p.name for p in system.mechanics.model.parameters], measures)


def verdict(system: MethodInput, form: Method, measures: Sequence[Scalar], first_only: bool = False) -> Verdict:
    """The verdict on a form of `system`; with `first_only` one singular denominator is enough."""
    proof = proof_for(system, measures)
    left = sorted(proof.unproved(form.divisors), key=lambda divisor: divisor.size)
    proved = len(form.divisors) - len(left)
    singular: list[Singular] = []
    searched = 0
    if left:
        search = ZeroSearch(system.mechanics, system.generic)
        here = transplanted(system.mechanics.graph, measures)
        for divisor in left:
            if proof.shown(divisor):
                proved += 1  # a rank measure times a pivot that has been named already
                continue
            found = search.zero_of(divisor)
            if found is not None:
                state = tuple((name, round(float(value), DECIMALS)) for name, value in found.point)
                singular.append(Singular(formula(divisor), state))
                proof.add(factor * measure for measure in here for factor in (divisor, divisor * divisor))
                if first_only:
                    break
            else:
                searched += 1
    return Verdict(proved, searched, tuple(singular))
