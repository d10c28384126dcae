"""B_G^+ (17) and N_{B,G} (19) as accelerations: what a row asks for, or a force causes, solved for and refined.

The columns of B_G^+ are the solutions of G x + B^T lambda = 0, B x = e_k; those of N_{B,G} the solutions of
G x + B^T lambda = G e_j, B x = 0.  I - K G and K G, by any K, lose digits that these keep.
"""

from __future__ import annotations

from collections.abc import Callable

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.admission import ByTheorem
from symgen.methods.forward_dynamics.absolute import in_absolute_angles, motion_brought_back
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import BY_BODIES_ALONE, POSITIVE, STRUCTURED
from symgen.methods.forward_dynamics.schur import SchurQR
from symgen.methods.graphs import GraphCopy
from symgen.methods.method import Candidate, Method
from symgen.methods.quantity import Quantity
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.matrix import Matrix, flatten, identity, matvec, transpose
from symgen.symbolic.scalar import Scalar
from symgen.validity.definiteness import positive_definite

PSEUDOINVERSE, PROJECTOR = "weighted_pseudoinverse", "weighted_nullspace_projector"


def weighted_projection(
    mechanics: System, generic: Genericity, quantity: str, before: tuple[Guard, ...]
) -> tuple[Matrix, tuple[Guard, ...]] | None:
    """One of both quantities on the graph of `mechanics` with its guards; None where G is not positive definite.

    `before` tell where B loses rank.  G is factorised in absolute angles, as for the method of the same name of q_ddot.
    """
    if not mechanics.r or not positive_definite(mechanics):
        return None
    changed = in_absolute_angles(mechanics.model)
    there = changed or mechanics.apart()
    solver = SchurQR(Problem(there, ()), generic.rank)
    motions = [motion_brought_back(mechanics.graph, changed, motion) for motion in _motions(there, solver, quantity)]
    guards = tuple(dict.fromkeys((*before, *(guard for motion in motions for guard in motion.guards))))
    there.graph.dissolve()
    return transpose(tuple(motion.accelerations for motion in motions), mechanics.n), guards


def projection_of_bodies(
    mechanics: System, generic: Genericity, quantity: str, before: tuple[Guard, ...]
) -> tuple[Matrix, tuple[Guard, ...]] | None:
    """The same from body to body, refined by their equations; None for a system without articulated inertias.

    A column of N_{B,G} is e_j less what B e_j asks for.
    """
    from symgen.methods.forward_dynamics.articulated import body_equations  # models given by energies have none

    body_system = body_equations(mechanics.model, generic, turned=False) if mechanics.r else None
    if body_system is None:
        return None
    there, equations = body_system
    n, r = there.n, there.r
    if quantity == PSEUDOINVERSE:
        columns = [equations.answered(unit) for unit in identity(there.graph, r)]
    else:
        rows = transpose(there.constraint_jacobian, n)
        parts = [equations.answered(tuple(-x for x in column)) for column in rows]
        units = identity(there.graph, n)
        columns = [tuple(x + y for x, y in zip(*pair, strict=True)) for pair in zip(units, parts, strict=True)]
    moved = GraphCopy(mechanics.graph)
    guards = tuple(dict.fromkeys((*before, *moved.guards(equations.guards))))
    brought = tuple(map(moved.scalars, columns))
    there.graph.dissolve()
    return transpose(brought, n), guards


@dataclass(frozen=True, slots=True)
class _Eliminated(ByTheorem):
    """A weighted projection as accelerations; `solved` gives the matrix with what it depends on."""

    solved: Callable[[System, Genericity, str, tuple[Guard, ...]], tuple[Matrix, tuple[Guard, ...]] | None]
    theorem: str
    missing: str

    def build(self, workspace: Workspace, quantity: str) -> Candidate | str:
        """B_G^+ (n x r) or N_{B,G} (n x n) on a graph of its own, or why there is none."""
        system = MethodInput.fresh(workspace.model, workspace.generic)
        mechanics, generic = system.mechanics, system.generic
        solution = self.solved(mechanics, generic, quantity, reflected_rows(mechanics, generic).guards)
        if solution is None:
            return self.missing
        matrix, guards = solution
        return Candidate(system, Quantity(quantity, (len(matrix), len(matrix[0])), flatten(matrix), guards))


def _motions(mechanics: System, solver: SchurQR, quantity: str) -> list[Motion]:
    """The solution for each right-hand side."""
    graph, n, r = mechanics.graph, mechanics.n, mechanics.r
    nothing: tuple[tuple[Scalar, ...], tuple[Scalar, ...]] = (graph.zero,) * n, (graph.zero,) * r
    if quantity == PSEUDOINVERSE:
        return [solver.motion(nothing[0], tuple(-x for x in unit), refining=True) for unit in identity(graph, r)]
    units = identity(graph, n)
    if mechanics.change is not None:
        units = tuple(map(mechanics.change.absolute, units))
    return [solver.motion(matvec(graph, mechanics.mass_matrix, unit), nothing[1], refining=True) for unit in units]


SCHUR_QR: Method = _Eliminated(weighted_projection, POSITIVE, "G is not positive definite everywhere")
ARTICULATED: Method = _Eliminated(projection_of_bodies, STRUCTURED, BY_BODIES_ALONE)
