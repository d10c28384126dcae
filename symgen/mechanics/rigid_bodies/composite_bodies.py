"""G and C by composite bodies: all that a joint carries is one, moved by each rate and felt by the joints further in.

A rate moves mass elements by u = v + s x r, r from the origin of its frame.  Of the mass m, the first moment h = int r,
the inertia T = int |r|^2 - r r^T, and of h_dot = int r_dot and K = int r.r_dot - r_dot r^T by all rates together, the
sums over all elements are

    int u = m v + s x h                           int r x u = h x v + T s
    int u_dot = m v_dot + s_dot x h + s x h_dot   int r x u_dot = h x v_dot + T s_dot + K s
                                                  int r_dot x u = h_dot x v + K^T s

Handed from frame to frame they give G_ij = int u_i.u_j and C_ij = int u_i.u_j_dot: as places of mass elements are
functions of the coordinates, these are Christoffel's (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 6, for G;
Echeandia and Wensing, J. Comput. Nonlinear Dyn. 16, 2021, for C by spatial inertias).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from symgen.mechanics.rigid_bodies.bodies import Bodies, Vector3
from symgen.mechanics.rigid_bodies.lumps import Lump, lumped_bodies
from symgen.model.kinematics.triples import Rows, applied, cross, inner, plus, product, transposed, triple
from symgen.model.mechanism import WORLD
from symgen.records import dataclass
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Matrix, flatten
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class Composite:
    """Mass, first moment h and inertia T about a point, h_dot and K."""

    mass: Scalar
    first: Vector3
    inertia: Rows[Scalar]
    first_rate: Vector3
    inertia_rate: Rows[Scalar]


@dataclass(frozen=True, slots=True)
class Direction:
    """What a rate turns or shifts a frame by for a unit of it, and what that changes by."""

    along: Vector3
    change: Vector3


@dataclass(frozen=True, slots=True)
class JointStep:
    """A frame against its parent: axes (None where both are looked at in the same), the place of its origin and what
    that changes by; by coordinates what turns it, in its axes, and what shifts it, in the parent's."""

    axes: Rows[Scalar] | None
    place: Vector3
    place_rate: Vector3
    turning: Mapping[int, Direction]
    shifting: Mapping[int, Direction]


@dataclass(frozen=True, slots=True)
class RateLoad:
    """What one rate takes of all elements, about the origin of a frame: the five sums."""

    force: Vector3  # int u_dot
    moment: Vector3  # int r x u_dot
    momentum: Vector3  # int u
    spin: Vector3  # int r x u
    drift: Vector3  # int r_dot x u


def composite_matrices(bodies: Bodies, in_world_axes: bool) -> tuple[Matrix, Matrix]:
    """G and C (n x n) of the bodies and rotors, C along q_dot; energies that are written out are no part of them.

    Parameters are regrouped first (`lumps.py`).  Where all turns share an axis those of the world are the shorter ones,
    elsewhere each frame has its own.
    """
    return _CompositeRecursion(bodies, in_world_axes).matrices()


class _CompositeRecursion:
    def __init__(self, bodies: Bodies, in_world_axes: bool) -> None:
        self._bodies, self._kinematics, self._in_world_axes = bodies, bodies.kinematics, in_world_axes
        zero, n = bodies.graph.zero, len(bodies.q)
        self._none: Vector3 = (zero, zero, zero)
        self._motion = dict(zip(bodies.q, bodies.qd, strict=True))
        loaded: set[str] = set()
        for body in bodies.mechanism.bodies:
            loaded.update(self._kinematics.lineage(body.frame))
        # from the root outwards
        self._frames = [frame.name for frame in bodies.mechanism.frames if frame.name in loaded]
        self._lumps, self._rotors = lumped_bodies(bodies, self._frames)
        self._axes = {name: self._described_in(name) for name in self._frames}
        self._steps = {name: self._step(name) for name in self._frames}
        self._mass = [[zero] * n for _ in range(n)]
        self._coriolis = [[zero] * n for _ in range(n)]

    def matrices(self) -> tuple[Matrix, Matrix]:
        """G and C."""
        carried = {name: self._rigid(name, lump) for name, lump in self._lumps.items()}
        for name in reversed(self._frames):
            step, parent = self._steps[name], self._kinematics.frames[name].parent
            above = _turned_composite(step.axes, carried[name])
            for j in dict.fromkeys((*step.turning, *step.shifting)):
                self._enter(name, j, carried[name], above)
            if parent != WORLD:
                carried[parent] = _sum(carried[parent], _shifted_composite(above, step))
        for rotor in self._rotors:
            shares = gradient(self._bodies.graph, self._bodies.names[f"{rotor.coordinate}_dot"], self._bodies.qd)
            inertia = self._bodies.scalars.value(rotor.inertia)
            for i, one in enumerate(shares):
                for j, other in enumerate(shares):
                    self._mass[i][j] = self._mass[i][j] + one * other * inertia
        return tuple(map(tuple, self._mass)), tuple(map(tuple, self._coriolis))

    def _described_in(self, name: str) -> str:
        """The frame in whose axes a lump is known: the parent of a wheel, which is the same however it is turned.

        In its own axes it would leave a rounding of itself, turned there and back.
        """
        parent = self._kinematics.frames[name].parent
        if any(self._kinematics.frames[other].parent == name for other in self._frames):
            return name
        lump, axes = self._lumps[name], self._kinematics.joint(name).axes
        known = (*lump.first, *flatten(lump.tensor))
        turned = (*applied(axes, lump.first), *flatten(_turned_rows(axes, lump.tensor)))
        return parent if all(x.value == y.value for x, y in zip(known, turned, strict=True)) else name

    def _rigid(self, name: str, lump: Lump) -> Composite:
        """A lump that turns with its frame: h_dot = w x h, K = -[w]x (tr T / 2 - T)."""
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = lump.tensor
        half = (xx + yy + zz) * (self._bodies.graph.one / 2)
        second: Rows[Scalar] = ((half - xx, -xy, -xz), (-yx, half - yy, -yz), (-zx, -zy, half - zz))
        shown = self._shown(self._axes[name])
        first, spin = applied(shown, lump.first), self._spin(name, self._axes[name])
        columns = [cross(column, spin) for column in transposed(_turned_rows(shown, second))]
        rate = transposed((columns[0], columns[1], columns[2]))
        return Composite(lump.mass, first, _turned_rows(shown, lump.tensor), cross(spin, first), rate)

    def _shown(self, frame: str) -> Rows[Scalar]:
        """What brings components in a frame's axes to those that are used for it."""
        return self._kinematics.axes(frame) if self._in_world_axes else self._kinematics.space.identity

    def _spin(self, name: str, frame: str) -> Vector3:
        """The angular velocity of `name`, in the axes that are used for components in those of `frame`."""
        return self._kinematics.twist(name, WORLD if self._in_world_axes else frame).angular

    def _step(self, name: str) -> JointStep:
        joint, parent, own = self._kinematics.joint(name), self._kinematics.frames[name].parent, self._axes[name]
        spin, spin_above = self._spin(own, own), self._spin(parent, parent)
        turning = joint.turning if own == name else joint.turning_before
        above = self._shown(parent)
        place = applied(above, joint.place)
        return JointStep(
            joint.axes if own == name and not self._in_world_axes else None,
            place,
            plus(applied(above, joint.place_rate), cross(spin_above, place)),
            {j: _seen(self._shown(own), one, spin) for j, one in self._directions(turning).items()},
            {j: _seen(above, one, spin_above) for j, one in self._directions(joint.place_rate).items()},
        )

    def _directions(self, rates: Vector3) -> dict[int, Direction]:
        """By coordinates, the parts of components that are linear in the rates, and what these change by."""
        columns = [gradient(self._bodies.graph, rate, self._bodies.qd) for rate in rates]
        made = {}
        for j, along in enumerate(zip(*columns, strict=True)):
            if not all(x.is_zero for x in along):
                change = derivative_along(self._bodies.graph, along, self._motion)
                made[j] = Direction(triple(along), triple(change))
        return made

    def _enter(self, name: str, j: int, own: Composite, above: Composite) -> None:
        """What a rate of a frame does to what that carries, entered for its own coordinates and those further in.

        The frame carries `own`, in its axes, which are `above` in its parent's.
        """
        step, nothing = self._steps[name], RateLoad(*[self._none] * 5)
        turned = _load_of_turning(step.turning[j], own) if j in step.turning else nothing
        shifted = _load_of_shifting(step.shifting[j], above) if j in step.shifting else nothing
        inside = turned if shifted is nothing else _sum_of_loads(turned, _turned_load(_back(step.axes), shifted))
        load = _sum_of_loads(_turned_load(step.axes, turned), shifted)
        for i, one in step.turning.items():
            self._add(i, j, inner(one.along, inside.spin), inner(one.along, inside.moment))
        for i, one in step.shifting.items():
            self._add(i, j, inner(one.along, load.momentum), inner(one.along, load.force))
        for further in self._lineage(name):
            load = _shifted_load(load, self._steps[name])
            name, step = further, self._steps[further]
            for i, one in step.turning.items():
                held = inner(one.along, load.spin)
                self._add(i, j, held, inner(one.along, load.moment))
                self._add(j, i, held, inner(one.change, load.spin) + inner(one.along, load.drift))
            load = _turned_load(step.axes, load)
            for i, one in step.shifting.items():
                held = inner(one.along, load.momentum)
                self._add(i, j, held, inner(one.along, load.force))
                self._add(j, i, held, inner(one.change, load.momentum))

    def _lineage(self, name: str) -> Iterator[str]:
        """The frames further in, the nearest first."""
        return (one for one in self._kinematics.lineage(name)[1:] if one != WORLD)

    def _add(self, i: int, j: int, mass: Scalar, coriolis: Scalar) -> None:
        self._mass[i][j] = self._mass[i][j] + mass
        self._coriolis[i][j] = self._coriolis[i][j] + coriolis


def _seen(axes: Rows[Scalar], one: Direction, spin: Vector3) -> Direction:
    """In other axes, and what it changes by against the world where its components are those in axes that turn."""
    along = applied(axes, one.along)
    return Direction(along, plus(applied(axes, one.change), cross(spin, along)))


def _load_of_turning(one: Direction, body: Composite) -> RateLoad:
    s, change = one.along, one.change
    return RateLoad(
        plus(cross(change, body.first), cross(s, body.first_rate)),
        plus(applied(body.inertia, change), applied(body.inertia_rate, s)),
        cross(s, body.first),
        applied(body.inertia, s),
        applied(transposed(body.inertia_rate), s),
    )


def _load_of_shifting(one: Direction, body: Composite) -> RateLoad:
    v, change = one.along, one.change
    return RateLoad(
        _times(body.mass, change),
        cross(body.first, change),
        _times(body.mass, v),
        cross(body.first, v),
        cross(body.first_rate, v),
    )


def _turned_load(axes: Rows[Scalar] | None, load: RateLoad) -> RateLoad:
    """In the axes of the parent."""
    if axes is None:
        return load
    return RateLoad(
        applied(axes, load.force),
        applied(axes, load.moment),
        applied(axes, load.momentum),
        applied(axes, load.spin),
        applied(axes, load.drift),
    )


def _shifted_load(load: RateLoad, step: JointStep) -> RateLoad:
    """About the origin of the parent, in whose axes it stands."""
    return RateLoad(
        load.force,
        plus(load.moment, cross(step.place, load.force)),
        load.momentum,
        plus(load.spin, cross(step.place, load.momentum)),
        plus(load.drift, cross(step.place_rate, load.momentum)),
    )


def _sum_of_loads(one: RateLoad, other: RateLoad) -> RateLoad:
    return RateLoad(
        plus(one.force, other.force),
        plus(one.moment, other.moment),
        plus(one.momentum, other.momentum),
        plus(one.spin, other.spin),
        plus(one.drift, other.drift),
    )


def _turned_composite(axes: Rows[Scalar] | None, body: Composite) -> Composite:
    if axes is None:
        return body
    return Composite(
        body.mass,
        applied(axes, body.first),
        _turned_rows(axes, body.inertia),
        applied(axes, body.first_rate),
        _turned_rows(axes, body.inertia_rate),
    )


def _shifted_composite(body: Composite, step: JointStep) -> Composite:
    """About the origin of the parent, in whose axes it stands: r + d for r, r_dot + d_dot for r_dot."""
    first = plus(body.first, _times(body.mass, step.place))
    moved = _added(_outer(step.place, first), _outer(body.first, step.place))
    drifted = _added(_outer(step.place_rate, first), _outer(body.first_rate, step.place))
    return Composite(
        body.mass,
        first,
        _added(body.inertia, _around(moved)),
        plus(body.first_rate, _times(body.mass, step.place_rate)),
        _added(body.inertia_rate, _around(drifted)),
    )


def _sum(one: Composite, other: Composite) -> Composite:
    return Composite(
        one.mass + other.mass,
        plus(one.first, other.first),
        _added(one.inertia, other.inertia),
        plus(one.first_rate, other.first_rate),
        _added(one.inertia_rate, other.inertia_rate),
    )


def _around(second: Rows[Scalar]) -> Rows[Scalar]:
    """tr A - A of a matrix, as inertias are of second moments."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = second
    return (yy + zz, -xy, -xz), (-yx, xx + zz, -yz), (-zx, -zy, xx + yy)


def _outer(left: Vector3, right: Vector3) -> Rows[Scalar]:
    """left right^T."""
    x, y, z = (_times(component, right) for component in left)
    return x, y, z


def _added(left: Rows[Scalar], right: Rows[Scalar]) -> Rows[Scalar]:
    x, y, z = (plus(one, other) for one, other in zip(left, right, strict=True))
    return x, y, z


def _turned_rows(axes: Rows[Scalar], rows: Rows[Scalar]) -> Rows[Scalar]:
    return product(product(axes, rows), transposed(axes))


def _times(factor: Scalar, vector: Vector3) -> Vector3:
    x, y, z = (factor * component for component in vector)
    return x, y, z


def _back(axes: Rows[Scalar] | None) -> Rows[Scalar] | None:
    return None if axes is None else transposed(axes)
