"""N_B by minors and by reflections, each alone: to be asked for by name."""

from __future__ import annotations

from collections.abc import Callable

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.derivation import Derivation
from symgen.methods.method import Candidate, Method
from symgen.methods.quantity import Quantity
from symgen.methods.spaces import along_minors, along_reflections
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.matrix import flatten


@dataclass(frozen=True, slots=True)
class _Projector(ByTheorem):
    """N_B along a null space; `theorem` says why it is valid wherever B keeps its rank."""

    along: Callable[[System, Genericity], Derivation | str]
    theorem: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """N_B (n x n), or why there is none."""
        system = MethodInput.fresh(workspace.model, workspace.generic)
        n, derivation = system.mechanics.n, self.along(system.mechanics, system.generic)
        if not system.mechanics.r:
            return "there are no constraints"
        if isinstance(derivation, str):
            return derivation
        space = derivation.space
        return Candidate(system, Quantity(quantity, (n, n), flatten(space.projector), space.guards))


MINOR: Method = _Projector(along_minors, "its denominator is the sum of the squared minors of B")
HOUSEHOLDER: Method = _Projector(along_reflections, "its pivots vanish only where the rank of B drops")
