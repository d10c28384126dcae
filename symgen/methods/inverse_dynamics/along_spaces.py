"""u along a null space: minors (Cauchy-Binet over the inputs) and reflections.

Minor: sum_J Delta_J^2 u_J / sum_J Delta_J^2 over the input subsets.  Householder: B^T = Q R, applied to M and tau, then
determinants of the last rows of Q^T M.
"""

from __future__ import annotations

from symgen.methods.admission import OfInputs, ranks
from symgen.methods.derivation import Derivation
from symgen.methods.inverse_dynamics.estimates import least_of_minors, least_of_reflections
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.spaces import along_reflections
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace, denominators
from symgen.symbolic.scalar import Scalar


def _minor(workspace: Workspace) -> Candidate | str:
    if workspace.model.keeps_limits and workspace.model.r:
        return "limits along several directions of internal force are kept in a basis of reflections"
    derivation = workspace.minor
    if isinstance(derivation, str):
        return derivation
    return _along(MethodInput(derivation.mechanics, workspace.generic), derivation)


def _householder(workspace: Workspace) -> Candidate | str:
    system = workspace.fresh()
    derivation = along_reflections(system.mechanics, system.generic)
    return derivation if isinstance(derivation, str) else _along(system, derivation)


def _along(system: MethodInput, derivation: Derivation) -> Candidate:
    u, guards, allocation = derivation.inverse_dynamics, derivation.inverse_dynamics_guards, derivation.allocation
    harmless = () if allocation is None else allocation.harmless_divisors(derivation.mechanics.balance)
    harmless = harmless if derivation.friction is None else derivation.friction.harmless_divisors
    return solved_for_u(system, u, guards, harmless=harmless)


def _pivots(workspace: Workspace, candidate: Candidate) -> list[Scalar]:
    """The pivots of reflections, beside the minors."""
    derivation = along_reflections(candidate.system.mechanics, workspace.generic)
    own = [] if isinstance(derivation, str) else denominators(derivation)
    return [*ranks(workspace, candidate), *own]


MINOR: Method = OfInputs(_minor, least=least_of_minors)
HOUSEHOLDER: Method = OfInputs(_householder, _pivots, least_of_reflections)
