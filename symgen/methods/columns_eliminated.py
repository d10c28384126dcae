"""The regressor and its base by elimination: columns are loads like any other, and what solves for u solves for them.

u of stand-ins for the load is linear in these.  Either each column takes their place, or P (m x n), what a unit of each
does to u, is multiplied with the columns: the first is shorter where a column loads little, the second where many do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from symgen.methods.admission import Validity
from symgen.methods.inverse_dynamics.forces_eliminated import ELIMINATION, SymbolsOfTheModel, core_of_stand_ins
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.regressor import base_columns, inertial_columns
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.model.quantities import BASE_REGRESSOR
from symgen.symbolic.calculus import jacobian
from symgen.symbolic.matrix import Matrix, Vector, flatten, matmul, transpose
from symgen.symbolic.traverse import substitute


class _ColumnsEliminated:
    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """The shorter of both, each on a graph of its own: beside nodes of one the other would be longer."""
        made = [_built(workspace, quantity, rows_of) for rows_of in (_one_by_one, _by_units)]
        candidates = [one for one in made if isinstance(one, Candidate)]
        return min(candidates, key=lambda one: one.weight) if candidates else made[0]

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """Where u is valid by elimination."""
        return ELIMINATION.validity(workspace, candidate, first_only)

    def least_cost(self, system: MethodInput) -> int:
        """Nothing is known before it is built."""
        del system
        return 0


def _one_by_one(u: Vector, forces: Vector, columns: Matrix) -> Matrix:
    """u with each of the columns in the place of the forces."""
    graph = forces[0].graph
    made = tuple(tuple(substitute(graph, u, dict(zip(forces, column, strict=True)))) for column in columns)
    return transpose(made, len(u))


def _by_units(u: Vector, forces: Vector, columns: Matrix) -> Matrix:
    """What a unit of each force does to u, times the columns."""
    graph = forces[0].graph
    return matmul(graph, jacobian(graph, u, forces), transpose(columns, len(forces)), len(columns))


def _built(
    workspace: Workspace, quantity: str, rows_of: Callable[[Vector, Vector, Matrix], Matrix]
) -> Candidate | str:
    system = MethodInput.fresh(workspace.model, workspace.generic)
    left = core_of_stand_ins(system)
    if isinstance(left, str):
        return left
    core, mechanics, forces = left
    solved, change, back = core.solved(), mechanics.change, SymbolsOfTheModel(mechanics)
    given = (base_columns if quantity == BASE_REGRESSOR else inertial_columns)(system.mechanics)
    columns = given if change is None else tuple(map(change.forces, given))
    outputs = back.scalars(flatten(rows_of(solved.u, forces, columns)))
    one = solved_for_u(system, outputs, back.guards(solved.guards), back.scalars(flatten(columns)))
    return replace(one, derived=replace(one.derived, name=quantity, shape=(mechanics.m, len(columns))))


COLUMNS_ELIMINATED: Method = _ColumnsEliminated()
