"""Derivatives of u from the equations that determine it, not from the steps that solve them.

u and lambda solve M u + B^T lambda = tau.  With both held, rho = tau - B^T lambda - M u changes by d rho where the
motion or a parameter changes, and u by P d rho: P (m x n) is what a unit of force does to u, for which the steps of the
elimination are gone through backwards once a row.

A redundant input leaves an internal force z, M z + B^T zeta = 0, and u keeps to z^T u = 0.  With M z + B^T zeta called
sigma, and z and zeta held, z^T du = -u^T dz = u^T P d sigma: du = P d rho + z (u^T P d sigma) / (z^T z).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.system import System
from symgen.methods.admission import Validity
from symgen.methods.derivatives.differentiated import along_direction
from symgen.methods.derivatives.held_equations import all_slopes, weighted_slopes
from symgen.methods.inverse_dynamics.core_equations import CoreEquations
from symgen.methods.inverse_dynamics.forces_eliminated import (
    ELIMINATION,
    SymbolsOfTheModel,
    about_to_be_eliminated,
    core_of_stand_ins,
)
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.model.quantities import ROWS, FurtherName
from symgen.records import dataclass
from symgen.symbolic.accumulation import shortest_jacobian
from symgen.symbolic.calculus import gradient
from symgen.symbolic.matrix import Matrix, Vector, dot, flatten, identity, matvec, subtract_vectors, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import substitute

_WEIGHTS: FurtherName = "w_u"
_BY_PARAMETERS = "inverse_dynamics_parameter_jacobian"


@dataclass(frozen=True, slots=True)
class _HeldEquations:
    """d(w^T u) = `shares` d`residuals` where symbols that are `held` stand still, for which there are values.

    w has a row for each input where nothing is weighted.
    """

    residuals: Vector
    shares: Matrix
    held: Mapping[Scalar, Scalar]
    guards: tuple[Guard, ...]


class _ImplicitInputs:
    """J_u, its product with weights, and what follows from that."""

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The derivatives, or why there are none by this method.

        Whether parameters of bodies are regrouped is decided by what counts less here, not by what u counts.
        """
        regrouped = (False, True) if workspace.model.mechanism.has_mass else (False,)
        made = [self._build(workspace, quantity, lumped) for lumped in regrouped]
        candidates = [one for one in made if isinstance(one, Candidate)]
        return min(candidates, key=lambda one: one.weight) if candidates else made[0]

    def _build(self, workspace: Workspace, quantity: str, lumped: bool) -> Candidate | str:
        system = about_to_be_eliminated(workspace, lumped)
        left = core_of_stand_ins(system)
        if isinstance(left, str):
            return left
        core, mechanics, forces = left
        if core.internal > 1:
            return "several inputs are redundant"
        return _derivatives(quantity, system, mechanics, core, forces)

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """Where u is valid by elimination."""
        return ELIMINATION.validity(workspace, candidate, first_only)

    def least_cost(self, system: MethodInput) -> int:
        """Nothing is known before it is built."""
        del system
        return 0


def _held_equations(mechanics: System, core: CoreEquations, forces: Vector, weights: Matrix) -> _HeldEquations:
    graph, columns, solved = mechanics.graph, core.elimination.columns, core.solved()
    real = dict(zip(forces, mechanics.balance, strict=True))
    held: dict[Scalar, Scalar] = {}

    def hold(values: Vector) -> Vector:
        symbols = tuple(graph.stand_in(f"held {len(held) + k}") for k in range(len(values)))
        held.update(zip(symbols, substitute(graph, substitute(graph, values, real), dict(held)), strict=True))
        return symbols

    shares = shortest_jacobian(graph, matvec(graph, weights, solved.u), forces)
    values, first_input = core.all_values(solved.particular, homogeneous=False), len(columns) - len(solved.u)
    if not core.internal:
        return _HeldEquations(_residuals(mechanics.balance, columns, hold(values)), shares, held, solved.guards)
    null = core.all_values(solved.null[0], homogeneous=True)
    z = null[first_input:]
    inverse = 1 / dot(graph, z, z)
    share = dot(graph, z, values[first_input:]) * inverse
    multipliers = tuple(x - y * share for x, y in zip(values, null, strict=True))[:first_input]
    inputs = hold(solved.u)
    rho = _residuals(mechanics.balance, columns, (*hold(multipliers), *inputs))
    along = hold(tuple(gradient(graph, dot(graph, inputs, solved.u), forces)))
    minus_sigma = _residuals((graph.zero,) * mechanics.n, columns, hold(null))
    weighted = matvec(graph, weights, z)
    with_internal = tuple((*row, -x * inverse) for row, x in zip(shares, weighted, strict=True))
    return _HeldEquations((*rho, dot(graph, along, minus_sigma)), with_internal, held, solved.guards)


def _residuals(force: Vector, columns: tuple[Vector, ...], unknowns: Vector) -> Vector:
    return subtract_vectors(force, matvec(unknowns[0].graph, transpose(columns, len(force)), unknowns))


def _derivatives(
    quantity: str, system: MethodInput, mechanics: System, core: CoreEquations, forces: Vector
) -> Candidate:
    graph, back = mechanics.graph, SymbolsOfTheModel(mechanics)
    by = mechanics.parameters if quantity == _BY_PARAMETERS else mechanics.motion
    is_weighted = _WEIGHTS in ROWS[quantity].arguments
    weights = mechanics.further(_WEIGHTS) if is_weighted else identity(graph, mechanics.m)
    equations = _held_equations(mechanics, core, forces, weights)
    slopes = (weighted_slopes if is_weighted else all_slopes)(equations.shares, equations.residuals, by)
    own = back.scalars((*mechanics.balance, *flatten(slopes.own)))
    rows = slopes.with_values(graph, equations.held).rows
    if quantity != _BY_PARAMETERS:
        rows = tuple(_by_the_model(mechanics, row) for row in rows)
    outputs = along_direction(system.mechanics, quantity, back.scalars(flatten(rows)))
    one = solved_for_u(system, outputs, back.guards(equations.guards), own)
    shape = (len(by),) if is_weighted else (mechanics.m, len(by))
    return replace(one, derived=replace(one.derived, name=quantity, shape=shape))


def _by_the_model(mechanics: System, row: Vector) -> Vector:
    """Derivatives by the coordinates that the system stands in, as derivatives by the model's, level by level."""
    change, n = mechanics.change, mechanics.n
    if change is None:
        return row
    return tuple(x for k in range(0, 3 * n, n) for x in change.forces_of_relative(row[k : k + n]))


IMPLICIT: Method = _ImplicitInputs()
