"""Rows that hold the lengths of quaternions, taken out of the equations of motion.

Nothing has mass along a quaternion, and the row that holds its length determines the rate of that length alone: it is
known before the others, and the row's multiplier after them.  Where no force acts on the coordinates themselves that
multiplier is exactly 0, which no sum over forces of bodies gives in floating-point arithmetic.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.refinement import Solution
from symgen.mechanics.rigid_bodies.quaternion_joints import QuaternionJoint, quaternion_joint
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.motion import Problem
from symgen.methods.forward_dynamics.schur import MassMatrixFactor, SchurElimination
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.walk import names_in
from symgen.model.mechanism import Frame, Quaternion
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot


@dataclass(frozen=True, slots=True)
class HeldLengths:
    """For each quaternion the number of the row that holds its length, and what that row does to it: b.e."""

    graph: Graph
    joints: tuple[QuaternionJoint, ...]
    rows: tuple[int, ...]
    slopes: Vector

    @property
    def guards(self) -> tuple[Guard, ...]:
        """A quaternion of length 0 is no attitude, and the row that holds its length is 0."""
        squares = (joint.along_length(joint.values) for joint in self.joints)
        return tuple(Guard(Status.CONSTRAINT_RANK, square, 2, scale=self.graph.one) for square in squares)

    def others(self, count: int) -> list[int]:
        """The rows that are left of so many."""
        return [i for i in range(count) if i not in self.rows]

    def multipliers(self, mechanics: System) -> Callable[[Vector], Vector]:
        """What gives multipliers the components of rows that hold lengths, from those of the others.

        To be called before anything is solved: what is exactly 0 must stand in the graph first.
        """
        rows = mechanics.constraint_jacobian
        equations = []
        for joint, i, slope in zip(self.joints, self.rows, self.slopes, strict=True):
            force = mechanics.given.along(dict(zip(joint.parts, joint.values, strict=True)))
            couplings = {k: joint.along_length([rows[k][j] for j in joint.parts]) for k in self.others(len(rows))}
            equations.append((i, force, {k: x for k, x in couplings.items() if not x.is_zero}, slope))

        def completed(given: Vector) -> Vector:
            values = list(given)
            for i, force, couplings, slope in equations:
                taken = self.graph.sum(x * given[k] for k, x in couplings.items())
                values[i] = (force - taken) / slope
            return tuple(values)

        return completed

    def apart(self, rows: Matrix) -> bool:
        """Whether the other rows do not know the lengths of the quaternions, as none does that asks for attitudes."""
        others = [rows[i] for i in self.others(len(rows))]
        return all(joint.along_length([row[j] for j in joint.parts]).is_zero for joint in self.joints for row in others)


def held_lengths(joints: Sequence[QuaternionJoint], rows: Matrix, graph: Graph) -> HeldLengths | None:
    """The rows of B that hold the lengths of quaternions; None where a length is held by none."""
    holders = [next((i for i, row in enumerate(rows) if joint.holds_length(row)), None) for joint in joints]
    known = tuple(i for i in holders if i is not None)
    if len(known) < len(holders):
        return None
    pairs = zip(joints, known, strict=True)
    slopes = tuple(joint.along_length([rows[i][j] for j in joint.parts]) for joint, i in pairs)
    return HeldLengths(graph, tuple(joints), known, slopes)


def completed_multipliers(mechanics: System) -> Callable[[Vector], Vector]:
    """What completes multipliers by any method by those of rows that hold lengths, see `HeldLengths.multipliers`.

    Only where nothing but the attitudes of frames depends on a quaternion: then bodies do no work on its length.
    """
    energy, mechanism = mechanics.model.kinetic_energy, mechanics.model.mechanism
    turned = [frame for frame in mechanism.frames if isinstance(frame.rotation, Quaternion)]
    if not turned or not isinstance(energy, Number) or energy.value != 0:
        return lambda given: given
    within: dict[str, set[str]] = {}
    for definition in mechanics.model.definitions:
        within[definition.name] = set(_names((definition.value,), within))
    used = Counter(name for frame in mechanism.frames for name in set(_names(_placing(frame), within)))
    used.update(rotor.coordinate for rotor in mechanism.rotor_inertias)
    anything: dict[int, Vector] = dict.fromkeys(range(mechanics.n), ())
    all_joints = (quaternion_joint(mechanics.bodies, frame.name, anything) for frame in turned)
    names = [c.name for c in mechanics.model.coordinates]
    joints = [joint for joint in all_joints if joint is not None and all(used[names[j]] == 1 for j in joint.parts)]
    rows = mechanics.constraint_jacobian
    held = held_lengths([joint for joint in joints if any(map(joint.holds_length, rows))], rows, mechanics.graph)
    return held.multipliers(mechanics) if held is not None else lambda given: given


def _placing(frame: Frame) -> tuple[Expression, ...]:
    rotation = frame.rotation
    turns = rotation.parts if isinstance(rotation, Quaternion) else tuple(turn.angle for turn in rotation)
    return (*frame.translation, *turns)


def _names(expressions: Sequence[Expression], within: Mapping[str, set[str]]) -> Iterator[str]:
    """The names in expressions, and those that definitions among them are made of."""
    for expression in expressions:
        for name in names_in(expression):
            yield name.name
            yield from within.get(name.name, ())


class _Rest(Problem):
    """The rows that are left."""

    def __init__(self, problem: Problem, chosen: Sequence[int]) -> None:
        self.graph, self.n, self.r = problem.graph, problem.n, len(chosen)
        self._rows = tuple(problem.rows[i] for i in chosen)

    @property
    def rows(self) -> Matrix:
        return self._rows


class LengthsApart:
    """Equations of motion along a factor in which a quaternion's length stands in the place of its scalar part.

    `columns` are those of A, with what rows do to lengths in these places; `rank` is that of all rows.
    """

    def __init__(
        self, problem: Problem, factor: MassMatrixFactor, columns: Sequence[Vector], held: HeldLengths, rank: int
    ) -> None:
        self._graph, self._factor, self._held, self._count = problem.graph, factor, held, problem.r
        self._others = held.others(problem.r)
        self._places = [joint.length for joint in held.joints]
        self._couplings = {i: [columns[i][j] for j in self._places] for i in self._others}
        along = [self._without_lengths(columns[i]) for i in self._others]
        self._rest = SchurElimination(_Rest(problem, self._others), factor, along, rank - len(held.rows))

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The denominators."""
        return tuple(dict.fromkeys((*self._rest.guards, *self._held.guards)))

    def solve(
        self, force: Vector, bias: Vector, refining: bool, raised: Callable[[Vector], Vector] | None = None
    ) -> Solution:
        """q_ddot and lambda for L^-1 f and a; `raised` leads to q_ddot if that of the factor does not."""
        graph, held = self._graph, self._held
        # the rates of the lengths are known
        rates = [-bias[i] / slope for i, slope in zip(held.rows, held.slopes, strict=True)]
        rest = tuple(bias[i] + dot(graph, self._couplings[i], rates) for i in self._others)
        x, multipliers = self._rest.by_columns(self._without_lengths(force), rest, refining)
        known = dict(zip(self._places, rates, strict=True))
        pairs = enumerate(zip(x, self._rest.weights, strict=True))
        weighted = tuple(known.get(j, entry * w) for j, (entry, w) in pairs)
        by_row = dict(zip(self._others, multipliers, strict=True))
        for k, (i, j, slope) in enumerate(zip(held.rows, self._places, held.slopes, strict=True)):
            taken = dot(graph, [self._couplings[other][k] for other in self._others], multipliers)
            by_row[i] = (force[j] - taken) / slope
        return (raised or self._factor.raised)(weighted), tuple(by_row[i] for i in range(self._count))

    def _without_lengths(self, column: Vector) -> Vector:
        return tuple(self._graph.zero if j in self._places else x for j, x in enumerate(column))
