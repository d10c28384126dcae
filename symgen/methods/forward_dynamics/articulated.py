"""q_ddot and lambda of bodies by articulated inertias: reflections in the metric of G^-1, and G itself never formed.

The forces of the constraints enter as wrenches on the frames that their points belong to, so that the columns of B^T
are brought inwards joint by joint, too; so do weights and what rates take of the bodies.  Operations grow with the
number of frames, and errors stay those of a chain of turns; dense factors lose what cancels between entries of G that
were rounded one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import Enum, auto
from functools import cached_property, partial

from symgen.linear_algebra.refinement import Solution, refined
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.rigid_bodies.articulated_inertias import ArticulatedFactor, Six
from symgen.mechanics.rigid_bodies.bodies import Vector3
from symgen.mechanics.rigid_bodies.newton_euler import frame_motions, inertial_wrenches
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.frame_forces import FrameForces, added_loads
from symgen.methods.forward_dynamics.held_lengths import HeldLengths, LengthsApart, held_lengths
from symgen.methods.forward_dynamics.joint_accelerations import by_joints
from symgen.methods.forward_dynamics.loop_points import LoopPoint, acceleration, loop_points, wrenches
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.methods.forward_dynamics.motions import BY_BODIES_ALONE, STRUCTURED, WithoutNullSpace, constraints
from symgen.methods.method import Method
from symgen.methods.workspace import Workspace
from symgen.model.expressions.expression import Number
from symgen.model.kinematics.triples import applied, transposed, triple
from symgen.model.mechanism import WORLD
from symgen.model.model import Model
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar
from symgen.validity.definiteness import definite_beside_rows
from symgen.validity.local_inertias import definite_along_motion, definite_by_frames


class _SpatialLoops(Problem):
    """Loops in space are accelerated as their points are; each has its rows along the axes of the frame beside it."""

    def __init__(self, mechanics: System, loops: Sequence[tuple[LoopPoint, str]]) -> None:
        super().__init__(mechanics, ())
        self.loops = loops

    @cached_property
    def bias(self) -> Vector:
        return self.bias_at((self.graph.zero,) * self.n)

    def bias_at(self, q_ddot: Vector) -> Vector:
        """B q_ddot + a."""
        mechanics = self.mechanics
        weight = mechanics.working_gravity
        motions = frame_motions(mechanics.bodies, mechanics.qd, q_ddot, weight) if self.loops else {}
        held = [i for loop, _ in self.loops if motions.keys() >= set(loop.frames) for i in loop.rows.values()]
        if len(held) < self.r:
            given = zip(self.rows, mechanics.constraint_acceleration_bias(mechanics.qd), strict=True)
            return self._turned(tuple(a + dot(self.graph, row, q_ddot) for row, a in given), inward=True)
        # nothing else is worked out: the first way to a function is the one that stands in the graph
        by_row = dict[int, Scalar]()
        for loop, axes in self.loops:
            along = acceleration(mechanics, motions, loop, axes)
            by_row |= {i: along[axis] for axis, i in loop.rows.items()}
        return tuple(by_row[i] for i in range(self.r))

    def of_the_model(self, multipliers: Vector) -> Vector:
        """Multipliers of the model's rows from those of the rows along the loops' axes."""
        return self._turned(multipliers, inward=False)

    def _turned(self, values: Vector, inward: bool) -> Vector:
        turned = list(values)
        for loop, frame in self.loops:
            if frame != WORLD:
                axes = self.mechanics.bodies.kinematics.axes(frame)
                three = triple([values[i] for i in loop.rows.values()])
                for i, x in zip(loop.rows.values(), applied(transposed(axes) if inward else axes, three), strict=True):
                    turned[i] = x
        return tuple(turned)


class RefinedBy(Enum):
    """What a solution is put into to solve for what it leaves once more."""

    NOTHING = auto()
    COLUMNS = auto()
    """Those of B^T as they were brought inwards."""
    BODIES = auto()
    """Newton and Euler's equations of the bodies."""


class BodyEquations:
    """G q_ddot + B^T lambda = f, B q_ddot = -a of bodies, solved from body to body.

    With `turned` the rows of loops are taken along the axes that leave most entries out; `guards` are the denominators.
    """

    def __init__(
        self, mechanics: System, factor: ArticulatedFactor, held: HeldLengths, rank: int, turned: bool
    ) -> None:
        self._mechanics, self._factor = mechanics, factor
        forces = FrameForces(mechanics)
        self._forces, self._given = forces.of_rows(), forces.given()
        columns = [factor.lowered(direct, loads) for direct, loads in self._forces]
        loops = list[tuple[LoopPoint, str]]()
        for loop in loop_points(mechanics) if turned else ():
            places = list(loop.rows.values())
            frame, own = _along_best_axes(mechanics, factor, loop, [columns[i] for i in places])
            loads = wrenches(mechanics, loop, frame) if frame != WORLD else [self._forces[i][1] for i in places]
            for i, column, load in zip(places, own, loads, strict=True):
                columns[i], self._forces[i] = column, (self._forces[i][0], load)
            loops.append((loop, frame))
        self._problem = _SpatialLoops(mechanics, loops)
        self._completed = held.multipliers(mechanics)
        self._apart = LengthsApart(self._problem, factor, columns, held, rank)
        self.guards = self._apart.guards

    def motion(self, refined_by: RefinedBy = RefinedBy.NOTHING) -> Motion:
        """q_ddot and lambda."""
        mechanics, problem = self._mechanics, self._problem
        loops, forces = problem.loops, self._forces
        by_bodies, by_columns = refined_by is RefinedBy.BODIES, refined_by is RefinedBy.COLUMNS
        own = None if by_bodies else by_joints(mechanics, self._factor, loops, forces, self._given)
        if own is not None:
            solution = self._apart.solve(own.force, own.bias, by_columns, own.raised)
            return Motion(solution[0], self._completed(problem.of_the_model(solution[1])), self.guards)
        none = (mechanics.graph.zero,) * mechanics.n
        direct, loads = self._given
        inertial = self._inertial_forces(mechanics.qd, none, mechanics.working_gravity)
        force = self._factor.lowered(direct, added_loads(inertial, loads, mechanics.graph.one))
        if not by_bodies:
            solution = self._apart.solve(force, problem.bias, by_columns)
        else:

            def left_over(q_ddot: Vector, multipliers: Vector) -> Solution:
                inertial = self._inertial_forces(mechanics.qd, q_ddot, mechanics.working_gravity)
                acting = added_loads(inertial, loads, mechanics.graph.one)
                return self._less(direct, acting, q_ddot, multipliers), problem.bias_at(q_ddot)

            solution = self._refined(force, problem.bias, left_over)
        return Motion(solution[0], self._completed(problem.of_the_model(solution[1])), self.guards)

    def answered(self, asked: Vector) -> Vector:
        """x with G x + B^T lambda = 0, B x = `asked`, of rows that are not `turned`."""
        graph = self._mechanics.graph
        still: Vector3 = (graph.zero,) * 3
        none = (graph.zero,) * self._mechanics.n
        bias = tuple(-x for x in asked)

        def left_over(x: Vector, multipliers: Vector) -> Solution:
            lacking = (a + dot(graph, row, x) for a, row in zip(bias, self._problem.rows, strict=True))
            return self._less(none, self._inertial_forces(none, x, still), x, multipliers), tuple(lacking)

        return self._refined(none, bias, left_over)[0]

    def _refined(self, force: Vector, bias: Vector, left_over: Callable[[Vector, Vector], Solution]) -> Solution:
        def solved(force: Vector, bias: Vector) -> Solution:
            return self._apart.solve(force, bias, refining=False)

        return refined(self._mechanics.graph, solved(force, bias), left_over, solved)

    def _less(self, given: Vector, loads: dict[str, Six], q_ddot: Vector, multipliers: Vector) -> Vector:
        """L^-1 of given forces and loads less those of rotors and rows.

        Summed body by body each rounding is that of a mass, a length or a turn.
        """
        rotors = self._factor.rotors
        direct = [f - rotors[j] * q_ddot[j] if j in rotors else f for j, f in enumerate(given)]
        for factor, (own, load) in zip(multipliers, self._forces, strict=True):
            direct = [x - factor * y for x, y in zip(direct, own, strict=True)]
            for name, wrench in load.items():
                before = loads.get(name, (self._mechanics.graph.zero,) * 6)
                loads[name] = tuple(x - factor * y for x, y in zip(before, wrench, strict=True))
        return self._factor.lowered(direct, loads)

    def _inertial_forces(self, qd: Vector, q_ddot: Vector, gravity: Vector3) -> dict[str, Six]:
        """Weights and what bodies put on their frames for these rates and accelerations.

        As a force of the coordinates each would hold what all frames further out need, which is taken off again on the
        way inwards: in chains the difference of two numbers a hundred times larger than the torques.
        """
        by_frame = inertial_wrenches(self._mechanics.bodies, qd, q_ddot, gravity)
        return {name: tuple(-x for x in (*wrench.moment, *wrench.force)) for name, wrench in by_frame.items()}


def articulated(
    model: Model, generic: Genericity, refined_by: RefinedBy = RefinedBy.NOTHING
) -> tuple[System, Motion] | None:
    """The motion and the system it was derived on, a graph of its own.

    None where T is not that of bodies alone, a coordinate moves several frames or none, or G is not definite.
    """
    body_system = body_equations(model, generic, turned=generic.rank == generic.r)
    return None if body_system is None else (body_system[0], body_system[1].motion(refined_by))


def body_equations(model: Model, generic: Genericity, turned: bool) -> tuple[System, BodyEquations] | None:
    """The equations of a system of bodies on a graph of their own; None where it lacks them."""
    energy = model.kinetic_energy
    if not model.mechanism.has_mass or not isinstance(energy, Number) or energy.value != 0:
        return None
    mechanics = System(model)
    try:
        factor = ArticulatedFactor(mechanics.bodies)
    except ValueError:
        return None
    rows = mechanics.constraint_jacobian
    held = held_lengths(factor.quaternions, rows, mechanics.graph)
    if held is None or (generic.rank < generic.r and not held.apart(rows)):
        return None
    # where no row may hold what has no mass, pivots vanish only where the motion is not determined
    if held.others(len(rows)):
        definite = definite_by_frames(mechanics, factor) or definite_beside_rows(model)
    else:
        definite = definite_along_motion(mechanics, factor)
    if not definite:
        return None
    return mechanics, BodyEquations(mechanics, factor, held, generic.rank, turned)


def lacking(model: Model, generic: Genericity) -> str:
    """Why a system of bodies has no articulated inertias, and what would give it one."""
    energy = model.kinetic_energy
    if not isinstance(energy, Number) or energy.value != 0:
        return "part of the kinetic energy is written out: describe it by bodies"
    if generic.rank < generic.r:
        return "constraints depend on each other: leave out those that others imply"
    mechanics = System(model)
    try:
        ArticulatedFactor(mechanics.bodies)
    except ValueError:
        return "a coordinate moves several frames, or none: give each joint a coordinate of its own"
    inertias = zip(model.coordinates, mechanics.mass_matrix, strict=True)
    if names := [c.name for c, row in inertias if all(entry.is_zero for entry in row)]:
        return f"nothing that {' and '.join(names)} alone would move has mass or inertia: give its frame a body"
    return "the mass matrix is not shown to be positive definite: give masses and inertias a `range` above 0"


def _along_best_axes(
    mechanics: System, factor: ArticulatedFactor, loop: LoopPoint, columns: list[Vector]
) -> tuple[str, list[Vector]]:
    """The frame along whose axes a loop's columns hold least, and these; they are given along the axes of the world."""
    none = (mechanics.graph.zero,) * mechanics.n
    by_frame = {WORLD: columns}
    if len(loop.rows) == 3:
        for frame in loop.frames:
            by_frame[frame] = [factor.lowered(none, loads) for loads in wrenches(mechanics, loop, frame)]
    return min(by_frame.items(), key=lambda one: sum(not entry.is_zero for column in one[1] for entry in column))


def _alone(workspace: Workspace, refined_by: RefinedBy) -> tuple[System, Motion] | str:
    if refined_by is RefinedBy.COLUMNS and (reason := constraints(workspace.generic)):
        return reason
    solved = articulated(workspace.model, workspace.generic, refined_by)
    return BY_BODIES_ALONE if solved is None else solved


ARTICULATED: Method = WithoutNullSpace(partial(_alone, refined_by=RefinedBy.NOTHING), STRUCTURED)
BY_COLUMNS: Method = WithoutNullSpace(partial(_alone, refined_by=RefinedBy.COLUMNS), STRUCTURED)
BY_BODIES: Method = WithoutNullSpace(partial(_alone, refined_by=RefinedBy.BODIES), STRUCTURED)
