"""What the methods of one model share: where they begin, and which denominators vanish only where a rank drops."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from symgen.mechanics.free_fall import falls_freely
from symgen.mechanics.genericity import Genericity, configurations
from symgen.mechanics.system import System
from symgen.mechanics.workless_forces import (
    WITHOUT_WORKLESS,
    WorklessForces,
    without_workless_forces,
    workless_forces,
)
from symgen.methods.derivation import Derivation
from symgen.methods.spaces import along_minors
from symgen.methods.system import MethodInput
from symgen.model.model import Model
from symgen.model.quantities import MULTIPLIERS
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost

if TYPE_CHECKING:
    from symgen.methods.method import Candidate

# Share of operations that regrouping parameters has to take off: they are computed at each call.
LUMPING_GAIN = Fraction(1, 20)


class Workspace:
    """One model about to be derived by several methods, each on a graph of its own."""

    def __init__(self, model: Model, generic: Genericity) -> None:
        self.model = model
        self.generic = generic
        # q_ddot and lambda come together: what was solved for one of them, by method
        self.motions: dict[object, dict[str, Candidate] | str] = {}

    def fresh(self) -> MethodInput:
        """The system on a new graph."""
        return MethodInput.fresh(self.model, self.generic, self.lumped)

    @cached_property
    def lumped(self) -> bool:
        """Whether the motion equations of the bodies are shorter with their parameters regrouped."""
        if not self.model.mechanism.has_mass:
            return False
        apart, together = (cost(System(self.model, lumped=lumped).balance).weight for lumped in (False, True))
        return together <= apart * (1 - LUMPING_GAIN)

    @cached_property
    def minor(self) -> Derivation | str:
        """The derivation along minors, which also tells where ranks drop."""
        system = self.fresh()
        return along_minors(system.mechanics, system.generic)

    @cached_property
    def relieved(self) -> Workspace:
        """Of what does not depend on forces that the rows bear: without these, or the same where there are none."""
        workless = workless_forces(self.model, self.generic)
        return Workspace(without_workless_forces(self.model, workless), self.generic) if workless else self

    @cached_property
    def weightless(self) -> Workspace:
        """Of what does not depend on weights where the system falls freely, or the same where it does not."""
        if not falls_freely(self.model):
            return self
        return Workspace(without_workless_forces(self.model, WorklessForces(weights=True)), self.generic)

    def of(self, quantity: str) -> Workspace:
        """The one without the forces that a quantity does not depend on."""
        if quantity == MULTIPLIERS:
            return self.weightless
        return self.relieved if quantity in WITHOUT_WORKLESS else self

    @cached_property
    def points(self) -> list[dict[str, float]]:
        """Configurations on V at which denominators are looked at."""
        return configurations(System(self.model))

    @property
    def minor_measures(self) -> list[Scalar]:
        """Determinants that vanish only where a rank drops."""
        return [] if isinstance(self.minor, str) else denominators(self.minor)


def denominators(derivation: Derivation) -> list[Scalar]:
    """What u along a derivation divides by, which vanishes by theorem only where a rank drops."""
    guards = (*derivation.actuation_guards, *derivation.space.guards)
    return [*(guard.denominator for guard in guards), *derivation.input_measures]
