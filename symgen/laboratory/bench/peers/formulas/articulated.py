"""The articulated-body algorithm in a tool's scalars: accelerations of arms and trees in one sweep in and one out.

Frame by frame, in body axes (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 7).  A spatial vector is an
angular part beside the linear one of the frame's origin; inertias and forces stand for the same point.  Joints are
general: a frame has as many columns as coordinates move it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Matrix, Symbol
from symgen.laboratory.bench.peers.formulas.algebra import dot, ldl_solve, named, product, total, transposed
from symgen.laboratory.bench.peers.formulas.frames import applied_forces, control_matrix, walk
from symgen.model.kinematics.triples import Triple
from symgen.model.kinematics.triples import transposed as turned_back
from symgen.model.mechanism import WORLD, Body, Frame
from symgen.model.model import Model

Vector = list[Symbol]


@dataclass(frozen=True, slots=True)
class _JointedFrame:
    """A frame: rotation to its parent's axes, place there, columns by coordinate, what velocities add, its rates."""

    rotation: Matrix
    place: Vector
    columns: dict[int, Vector]
    bias: Vector
    angular: Triple[Symbol]


@dataclass(slots=True)
class _Carried:
    """Articulated inertia and bias force of a frame and all that it carries."""

    inertia: Matrix
    force: Vector


def forward_dynamics(engine: Engine, model: Model) -> tuple[Inputs, list[Symbol]]:
    """q, q_dot, u and p; the accelerations.  For trees of bodies of which every coordinate moves some mass."""
    return _Sweeps(engine, model).solved()


class _Sweeps:
    def __init__(self, engine: Engine, model: Model) -> None:
        self._engine, self._model = engine, model
        self._at = walk(engine, model)
        self._space = self._at.kinematics.space
        self._zero = engine.number(Fraction(0))
        self._links: dict[str, _JointedFrame] = {}
        inputs = engine.symbols("u", len(model.inputs))
        control, applied = control_matrix(engine, model, self._at), applied_forces(engine, model, self._at)
        self._forces = [dot(engine, row, inputs) + own for row, own in zip(control, applied, strict=True)]
        self.inputs: Inputs = {name: self._at.inputs[name] for name in ("q", "qd")}
        self.inputs |= {"u": inputs, "p": self._at.inputs["p"]}

    def solved(self) -> tuple[Inputs, list[Symbol]]:
        """Out for velocities, in for inertias, out for accelerations."""
        engine, model = self._engine, self._model
        frames = model.mechanism.frames
        for frame in frames:
            self._links[frame.name] = self._link(frame)
        carried = {frame.name: _Carried(self._nothing(6), [self._zero] * 6) for frame in frames}
        for body in model.mechanism.bodies:
            self._add_body(carried[body.frame], body)
        solved = {frame.name: self._inwards(frame, carried) for frame in reversed(frames)}
        gravity = self._space.values(model.mechanism.gravity)
        motions = {WORLD: [self._zero] * 3 + [-component for component in gravity]}
        accelerations = [self._zero] * model.n
        for frame in frames:
            link = self._links[frame.name]
            motion = self._sum(self._to_child(link, motions[frame.parent]), link.bias)
            for place, (rows, right) in zip(link.columns, solved[frame.name], strict=True):
                accelerations[place] = engine.name(right - dot(engine, rows, motion))
            for place, column in link.columns.items():
                motion = self._sum(motion, [x * accelerations[place] if not engine.is_zero(x) else x for x in column])
            motions[frame.name] = [engine.name(x) for x in motion]
        return self.inputs, accelerations

    def _link(self, frame: Frame) -> _JointedFrame:
        engine, space, joint = self._engine, self._space, self._at.kinematics.joint(frame.name)
        above = self._links[frame.parent].angular if frame.parent != WORLD else space.still
        back = turned_back(joint.axes)
        carried = self._named3(space.turned(back, above))
        angular = self._named3(space.summed(carried, joint.turning))
        turning = space.summed(space.crossed(carried, joint.turning), self._rates(joint.turning))
        around = self._named3(space.summed(space.crossed(above, joint.place), joint.place_rate))
        linear = space.summed(space.crossed(above, around), space.crossed(above, joint.place_rate))
        linear = space.turned(back, space.summed(linear, self._rates(joint.place_rate)))
        columns: dict[int, Vector] = {}
        for place, rate in enumerate(self._at.inputs["qd"]):
            ang, lin = (
                triple([engine.derivative(x, rate) for x in velocity])
                for velocity in (joint.turning, joint.place_rate)
            )
            column = [*ang, *space.turned(back, lin)]
            if not all(map(engine.is_zero, column)):
                columns[place] = [engine.name(x) for x in column]
        bias = [engine.name(x) for x in (*turning, *linear)]
        return _JointedFrame([list(row) for row in joint.axes], list(joint.place), columns, bias, angular)

    def _add_body(self, carried: _Carried, body: Body) -> None:
        engine, space = self._engine, self._space
        com, mass = list(space.values(body.com)), self._at.scalars.value(body.mass)
        tensor = [list(space.values(row)) for row in body.inertia.rows]
        angular = self._links[body.frame].angular
        moment = [mass * x if not engine.is_zero(x) else x for x in com]
        arm = self._cross_matrix(moment)
        # I - m [c][c] about the origin
        about = self._less(tensor, product(engine, self._cross_matrix(com), arm))
        rows = [[*about[i], *arm[i]] for i in range(3)]
        diagonal = [[mass if i == j else self._zero for j in range(3)] for i in range(3)]
        rows += [[*(-x for x in arm[i]), *diagonal[i]] for i in range(3)]
        carried.inertia = self._plus(carried.inertia, rows)
        around = self._named3(space.crossed(angular, triple(com)))
        force = self._named3(space.scaled(space.crossed(angular, around), mass))
        momentum = self._named3([dot(engine, row, angular) for row in tensor])
        torque = space.summed(space.crossed(angular, momentum), space.crossed(triple(com), force))
        carried.force = self._sum(carried.force, [*torque, *force])

    def _inwards(self, frame: Frame, carried: dict[str, _Carried]) -> list[tuple[Vector, Symbol]]:
        """Of each coordinate of a frame, q_ddot = right - row . motion; the rest of the load goes to the parent."""
        engine, link, own = self._engine, self._links[frame.name], carried[frame.name]
        own.inertia, own.force = named(engine, own.inertia), [engine.name(x) for x in own.force]
        columns = list(link.columns.values())
        rotors = {rotor.coordinate: rotor.inertia for rotor in self._model.mechanism.rotor_inertias}
        equations: list[tuple[Vector, Symbol]] = []
        inertia, force = own.inertia, own.force
        if columns:
            pushed = [[engine.name(dot(engine, row, column)) for row in own.inertia] for column in columns]
            square = [[dot(engine, left, right) for right in pushed] for left in columns]
            for k, place in enumerate(link.columns):
                name = self._model.coordinates[place].name
                if name in rotors:
                    square[k][k] = square[k][k] + self._at.scalars.value(rotors[name])
            rest = [
                engine.name(self._forces[place] - dot(engine, column, own.force))
                for place, column in link.columns.items()
            ]
            solutions = self._solved(square, [*transposed(pushed), rest])
            rows, right = transposed(solutions[:6]), solutions[6]
            equations = [([engine.name(x) for x in row], engine.name(x)) for row, x in zip(rows, right, strict=True)]
            taken = [[dot(engine, a, b) for b in transposed([r for r, _ in equations])] for a in transposed(pushed)]
            inertia = named(engine, self._less(own.inertia, taken))
            shares = [dot(engine, a, [x for _, x in equations]) for a in transposed(pushed)]
            force = self._sum(own.force, shares)
        force = [engine.name(x) for x in self._sum(force, [dot(engine, row, link.bias) for row in inertia])]
        if frame.parent != WORLD:
            above = carried[frame.parent]
            above.inertia = self._plus(above.inertia, self._inertia_above(link, inertia))
            above.force = self._sum(above.force, self._force_above(link, force))
        return equations

    def _solved(self, square: Matrix, columns: Matrix) -> Matrix:
        engine = self._engine
        if len(square) > 1:
            return ldl_solve(engine, named(engine, square), columns)
        inverse = engine.name(engine.number(Fraction(1)) / square[0][0])
        return [[x * inverse if not engine.is_zero(x) else x for x in column] for column in columns]

    def _to_child(self, link: _JointedFrame, motion: Vector) -> Vector:
        """A spatial acceleration of the parent at the origin and in the axes of the frame."""
        engine, angular, linear = self._engine, motion[:3], motion[3:]
        moved = self._sum(linear, list(self._space.crossed(triple(angular), triple(link.place))))
        back = transposed(link.rotation)
        return [engine.name(dot(engine, row, part)) for part in (angular, moved) for row in back]

    def _force_above(self, link: _JointedFrame, force: Vector) -> Vector:
        engine = self._engine
        parts = force[:3], force[3:]
        torque, push = ([engine.name(dot(engine, row, part)) for row in link.rotation] for part in parts)
        arm = self._space.crossed(triple(link.place), triple(push))
        return [*self._sum(torque, list(arm)), *push]

    def _inertia_above(self, link: _JointedFrame, inertia: Matrix) -> Matrix:
        """Turned block by block, then moved along the place: N = N' + p x F, a' = a - p x alpha."""
        engine, turn = self._engine, link.rotation
        blocks = [[[row[3 * j : 3 * j + 3] for row in inertia[3 * i : 3 * i + 3]] for j in (0, 1)] for i in (0, 1)]
        back = transposed(turn)
        first, mixed, last = (
            named(engine, product(engine, named(engine, product(engine, turn, block)), back))
            for block in (blocks[0][0], blocks[0][1], blocks[1][1])
        )
        arm = self._cross_matrix(link.place)
        beside = named(engine, self._plus(mixed, product(engine, arm, last)))
        about = self._less(self._plus(first, product(engine, arm, transposed(mixed))), product(engine, beside, arm))
        rows = [[*about[i], *beside[i]] for i in range(3)]
        return rows + [[*(beside[j][i] for j in range(3)), *last[i]] for i in range(3)]

    def _rates(self, velocity: Sequence[Symbol]) -> Triple[Symbol]:
        """What the way of a joint's axes adds, without the accelerations of the coordinates."""
        at = self._at.inputs
        return triple(self._engine.rates(velocity, at["q"], at["qd"]))

    def _cross_matrix(self, p: Sequence[Symbol]) -> Matrix:
        x, y, z = p
        return [[self._zero, -z, y], [z, self._zero, -x], [-y, x, self._zero]]

    def _nothing(self, n: int) -> Matrix:
        return [[self._zero] * n for _ in range(n)]

    def _sum(self, left: Sequence[Symbol], right: Sequence[Symbol]) -> Vector:
        return [total(self._engine, [a, b]) for a, b in zip(left, right, strict=True)]

    def _plus(self, left: Matrix, right: Matrix) -> Matrix:
        return [self._sum(a, b) for a, b in zip(left, right, strict=True)]

    def _less(self, left: Matrix, right: Matrix) -> Matrix:
        is_zero = self._engine.is_zero
        return [
            [a if is_zero(b) else a - b for a, b in zip(one, other, strict=True)]
            for one, other in zip(left, right, strict=True)
        ]

    def _named3(self, vector: Sequence[Symbol]) -> Triple[Symbol]:
        return triple([self._engine.name(x) for x in vector])


def triple(values: Sequence[Symbol]) -> Triple[Symbol]:
    """Three values."""
    x, y, z = values
    return x, y, z
