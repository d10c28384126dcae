"""Rows that hold the lengths of quaternions, taken out of the equations of motion.

Nothing has mass along a quaternion, and the row that holds its length determines the rate of that length alone: it is
known before the others, and the row's multiplier after them.  Where no force acts on the coordinates themselves that
multiplier is exactly 0, which no sum over forces of bodies gives in floating-point arithmetic.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen.dynamics.forms.motion import Motion, Problem
from symgen.dynamics.forms.schur import Factor, along_factor
from symgen.dynamics.guards import Guard
from symgen.dynamics.quaternion_joints import QuaternionJoint
from symgen.graph.matrix import Matrix, Vector, dot
from symgen.graph.scalar import Graph, Scalar
from symgen.ir.kernel import Status
from symgen.records import dataclass


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

    def apart(self, rows: Matrix) -> bool:
        """Whether the other rows do not know the lengths of the quaternions, as none does that asks for attitudes."""
        others = [rows[i] for i in self.others(len(rows))]
        return all(joint.along_length([row[j] for j in joint.parts]).is_zero for joint in self.joints for row in others)


def held_lengths(joints: Sequence[QuaternionJoint], rows: Matrix, graph: Graph) -> HeldLengths | None:
    """The rows of B that hold the lengths of quaternions; None where a length is held by none."""
    found = [next((i for i, row in enumerate(rows) if joint.holds_length(row)), None) for joint in joints]
    known = tuple(i for i in found if i is not None)
    if len(known) < len(found):
        return None
    pairs = zip(joints, known, strict=True)
    slopes = tuple(joint.along_length([rows[i][j] for j in joint.parts]) for joint, i in pairs)
    return HeldLengths(graph, tuple(joints), known, slopes)


class _Rest(Problem):
    """The rows that are left, where the rates of lengths are known."""

    def __init__(self, problem: Problem, chosen: Sequence[int], bias: Vector) -> None:
        self.graph, self.guards, self.n, self.r = problem.graph, problem.guards, problem.n, len(chosen)
        self._rows = tuple(problem.rows[i] for i in chosen)
        self.bias = bias

    @property
    def rows(self) -> Matrix:
        return self._rows


class _Known:
    """A factor whose accelerations take in the known ones."""

    def __init__(self, factor: Factor, known: dict[int, Scalar]) -> None:
        self._factor, self._known = factor, known
        self.pivots, self.guards = factor.pivots, factor.guards

    def lowered(self, b: Sequence[Scalar]) -> Vector:
        return self._factor.lowered(b)

    def raised(self, b: Sequence[Scalar]) -> Vector:
        return self._factor.raised([self._known.get(j, x) for j, x in enumerate(b)])


def along_factor_with_lengths(
    problem: Problem, factor: Factor, columns: Sequence[Vector], force: Vector, held: HeldLengths
) -> Motion:
    """`along_factor` for a factor in which a quaternion's length stands in the place of its scalar part."""
    graph, others = problem.graph, held.others(problem.r)
    places = [joint.length for joint in held.joints]
    # |e| e' . e' and the like: what the rates of the lengths are known to be
    rates = [-problem.bias[i] / slope for i, slope in zip(held.rows, held.slopes, strict=True)]
    felt = {i: [columns[i][j] for j in places] for i in others}
    bias = tuple(problem.bias[i] + dot(graph, felt[i], rates) for i in others)
    rest = _Rest(problem, others, bias)
    along = [_without(graph, columns[i], places) for i in others]
    known = _Known(factor, dict(zip(places, rates, strict=True)))
    motion = along_factor(rest, known, along, _without(graph, force, places))
    multipliers = dict(zip(others, motion.multipliers, strict=True))
    own: dict[int, Scalar] = {}
    for k, (i, j, slope) in enumerate(zip(held.rows, places, held.slopes, strict=True)):
        taken = dot(graph, [felt[other][k] for other in others], motion.multipliers)
        own[i] = (force[j] - taken) / slope
    values = multipliers | own
    guards = tuple(dict.fromkeys((*motion.guards, *held.guards)))
    return Motion(motion.accelerations, tuple(values[i] for i in range(problem.r)), guards)


def _without(graph: Graph, column: Vector, places: Sequence[int]) -> Vector:
    return tuple(graph.zero if j in places else x for j, x in enumerate(column))
