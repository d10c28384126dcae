"""What rates and weights do to the equations of motion, joint by joint: no acceleration is gathered from the root.

A motion without q_ddot gathers the centripetal accelerations of all joints between the root and a body.  Forces and
rows then hold these, and what is asked for is the difference: of a chain of 32 links that hardly pulls at what holds
its tip one part in a hundred.  Here a frame is accelerated by what its own joint adds to the acceleration of its
parent, which the frame and all it carries resist there (c_i of the articulated-body algorithm: Featherstone, Rigid
Body Dynamics Algorithms, 2008, ch. 7).  Weights are an acceleration of what stands on the world.

About axes that are not parallel joints add angular accelerations, too, and this takes more operations than the other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from symgen.mechanics.rigid_bodies.articulated_inertias import ArticulatedFactor
from symgen.mechanics.rigid_bodies.newton_euler import FrameMotion, joint_motions
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.frame_forces import Load, added_loads
from symgen.methods.forward_dynamics.loop_points import LoopPoint, acceleration, loop_points
from symgen.model.mechanism import WORLD
from symgen.records import dataclass
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class RightSides:
    """L^-1 f and a of equations in which frames are accelerated joint by joint, and what leads from x to q_ddot."""

    force: Vector
    bias: Vector
    raised: Callable[[Vector], Vector]


def by_joints(
    mechanics: System,
    factor: ArticulatedFactor,
    loops: Sequence[tuple[LoopPoint, str]],
    forces: Sequence[Load],
    given: Load,
) -> RightSides | None:
    """The right-hand sides; None where axes are not parallel, or rows hold other things than places of points.

    `forces` are what rows do to coordinates and frames, `given` what acts beside them; those of `loops` are taken along
    the axes of a frame.
    """
    bodies = mechanics.bodies
    motions = joint_motions(bodies, mechanics.qd, mechanics.working_gravity)
    moving = {name: (*one.acceleration, *one.linear) for name, one in motions.added.items()}
    added = {name: six for name, six in moving.items() if not all(x.is_zero for x in six)}
    if any(not x.is_zero for six in added.values() for x in six[:3]):
        return None
    bias = _row_accelerations(mechanics, motions.turning, loops, forces)
    if bias is None:
        return None
    for i, (direct, loads) in enumerate(forces):
        met = factor.brought_inwards(direct, loads)[1]
        # from the tips inwards, as they are met
        terms = [dot(mechanics.graph, met[name], six) for name, six in reversed(added.items())]
        bias[i] = mechanics.graph.sum([bias[i], *(term for term in terms if not term.is_zero)])
    resisted = {
        name: tuple(-x for x in (*wrench.moment, *wrench.force)) for name, wrench in motions.wrenches.items()
    }
    direct, loads = given
    force, _ = factor.brought_inwards(direct, added_loads(resisted, loads, mechanics.graph.one), added)
    return RightSides(force, tuple(bias), partial(factor.raised, added=added))


def _row_accelerations(
    mechanics: System,
    turning: Mapping[str, FrameMotion],
    loops: Sequence[tuple[LoopPoint, str]],
    forces: Sequence[Load],
) -> list[Scalar] | None:
    """What frames that turn and have no acceleration leave of each row's, or None."""
    taken = {i for loop, _ in loops for i in loop.rows.values()}
    by_row = dict[int, Scalar]()
    on_frames = {i for i, (_, loads) in enumerate(forces) if loads}
    others = [(loop, WORLD) for loop in loop_points(mechanics, in_planes=True)] if on_frames - taken else []
    for loop, axes in (*loops, *(one for one in others if taken.isdisjoint(one[0].rows.values()))):
        along = acceleration(mechanics, turning, loop, axes)
        by_row |= {i: along[axis] for axis, i in loop.rows.items()}
    if on_frames - by_row.keys():
        return None
    if len(by_row) < len(forces):
        plain = mechanics.constraint_acceleration_bias(mechanics.qd)
        by_row = dict(enumerate(plain)) | by_row
    return [by_row[i] for i in range(len(forces))]
