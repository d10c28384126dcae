"""G = L D L^T frame by frame, without G: articulated inertias from the tips inwards.

A frame with everything it carries resists a motion of its own by an articulated inertia: that of its bodies plus what
its children pass on, each freed of the directions in which its joint yields.  The pivots D are what is met along the
joints, so that the factor of a chain takes a number of operations that grows with its length, and rounding errors act
like small turns of the joints instead of errors of single entries of G (Featherstone, Rigid Body Dynamics Algorithms,
2008, ch. 7; as a factorisation: Rodriguez, Jain, Kreutz-Delgado 1991).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from types import MappingProxyType

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard, magnitude
from symgen.mechanics.rigid_bodies.bodies import Bodies, Vector3
from symgen.mechanics.rigid_bodies.free_joints import FreeJoint, free_joint
from symgen.mechanics.rigid_bodies.quaternion_joints import QuaternionJoint, quaternion_joint
from symgen.model.kinematics.triples import Rows, applied, cross, plus, transposed
from symgen.model.mechanism import WORLD
from symgen.records import dataclass
from symgen.symbolic.calculus import gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.scalar import Scalar

# Turning rates and velocities of the origin, or moments and forces, in the frame's axes.
Six = tuple[Scalar, ...]
Sizes = tuple[Vector3, Scalar]
NOTHING: Mapping[str, Six] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class ArticulatedCoordinate:
    """One coordinate of a frame: its direction, the inertia met along it, and that inertia over the pivot."""

    coordinate: int
    direction: Six
    pivot: Scalar
    share: Six


class ArticulatedFactor:
    """The factor of the mass matrix of `bodies`, in the interface of a Cholesky factor.

    L is triangular in the order from the tips to the root.  ValueError where a coordinate moves more than one frame.
    """

    def __init__(self, bodies: Bodies) -> None:
        self._bodies = bodies
        self.graph: Graph = bodies.graph
        mechanism = bodies.mechanism
        self.frames = [frame.name for frame in mechanism.frames]
        self._parents = {frame.name: frame.parent for frame in mechanism.frames}
        self.rotors = self._rotor_inertias()
        directions = {name: self._moved_by(name) for name in self.frames}
        # rotors resist coordinates, not twists
        plain = {name: dict(own) for name, own in directions.items() if self.rotors.keys().isdisjoint(dict(own))}
        free = {name: joint for name, own in plain.items() if (joint := free_joint(own)) is not None}
        quaternions = {name: quaternion_joint(bodies, name, own) for name, own in plain.items()}
        turned = {name: joint for name, joint in quaternions.items() if joint is not None}
        self.quaternions = list(turned.values())
        self._free: dict[str, FreeJoint | QuaternionJoint] = {**free, **turned}
        moved = [coordinate for own in directions.values() for coordinate, _ in own]
        if sorted(moved) != list(range(len(bodies.q))):
            raise ValueError("a coordinate moves no frame, or several")
        # by frame: its coordinates, and the motions they give the frame in its axes; unit twists where it moves freely
        unit = {name: joint.directions(dict(directions[name]), self.graph) for name, joint in self._free.items()}
        self.directions = directions | unit
        self._yielding: dict[str, list[ArticulatedCoordinate]] = {}
        self._resisting: dict[str, Matrix] = {}
        sizes = self.sizes()
        pivots: dict[int, Scalar] = {}
        scales: dict[int, Scalar] = {}
        self.own: dict[int, Scalar] = {}
        inertias = {name: self.own_inertia(name) for name in self.frames}
        for name in reversed(self.frames):
            inertia = self._resisting[name] = inertias[name]
            rigid = self.own_inertia(name)
            yielding: list[ArticulatedCoordinate] = []
            for coordinate, direction in reversed(self.directions[name]):
                rotor = self.rotors.get(coordinate, self.graph.zero)
                met = self._times(inertia, direction)
                pivot = self._dot(direction, met) + rotor
                share = tuple(x if x.is_zero else x / pivot for x in met)
                inertia = self.freed(inertia, direction, met, share, rotor)
                yielding.append(ArticulatedCoordinate(coordinate, direction, pivot, share))
                pivots[coordinate] = pivot
                self.own[coordinate] = self._dot(direction, self._times(rigid, direction)) + rotor
                scales[coordinate] = self.size(direction, sizes[name]) + rotor
            self._yielding[name] = yielding
            parent = self._parents[name]
            if parent != WORLD:
                inertias[parent] = _summed(inertias[parent], self.carried_inertia(name, inertia))
        # of the length of a quaternion the pivot says nothing: its rate is that of the row that holds it
        self.pivots: list[Scalar] = [pivots.get(j, self.graph.one) for j in range(len(bodies.q))]
        turns = (Guard(Status.MASS_RANK, joint.determinant, 1) for joint in free.values())
        along = (Guard(Status.MASS_RANK, pivots[j], 1, scale=scales[j], positive=True) for j in sorted(pivots))
        self.guards = (*along, *turns)

    def lowered(self, b: Sequence[Scalar], wrenches: Mapping[str, Six] | None = None) -> Vector:
        """The solution of L y = b; `wrenches` on frames are part of the generalized force b."""
        return self.brought_inwards(b, wrenches or {})[0]

    def brought_inwards(
        self, b: Sequence[Scalar], wrenches: Mapping[str, Six], added: Mapping[str, Six] = NOTHING
    ) -> tuple[Vector, dict[str, Six]]:
        """The same, and what loads each frame before its joint yields.

        `added` are accelerations of frames beside those that their parents hand on and their coordinates give them,
        angular and linear, in their axes.
        """
        zero = self.graph.zero
        loads = {name: wrenches.get(name, (zero,) * 6) for name in self.frames}
        y = list(b)
        for name in reversed(self.frames):
            load = loads[name]
            if name in added:
                resisted = self._times(self._resisting[name], added[name])
                load = loads[name] = tuple(x - r for x, r in zip(load, resisted, strict=True))
            if name in self._free:
                y[:] = self._replaced(y, self._free[name].wrench(y))
            for one in self._yielding[name]:
                given = y[one.coordinate]
                rest = y[one.coordinate] = given + self._dot(one.direction, load)
                along = _unit(one.direction)
                # along the joint itself the given force alone is passed on, without a difference
                load = tuple(
                    x if s.is_zero else -given if s.is_one and i == along else x - s * rest
                    for i, (x, s) in enumerate(zip(load, one.share, strict=True))
                )
            parent = self._parents[name]
            if parent != WORLD:
                carried = self._carried_wrench(name, load)
                loads[parent] = tuple(x + c for x, c in zip(loads[parent], carried, strict=True))
        return tuple(y), loads

    def raised(self, b: Sequence[Scalar], added: Mapping[str, Six] = NOTHING) -> Vector:
        """The solution of L^T x = b; with `added` as in `brought_inwards` x are accelerations."""
        zero = self.graph.zero
        twists: dict[str, Six] = {WORLD: (zero,) * 6}
        x = list(b)
        for name in self.frames:
            twist = self._carried_twist(name, twists[self._parents[name]])
            for one in reversed(self._yielding[name]):
                rate = x[one.coordinate] - self._dot(one.share, twist)
                x[one.coordinate] = rate
                twist = tuple(t if d.is_zero else t + d * rate for t, d in zip(twist, one.direction, strict=True))
            # the joint itself has met what is added by its force
            twists[name] = tuple(t + a for t, a in zip(twist, added[name], strict=True)) if name in added else twist
            if name in self._free:
                x[:] = self._replaced(x, self._free[name].rates(x))
        return tuple(x)

    @staticmethod
    def _replaced(given: Sequence[Scalar], new: Mapping[int, Scalar]) -> Vector:
        return tuple(new.get(j, entry) for j, entry in enumerate(given))

    def _moved_by(self, name: str) -> list[tuple[int, Six]]:
        """The motions that each coordinate gives the frame against its parent, in the frame's axes."""
        joint = self._bodies.kinematics.joint(name)
        moving = applied(transposed(joint.axes), joint.place_rate)
        columns = [gradient(self.graph, rate, self._bodies.qd) for rate in (*joint.turning, *moving)]
        motions = []
        for j in range(len(self._bodies.q)):
            direction = tuple(column[j] for column in columns)
            if not all(entry.is_zero for entry in direction):
                motions.append((j, direction))
        return motions

    def _rotor_inertias(self) -> dict[int, Scalar]:
        names = [str(symbol.payload) for symbol in self._bodies.q]
        inertias: dict[int, Scalar] = {}
        for rotor in self._bodies.mechanism.rotor_inertias:
            j = names.index(rotor.coordinate)
            inertias[j] = inertias.get(j, self.graph.zero) + self._bodies.scalars.value(rotor.inertia)
        return inertias

    def children(self, name: str) -> list[str]:
        """The frames that hang on a frame."""
        return [child for child, parent in self._parents.items() if parent == name]

    def bodies_of(self, name: str) -> tuple[list[Scalar], Matrix]:
        """The masses of a frame's bodies, and the sum of their inertias about their centres of mass."""
        bodies = [body for body in self._bodies.mechanism.bodies if body.frame == name]
        total: Matrix = ((self.graph.zero,) * 3,) * 3
        for body in bodies:
            total = _summed(total, self._bodies.inertia(body.name))
        return [self._bodies.scalars.value(body.mass) for body in bodies], total

    def own_inertia(self, name: str) -> Matrix:
        """Of the bodies of a frame about its origin: [[I + m (c.c - c c^T), m [c]], [.., m]]."""
        graph, zero = self.graph, self.graph.zero
        total: Matrix = ((zero,) * 6,) * 6
        for body in self._bodies.mechanism.bodies:
            if body.frame != name:
                continue
            mass, com = self._bodies.scalars.value(body.mass), self._bodies.kinematics.space.values(body.com)
            x, y, z = (mass * c for c in com)
            cross = ((zero, -z, y), (z, zero, -x), (-y, x, zero))
            about = [
                [
                    entry + (graph.sum((x, y, z)[k] * com[k] for k in range(3) if k != i) if i == j else -moment)
                    for j, (entry, moment) in enumerate(zip(row, ((x, y, z)[i] * c for c in com), strict=True))
                ]
                for i, row in enumerate(self._bodies.inertia(body.name))
            ]
            upper = [(*about[i], *cross[i]) for i in range(3)]
            lower = [
                (*(cross[j][i] for j in range(3)), *(mass if i == j else zero for j in range(3))) for i in range(3)
            ]
            total = _summed(total, (*upper, *lower))
        return total

    def freed(self, inertia: Matrix, direction: Six, met: Six, share: Six, rotor: Scalar) -> Matrix:
        """inertia - met share^T; along a unit direction only what a rotor keeps is left, without a difference."""
        along, zero = _unit(direction), self.graph.zero

        def entry(i: int, j: int) -> Scalar:
            if along is not None and along in (i, j):
                other = j if i == along else i
                return zero if rotor.is_zero else rotor * share[other]
            if met[i].is_zero or share[j].is_zero:
                return inertia[i][j]
            return inertia[i][j] - met[i] * share[j]

        return _symmetric(entry)

    def carried_inertia(self, name: str, inertia: Matrix) -> Matrix:
        """In the parent's axes and about its origin: A - H [r] + [r] H^T - [r] M [r], H + [r] M, M."""
        joint = self._bodies.kinematics.joint(name)
        axes, r = joint.axes, joint.place

        def block(i: int, j: int) -> Rows[Scalar]:
            rows = [tuple(row[3 * j : 3 * j + 3]) for row in inertia[3 * i : 3 * i + 3]]
            turned = [applied(axes, (a, b, c)) for a, b, c in rows]  # rows times the transposed axes
            return transposed(_three([applied(axes, column) for column in transposed(_three(turned))]))

        about, mixed, mass = block(0, 0), block(0, 1), block(1, 1)
        # [r] X: r x each column of X; X [r]: minus r x each row of X
        lever = transposed(_three([cross(r, column) for column in transposed(mass)]))
        moved = _three([plus(a, b) for a, b in zip(mixed, lever, strict=True)])
        # A + [r] H^T - (H + [r] M) [r]
        first = transposed(_three([cross(r, column) for column in mixed]))
        second = _three([cross(r, row) for row in moved])
        turned = [plus(plus(a, b), c) for a, b, c in zip(about, first, second, strict=True)]

        def entry(i: int, j: int) -> Scalar:
            if j < 3:
                return turned[i][j]
            return moved[i][j - 3] if i < 3 else mass[i - 3][j - 3]

        return _symmetric(entry)

    def _carried_wrench(self, name: str, load: Six) -> Six:
        joint = self._bodies.kinematics.joint(name)
        force = applied(joint.axes, (load[3], load[4], load[5]))
        moment = plus(applied(joint.axes, (load[0], load[1], load[2])), cross(joint.place, force))
        return (*moment, *force)

    def _carried_twist(self, name: str, twist: Six) -> Six:
        joint = self._bodies.kinematics.joint(name)
        inward = transposed(joint.axes)
        angular: Vector3 = (twist[0], twist[1], twist[2])
        linear = plus((twist[3], twist[4], twist[5]), cross(angular, joint.place))
        return (*applied(inward, angular), *applied(inward, linear))

    def size(self, direction: Six, bounds: Sizes) -> Scalar:
        """What the inertia along a motion is made of, from bounds of the moments of inertia and of the mass."""
        squares = [x * x for x in magnitude(self.graph, direction)]
        turning = self.graph.sum(x * y for x, y in zip(squares[:3], bounds[0], strict=True))
        return turning + self.graph.sum(squares[3:]) * bounds[1]

    def sizes(self, alone: Collection[str] = ()) -> dict[str, Sizes]:
        """For each frame with all it carries: bounds of the moments of inertia about its axes, and of the mass.

        Axis by axis, since a thin rod resists a turn about itself a million times less than one about another axis;
        what a frame carries counts about the axes that it can turn there.  Frames that are `alone` carry nothing.
        """
        graph, zero = self.graph, self.graph.zero
        first, mass = (dict.fromkeys(self.frames, zero) for _ in range(2))
        about = {name: [zero] * 3 for name in self.frames}
        for body in self._bodies.mechanism.bodies:
            if body.frame == WORLD:
                continue
            rows, com = self._bodies.inertia(body.name), self._bodies.kinematics.space.values(body.com)
            m, arms = self._bodies.scalars.value(body.mass), magnitude(graph, com)
            for k, own in enumerate(magnitude(graph, [rows[i][i] for i in range(3)])):
                across = graph.sum(arms[i] for i in range(3) if i != k)
                about[body.frame][k] = about[body.frame][k] + own + m * across * across
            first[body.frame] = first[body.frame] + m * graph.sum(arms)
            mass[body.frame] = mass[body.frame] + m
        for name in reversed(self.frames):
            parent = self._parents[name]
            if parent != WORLD and parent not in alone:
                joint = self._bodies.kinematics.joint(name)
                arms, moment, m = magnitude(graph, joint.place), first[name], mass[name]
                for k, row in enumerate(joint.axes):
                    carried = graph.sum(x for x, part in zip(about[name], row, strict=True) if not part.is_zero)
                    across = graph.sum(arms[i] for i in range(3) if i != k)
                    about[parent][k] = about[parent][k] + carried + (moment + moment + m * across) * across
                first[parent], mass[parent] = first[parent] + moment + m * graph.sum(arms), mass[parent] + m
        return {name: ((about[name][0], about[name][1], about[name][2]), mass[name]) for name in self.frames}

    def _times(self, inertia: Matrix, direction: Six) -> Six:
        return tuple(self._dot(row, direction) for row in inertia)

    def _dot(self, one: Sequence[Scalar], other: Sequence[Scalar]) -> Scalar:
        return dot(self.graph, one, other)


def _unit(direction: Six) -> int | None:
    """The axis of a unit direction."""
    units = [i for i, d in enumerate(direction) if not d.is_zero]
    return units[0] if len(units) == 1 and direction[units[0]].is_one else None


def _symmetric(entry: Callable[[int, int], Scalar]) -> Matrix:
    """The symmetric matrix with these entries on and above its diagonal."""
    upper = {(i, j): entry(i, j) for i in range(6) for j in range(i, 6)}
    return tuple(tuple(upper[min(i, j), max(i, j)] for j in range(6)) for i in range(6))


def _summed(one: Matrix, other: Matrix) -> Matrix:
    return tuple(tuple(a + b for a, b in zip(row, more, strict=True)) for row, more in zip(one, other, strict=True))


def _three(rows: Sequence[Vector3]) -> Rows[Scalar]:
    first, second, third = rows
    return first, second, third
