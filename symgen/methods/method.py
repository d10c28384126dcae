"""What a method is: one way to compute a quantity, and what comes of it for one system."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Protocol

from symgen.linear_algebra.guards import Guard, tested
from symgen.methods.quantity import Quantity, scalars
from symgen.methods.system import MethodInput
from symgen.records import dataclass
from symgen.runtime.garbage import cleared_with_the_rest
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, topological

if TYPE_CHECKING:
    from symgen.methods.admission import Validity
    from symgen.methods.workspace import Workspace

INPUTS = "inverse_dynamics"


@dataclass(frozen=True, slots=True)
class Candidate:
    """A quantity by the method of a name, or along a null space, or both, on the graph of `system`.

    `divisors` holds what decides on its validity where no theorem does: every scalar that is not a number and by which
    the outputs divide, apart from those that the model's own expressions divide by.
    """

    system: MethodInput
    derived: Quantity
    divisors: tuple[Scalar, ...] = ()
    method: str = ""
    along: str = ""

    @property
    def title(self) -> str:
        """What it is told apart by from the others."""
        return self.along or self.method

    @property
    def weight(self) -> int:
        """Counted cost of a regular state, outputs and tested denominators; angles that are sums follow from others."""
        return counted_weight(self.derived)


class Method(Protocol):
    """One way to compute a quantity, or several together: a file implements it, a row of `table` gives it its name."""

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The quantity, or why this system does not have it by this method."""

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """Whether it is valid at every regular state; with `first_only` one place where it is not is enough."""

    def least_cost(self, system: MethodInput) -> int:
        """What it cannot count less than, known before it is built; 0 where nothing is known."""


def counted_weight(derived: Quantity) -> int:
    """Counted cost of a regular state of a quantity, as for a candidate."""
    needed = scalars(derived)
    return _weight(needed) if needed else 0


@lru_cache(maxsize=16)  # asked for again while candidates are compared
def _weight(needed: tuple[Scalar, ...]) -> int:
    return cost(share_angles(needed[0].graph, needed)).weight


cleared_with_the_rest(_weight.cache_clear)


def solved_for_u(
    system: MethodInput,
    u: Sequence[Scalar],
    guards: Iterable[Guard],
    own: Iterable[Scalar] | None = None,
    harmless: Iterable[Scalar] = (),
) -> Candidate:
    """u as a candidate; `own` are the model's expressions where they are not those of the `system`.

    What is `harmless` may be 0 at regular states: what is divided by it is not taken there.

    Its denominators are read off the graph, so that none can be forgotten.
    """
    given = {*divisors(system.given if own is None else own), *harmless}
    derived = Quantity(INPUTS, (len(u),), tuple(u), tested(guards))
    return Candidate(system, derived, tuple(d for d in divisors(u) if d not in given))


def divisors(outputs: Iterable[Scalar]) -> tuple[Scalar, ...]:
    """Every scalar the outputs divide by, numbers left out, in the order of evaluation."""
    denominators = {
        node.args[1]: None
        for node in topological(outputs)
        if node.op in ("div", "ratio_or_zero") and node.args[1].constant is None
    }
    return tuple(denominators)
