"""What methods start from: a system on a graph of its own.

Every method of u has a fresh graph: two of them are the same function, and a graph holds one node for equal
functions, so on one graph the second would turn into the first.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.matrix import Vector, flatten
from symgen.symbolic.traverse import cost


@dataclass(frozen=True)
class MethodInput:
    """A system about to be solved for u."""

    mechanics: System
    generic: Genericity

    @classmethod
    def fresh(cls, model: Model, generic: Genericity, lumped: bool = False) -> MethodInput:
        """The system on a new graph; `lumped` regroups the parameters of bodies."""
        return cls(System(model, lumped=lumped), generic)

    @cached_property
    def definite(self) -> Definite:
        """What cannot vanish within the parameters' ranges."""
        return Definite(self.mechanics)

    @cached_property
    def given(self) -> Vector:
        """The model's own expressions, whose denominators no method is to blame for."""
        mechanics = self.mechanics
        return (*mechanics.balance, *flatten(mechanics.constraint_jacobian), *flatten(mechanics.control_matrix))

    @cached_property
    def least_cost(self) -> int:
        """What the model's own expressions count, which every method evaluates."""
        return cost(share_angles(self.mechanics.graph, self.given)).weight

    @property
    def driven(self) -> str | None:
        """Why methods that solve the balance exactly do not apply, or None: they need full actuation."""
        if self.mechanics.model.allocation is not None:
            return "the model's `allocation` shares the inputs in another way than by their norm"
        if self.mechanics.model.rough:
            return "friction grows with multipliers, which it does not form"
        return None if self.generic.full_actuation else "it needs inputs that span every admissible direction"

    @property
    def regular(self) -> str | None:
        """Why methods that need independent constraints do not apply, or None."""
        return None if self.generic.rank == self.generic.r else "the constraint rows depend on each other"
