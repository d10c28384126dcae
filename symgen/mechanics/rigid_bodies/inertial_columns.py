"""What each inertial parameter of the bodies loads the coordinates with: the columns of the regressor of tau.

In the axes of a frame, with the acceleration a of its origin less gravity, its angular velocity w and U r, by which
points are accelerated beside their origin: a unit of mass takes the force a, one of first moment along e_k the force
U e_k and the moment e_k x a, one of inertia the moment I w' + w x I w about the origin.  They load coordinates by what
the rates of these move the frame with (Khalil and Dombre, Modeling, Identification and Control of Robots, 2002, ch. 9).
"""

from __future__ import annotations

from collections.abc import Iterator

from symgen.mechanics.rigid_bodies.bodies import Bodies
from symgen.mechanics.rigid_bodies.newton_euler import FrameMotion, Wrench, frame_motions, turning_moment
from symgen.model.inertial_parameters import ELEMENTS
from symgen.model.kinematics.triples import Rows, cross, inner, transposed, triple
from symgen.model.mechanism import INERTIA_ELEMENTS, WORLD, Mechanism
from symgen.symbolic.calculus import gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector
from symgen.symbolic.scalar import Scalar


def inertial_columns(bodies: Bodies, mechanism: Mechanism, qd: Vector, qdd: Vector) -> tuple[Vector, ...]:
    """Generalized forces (n each) for a unit of each of `inertial_parameters`.

    `mechanism` is that of the model, whose frames the parameters are about: `bodies` may have been turned.
    """
    graph, n = bodies.graph, len(qd)
    still: Vector = (graph.zero,) * n
    frames = dict.fromkeys(body.frame for body in mechanism.bodies if body.frame != WORLD)
    motions = frame_motions(bodies, qd, qdd, bodies.gravity, frames)
    by_frame = {frame: [*_of_frame(bodies, frame, motions[frame])] for frame in frames}
    # what stands on the world loads nothing
    by_frame[WORLD] = [still] * len(ELEMENTS)
    columns = [column for body in mechanism.bodies for column in by_frame[body.frame]]
    for rotor in mechanism.rotor_inertias:
        j = qd.index(bodies.names[f"{rotor.coordinate}_dot"])
        columns.append((*still[:j], qdd[j], *still[j + 1 :]))
    return tuple(columns)


def _of_frame(bodies: Bodies, frame: str, motion: FrameMotion) -> Iterator[Vector]:
    """The ten columns of a body that moves with a frame."""
    graph, twist = bodies.graph, bodies.kinematics.twist(frame)
    moved, turned = ([gradient(graph, rate, bodies.qd) for rate in rates] for rates in (twist.linear, twist.angular))
    for unit in _units(graph, motion):
        yield tuple(
            inner([row[j] for row in moved], unit.force) + inner([row[j] for row in turned], unit.moment)
            for j in range(len(bodies.qd))
        )


def _units(graph: Graph, motion: FrameMotion) -> Iterator[Wrench]:
    """What a unit of each element takes, in the order of `ELEMENTS`."""
    one, none = graph.one, (graph.zero,) * 3
    yield Wrench(motion.linear, triple(none))
    for k, column in enumerate(transposed(motion.field)):
        yield Wrench(column, cross(triple([one if i == k else graph.zero for i in range(3)]), motion.linear))
    for element in INERTIA_ELEMENTS:
        yield Wrench(triple(none), turning_moment(_unit_tensor(graph, element), motion))


def _unit_tensor(graph: Graph, element: str) -> Rows[Scalar]:
    """The symmetric tensor with 1 at this element."""
    i, j = ("xyz".index(axis) for axis in element)
    rows = [[graph.one if (a, b) in ((i, j), (j, i)) else graph.zero for b in range(3)] for a in range(3)]
    return triple(rows[0]), triple(rows[1]), triple(rows[2])
