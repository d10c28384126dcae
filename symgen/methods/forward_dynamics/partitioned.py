"""q_ddot and lambda with dependent accelerations substituted: coordinate partitioning, where its pivots never vanish.

Rows of B that give one coordinate each, such as the length of a leg, the place of a point, a gear or a rolling wheel,
are solved for it one after the other: q_ddot = T x + s with the accelerations x that are left, and T^T G T x + B'^T l =
T^T (f - G s), B' x = c with the rows that are left, if any.  The multipliers follow backwards from the equations of the
dependent coordinates.  G never has to be definite where the constraints hold it (Wehage and Haug 1982; de Jalon and
Bayo, Kinematic and Dynamic Simulation of Multibody Systems, 5.2).  Closed chains have no coordinates that are
independent everywhere: what is substituted here is divided by nothing that vanishes at a regular state.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import MinorSpace, has_few_minors
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.methods.admission import Validity, validity_of
from symgen.methods.forward_dynamics.absolute import in_absolute_angles, motion_brought_back
from symgen.methods.forward_dynamics.held_lengths import completed_multipliers
from symgen.methods.forward_dynamics.minor_motion import LARGEST_DELTA, minor_motion
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import WithoutNullSpace, constraints, independent_rows
from symgen.methods.forward_dynamics.schur import OrderedCholesky, schur_qr
from symgen.methods.method import Candidate, Method
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matmul, matvec, subtract_vectors, transpose
from symgen.symbolic.scalar import Scalar
from symgen.validity.definiteness import positive_definite

_THEOREM = "its pivots are inertias along the constraints, and entries of B that never vanish"


@dataclass(frozen=True, slots=True)
class Pivot:
    """The row that gives a coordinate, and its entry there."""

    row: int
    column: int
    entry: Scalar


class Partition:
    """Each row of a pivot gives its coordinate by those of the pivots before it and by the others, which are free."""

    def __init__(self, rows: Matrix, pivots: Sequence[Pivot]) -> None:
        self._rows, self.pivots = rows, pivots
        self._graph, self._n = rows[0][0].graph, len(rows[0])
        self._inverses = [1 / pivot.entry for pivot in pivots]
        self.dependent = frozenset(pivot.column for pivot in pivots)
        self.free = [j for j in range(self._n) if j not in self.dependent]
        solved = {pivot.row for pivot in pivots}
        self.left = [i for i in range(len(rows)) if i not in solved]

    @cached_property
    def along(self) -> Matrix:
        """T (n x free), a basis of what these rows leave."""
        none, axes = (self._graph.zero,) * len(self._rows), identity(self._graph, self._n)
        columns = (self.completed([axes[i][j] for j in self.free], none) for i in self.free)
        return transpose(tuple(columns), self._n)

    def completed(self, free: Sequence[Scalar], asked: Sequence[Scalar]) -> Vector:
        """x (n) for which these rows of B give `asked`, with the given free entries."""
        by_column = dict(zip(self.free, free, strict=True))
        for pivot, inverse in zip(self.pivots, self._inverses, strict=True):
            row = self._rows[pivot.row]
            rest = asked[pivot.row] - self._graph.sum(row[j] * x for j, x in by_column.items())
            by_column[pivot.column] = rest * inverse
        return tuple(by_column[j] for j in range(self._n))

    def multipliers(self, force: Sequence[Scalar], left: Mapping[int, Scalar]) -> Vector:
        """lambda (r) with B^T lambda = f for the dependent coordinates, given those of the rows that are left."""
        by_row = dict(left)
        for pivot, inverse in zip(reversed(self.pivots), reversed(self._inverses), strict=True):
            rest = force[pivot.column] - self._graph.sum(
                self._rows[i][pivot.column] * x for i, x in by_row.items()
            )
            by_row[pivot.row] = rest * inverse
        return tuple(by_row[i] for i in range(len(self._rows)))


class Reduced(Problem):
    """The equations of motion of the free coordinates, with the rows that are left."""

    def __init__(self, problem: Problem, partition: Partition) -> None:
        super().__init__(problem.mechanics, ())
        self._problem, self._partition = problem, partition
        self.n, self.r = len(partition.free), len(partition.left)
        self._across = transpose(partition.along, self.n)
        self.asked = tuple(-a for a in problem.bias)
        self._shift = partition.completed((self.graph.zero,) * self.n, self.asked)

    @cached_property
    def mass_matrix(self) -> Matrix:
        """T^T G T."""
        weighted = matmul(self.graph, self._problem.mass_matrix, self._partition.along, self.n)
        return matmul(self.graph, self._across, weighted, self.n)

    @cached_property
    def rows(self) -> Matrix:
        """B' = B_L T of the rows that are left."""
        given = tuple(self._problem.rows[i] for i in self._partition.left)
        return matmul(self.graph, given, self._partition.along, self.n)

    @cached_property
    def force(self) -> Vector:
        """T^T (f - G s)."""
        inertial = matvec(self.graph, self._problem.mass_matrix, self._shift)
        return matvec(self.graph, self._across, subtract_vectors(self._problem.force, inertial))

    @cached_property
    def bias(self) -> Vector:
        """a_L + B_L s of the rows that are left."""
        rows, bias = self._problem.rows, self._problem.bias
        return tuple(bias[i] + dot(self.graph, rows[i], self._shift) for i in self._partition.left)

    def completed(self, made: Motion) -> Motion:
        """The motion of all coordinates, and the multipliers of all rows."""
        graph, partition, given = self.graph, self._partition, self._problem
        accelerations = partition.completed(made.accelerations, self.asked)
        force = tuple(
            f - dot(graph, given.mass_matrix[j], accelerations) if j in partition.dependent else f
            for j, f in enumerate(given.force)
        )
        multipliers = partition.multipliers(force, dict(zip(partition.left, made.multipliers, strict=True)))
        definite = Definite(given.mechanics)
        measured = [one for one in partition.pivots if not definite.holds(one.entry)]
        squares = [dot(graph, row, row) for row in (given.rows[one.row] for one in measured)]
        lengths = [
            Guard(Status.CONSTRAINT_RANK, one.entry * one.entry, 2, scale=square)
            for one, square in zip(measured, squares, strict=True)
        ]
        divisors = tuple(one.entry for one in measured)
        return Motion(accelerations, multipliers, (*lengths, *made.guards), divisors)


def pivots(mechanics: System) -> list[Pivot]:
    """Entries of B that give a coordinate each, none in the column of one that comes later.

    Of those that may be taken, entries that never vanish come first, then columns of the fewest rows and least inertia.
    A length that is a coordinate may do where its range leaves 0 out; an angle's sine vanishes somewhere.
    """
    rows, definite = mechanics.constraint_jacobian, Definite(mechanics)
    coordinates = zip(mechanics.q, mechanics.model.coordinates, strict=True)
    lengths = {q for q, c in coordinates if not c.is_angle and not c.range[0] <= 0 <= c.range[1]}
    def usable(entry: Scalar) -> bool:
        factors = mechanics.graph.products.monomial(entry)[1]
        return not entry.is_zero and all(factor in lengths or definite.holds(factor) for factor in factors)

    entries = [(i, j) for i, row in enumerate(rows) for j, entry in enumerate(row) if usable(entry)]
    if not entries:
        return []
    inertias = [sum(not x.is_zero for x in row) for row in mechanics.mass_matrix]
    holders = [sum(not row[j].is_zero for row in rows) for j in range(mechanics.n)]
    left = sorted((not definite.holds(rows[i][j]), holders[j], inertias[j], i, j) for i, j in entries)
    chosen: list[Pivot] = []
    while left:
        *_, i, j = left[0]
        chosen.append(Pivot(i, j, rows[i][j]))
        solved = {pivot.row for pivot in chosen}
        left = [one for one in left if one[-2] not in solved and rows[i][one[-1]].is_zero]
    return chosen


def _free(problem: Reduced) -> Motion:
    """Accelerations that nothing holds any more."""
    factor = OrderedCholesky(problem)
    halfway = (x / pivot for x, pivot in zip(factor.lowered(problem.force), factor.pivots, strict=True))
    return Motion(factor.raised(tuple(halfway)), (), factor.guards)


def _solved(problem: Reduced) -> Motion | None:
    """By minors where few directions are left, else by elimination; None where that is not valid everywhere."""
    graph, n, r = problem.graph, problem.n, problem.r
    if not r:
        return _free(problem)
    if 1 <= n - r <= LARGEST_DELTA and has_few_minors(problem.rows, r):
        problem.guards = MinorSpace(graph, problem.rows, n, r).guards
        return minor_motion(problem).motion
    if not positive_definite(problem.mechanics):
        return None
    return schur_qr(problem, r)


@dataclass(frozen=True, slots=True)
class Partitioned(WithoutNullSpace):
    """Valid where no entry of B that is divided by vanishes at a regular state, which is searched for."""

    def validity(self, workspace: Workspace, candidate: Candidate, first_only: bool) -> Validity:
        """A theorem where entries are numbers and parameters; else they are searched for zeros."""
        del workspace
        if not candidate.divisors:
            return Validity(0, 0, (), self.theorem)
        return validity_of(candidate, (), first_only)


def _alone(workspace: Workspace) -> tuple[System, Motion] | str:
    if reason := constraints(workspace.generic) or independent_rows(workspace.generic):
        return reason
    mechanics = in_absolute_angles(workspace.model) or System(workspace.model)
    chosen = pivots(mechanics)
    if not chosen:
        return "no row gives a coordinate that can be substituted everywhere"
    completed = completed_multipliers(mechanics)
    problem = Reduced(Problem(mechanics, ()), Partition(mechanics.constraint_jacobian, chosen))
    made = _solved(problem)
    if made is None:
        return "the mass matrix is not shown to be positive definite, and rows are left"
    motion = problem.completed(made)
    motion = replace(motion, multipliers=completed(motion.multipliers))
    if mechanics.change is None:
        return mechanics, motion
    own = System(workspace.model)
    return own, motion_brought_back(own.graph, mechanics, motion)


PARTITIONED: Method = Partitioned(_alone, _THEOREM)
