"""The recursive Newton-Euler algorithm in a tool's scalars, as textbooks have it for arms and trees.

Velocities and accelerations go outwards from frame to frame in body axes, forces and moments inwards, and each
coordinate takes what works along it (Luh, Walker and Paul, On-line computational scheme for mechanical manipulators,
1980; Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 5).  Joints are general: what a coordinate moves is the
derivative of the relative velocities by its rate.
"""

from __future__ import annotations

from dataclasses import dataclass

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol
from symgen.laboratory.bench.peers.formulas.algebra import total
from symgen.laboratory.bench.peers.formulas.frames import Walk, applied_forces, control_matrix, walk
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem
from symgen.model.expressions.expression import Expression, Number
from symgen.model.kinematics.triples import Triple, transposed
from symgen.model.mechanism import WORLD, Body, Frame
from symgen.model.model import Model

Vector3 = Triple[Symbol]


def is_recursive(model: Model) -> bool:
    """Whether all of a model are bodies on a tree: no rows, and no energies but theirs."""
    energies = model.kinetic_energy, model.potential_energy
    return model.mechanism.bodies != () and not model.constraints and all(map(_is_nothing, energies))


def _is_nothing(energy: Expression) -> bool:
    return isinstance(energy, Number) and energy.value == 0


def mechanics_by_recursion(engine: Engine, model: Model) -> PeerSystem:
    """tau and M; there are no rows."""
    at = walk(engine, model)
    forces = _OutAndBack(engine, model, at).forces()
    applied = applied_forces(engine, model, at)
    balance = [engine.name(force - own) for force, own in zip(forces, applied, strict=True)]
    return PeerSystem(at.inputs, balance, [], control_matrix(engine, model, at))


@dataclass(frozen=True, slots=True)
class _FrameRates:
    """Of a frame in its own axes; accelerations of origins are those against free fall."""

    angular: Vector3
    turning: Vector3
    linear: Vector3


class _OutAndBack:
    def __init__(self, engine: Engine, model: Model, at: Walk) -> None:
        self._engine, self._model = engine, model
        self._inputs: Inputs = at.inputs
        self._scope, self._scalars, self._kinematics = at.scope, at.scalars, at.kinematics
        self._space = at.kinematics.space
        still = self._space.still
        gravity = self._space.values(model.mechanism.gravity)
        self._motions = {WORLD: _FrameRates(still, still, (-gravity[0], -gravity[1], -gravity[2]))}
        self._loads: dict[str, tuple[Vector3, Vector3]] = {}

    def forces(self) -> list[Symbol]:
        """What the motion takes along each coordinate."""
        frames = self._model.mechanism.frames
        for frame in frames:
            self._motions[frame.name] = self._outwards(frame)
        for body in self._model.mechanism.bodies:
            self._add(body.frame, *self._inertial(body))
        works: list[list[Symbol]] = [[] for _ in range(self._model.n)]
        for frame in reversed(frames):
            if frame.name in self._loads:
                self._inwards(frame, works)
        places = {coordinate.name: i for i, coordinate in enumerate(self._model.coordinates)}
        for rotor in self._model.mechanism.rotor_inertias:
            place = places[rotor.coordinate]
            works[place].append(self._scalars.value(rotor.inertia) * self._inputs["qdd"][place])
        return [total(self._engine, terms) for terms in works]

    def _outwards(self, frame: Frame) -> _FrameRates:
        space, joint = self._space, self._kinematics.joint(frame.name)
        above, back = self._motions[frame.parent], transposed(joint.axes)
        carried = self._named(space.turned(back, above.angular))
        angular = self._named(space.summed(carried, joint.turning))
        turning = space.summed(space.turned(back, above.turning), self._crossed(carried, joint.turning))
        turning = self._named(space.summed(turning, self._rates(joint.turning)))
        linear = space.summed(above.linear, self._crossed(above.turning, joint.place))
        around = space.summed(self._crossed(above.angular, joint.place), joint.place_rate)
        linear = space.summed(linear, self._crossed(above.angular, self._named(around)))
        linear = space.summed(linear, self._crossed(above.angular, joint.place_rate))
        linear = space.summed(linear, self._rates(joint.place_rate))
        return _FrameRates(angular, turning, self._named(space.turned(back, linear)))

    def _inertial(self, body: Body) -> tuple[Vector3, Vector3]:
        """Force and moment about the origin of the frame that a body's motion takes."""
        space, motion = self._space, self._motions[body.frame]
        com, mass = space.values(body.com), self._scalars.value(body.mass)
        first, second, third = (space.values(row) for row in body.inertia.rows)
        tensor = first, second, third
        around = self._named(self._crossed(motion.angular, com))
        linear = space.summed(motion.linear, self._crossed(motion.turning, com))
        linear = space.summed(linear, self._crossed(motion.angular, around))
        force = self._named(space.scaled(linear, mass))
        momentum = self._named(space.turned(tensor, motion.angular))
        moment = space.summed(space.turned(tensor, motion.turning), self._crossed(motion.angular, momentum))
        return force, self._named(space.summed(moment, self._crossed(com, force)))

    def _inwards(self, frame: Frame, works: list[list[Symbol]]) -> None:
        """The load of a frame works on its coordinates and goes on to its parent."""
        space, joint = self._space, self._kinematics.joint(frame.name)
        force, moment = self._loads[frame.name]
        below = self._named(space.turned(joint.axes, force))
        for k, rate in enumerate(self._inputs["qd"]):
            for velocity, load in ((joint.turning, moment), (joint.place_rate, below)):
                for component, share in zip(velocity, load, strict=True):
                    along = self._engine.derivative(component, rate)
                    if not (self._engine.is_zero(along) or self._engine.is_zero(share)):
                        works[k].append(along * share)
        if frame.parent != WORLD:
            turned = space.turned(joint.axes, moment)
            self._add(frame.parent, below, self._named(space.summed(turned, self._crossed(joint.place, below))))

    def _add(self, frame: str, force: Vector3, moment: Vector3) -> None:
        space, (f, n) = self._space, self._loads.get(frame, (self._space.still, self._space.still))
        self._loads[frame] = self._named(space.summed(f, force)), self._named(space.summed(n, moment))

    def _crossed(self, left: Vector3, right: Vector3) -> Vector3:
        return self._space.crossed(left, right)

    def _rates(self, velocity: Vector3) -> Vector3:
        """What accelerations of the coordinates and the way of a joint's axes add to its relative velocity."""
        by = [*self._inputs["q"], *self._inputs["qd"]]
        x, y, z = self._engine.rates(velocity, by, [*self._inputs["qd"], *self._inputs["qdd"]])
        return x, y, z

    def _named(self, vector: Vector3) -> Vector3:
        x, y, z = (self._engine.name(component) for component in vector)
        return x, y, z
