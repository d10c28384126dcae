"""What rows and forces do to frames: wrenches in place of entries for each coordinate.

The entries of a torque on a frame about axes that are all but parallel, as those of a wheel that all but lies flat,
hold it several times, and their difference is what drives the rest; a wrench is brought inwards joint by joint.
"""

from __future__ import annotations

from collections.abc import Mapping

from symgen.mechanics.rigid_bodies.articulated_inertias import Six
from symgen.mechanics.system import System
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.components import components_in, definitions_before_frames
from symgen.model.kinematics.triples import applied
from symgen.model.kinematics.walk import Kinematics, Twist
from symgen.model.mechanism import component
from symgen.symbolic.calculus import gradient
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import substitute

# A force of the coordinates, and wrenches on frames in their axes.
Load = tuple[Vector, Mapping[str, Six]]


class FrameForces:
    """What rows of B and given forces do to the coordinates directly, and the wrenches that they put on frames."""

    def __init__(self, mechanics: System) -> None:
        graph, model = mechanics.graph, mechanics.model
        self._mechanics, self._graph, self._loose = mechanics, graph, _Loose(mechanics)
        self._stand_ins = {name: graph.stand_in(f"component {name}") for name in components_in(model)}
        self._names = _names(mechanics, self._stand_ins)
        self._values = {symbol: mechanics.names[name] for name, symbol in self._stand_ins.items()}
        self._rates = {name: self._loose.component_rate(component(name)) for name in self._stand_ins}

    def of_rows(self) -> list[Load]:
        """Of a multiplier of 1 for each row."""
        rows = self._mechanics.model.constraints
        geometric = [self._load(row.expression, geometric=True) for row in rows if row.kind == "geometric"]
        return geometric + [self._load(row.expression) for row in rows if row.kind == "nonholonomic"]

    def given(self) -> Load:
        """M u + Q_a less the gradient of the written potential.

        What works on a rate of frames is a wrench where it acts on several coordinates.
        """
        direct: list[tuple[Scalar, Vector]] = []
        wrenches: dict[str, Six] = {}
        for magnitude, force, velocity in self._mechanics.given.parts:
            if velocity is None or sum(not x.is_zero for x in force) < 2:
                direct.append((magnitude, force))
                continue
            own, loads = self._load(velocity)
            direct.append((magnitude, own))
            wrenches = added_loads(wrenches, loads, magnitude)
        if not wrenches:
            return self._mechanics.given.total, {}
        columns = zip(*(force for _, force in direct), strict=True)
        sizes = [magnitude for magnitude, _ in direct]
        return tuple(dot(self._graph, sizes, column) for column in columns), wrenches

    def _load(self, expression: Expression, geometric: bool = False) -> Load:
        """Of a unit force along a residual, or along a rate."""
        graph, mechanics, stand_ins = self._graph, self._mechanics, self._stand_ins
        translated = translate(graph, expression, self._names)
        used = [name for name in stand_ins if geometric or component(name).is_rate]
        slopes = gradient(graph, translated, [stand_ins[name] for name in used])
        own = gradient(graph, translated, mechanics.q if geometric else mechanics.qd)
        slopes, own = substitute(graph, slopes, self._values), substitute(graph, own, self._values)
        speed = graph.sum(x * self._rates[name] for x, name in zip(slopes, used, strict=True) if not x.is_zero)
        direct = tuple(a + b for a, b in zip(own, gradient(graph, speed, mechanics.qd), strict=True))
        wrenches = {}
        for frame in mechanics.bodies.mechanism.frames:
            wrench = tuple(gradient(graph, speed, self._loose.symbols(frame.name)))
            if not all(entry.is_zero for entry in wrench):
                wrenches[frame.name] = wrench
        return direct, wrenches


def added_loads(loads: Mapping[str, Six], others: Mapping[str, Six], magnitude: Scalar) -> dict[str, Six]:
    """The sum of wrenches on frames, the others so many times."""
    sums = dict(loads)
    for name, wrench in others.items():
        own = tuple(magnitude * x for x in wrench)
        sums[name] = tuple(a + b for a, b in zip(sums[name], own, strict=True)) if name in sums else own
    return sums


class _Loose(Kinematics[Scalar, Scalar]):
    """Every frame moves by itself: its turning rates and the velocity of its origin are symbols."""

    def __init__(self, mechanics: System) -> None:
        super().__init__(mechanics.bodies.mechanism, mechanics.bodies.scalars)
        self._graph: Graph = mechanics.graph

    def symbols(self, name: str) -> Six:
        """Turning rates and velocity in the frame's axes."""
        return tuple(self._graph.stand_in(f"{name} {kind}") for kind in ("wx", "wy", "wz", "vx", "vy", "vz"))

    def _own_twist(self, name: str) -> Twist[Scalar]:
        a, b, c, x, y, z = self.symbols(name)
        return Twist((a, b, c), (x, y, z))

    def _carried_twist(self, frame: str, axes: str) -> Twist[Scalar]:
        """In the axes of an ancestor: that of the parent, and what the frame's own joint adds."""
        space, joint, parent = self.space, self.joint(frame), self.frames[frame].parent
        matrix, carrier = self._below(axes, parent)[0], self._twists[parent, parent]
        angular = space.turned(matrix, carrier.angular)
        arm = space.crossed(angular, applied(matrix, joint.place))
        linear = space.summed(space.turned(matrix, carrier.linear), arm)
        linear = space.summed(linear, space.turned(matrix, joint.place_rate))
        return Twist(space.summed(angular, space.turned(matrix, joint.turning_before)), linear)


def _names(mechanics: System, stand_ins: Mapping[str, Scalar]) -> dict[str, Scalar]:
    """The names of formulas with symbols in place of components of points and frames."""
    graph, model = mechanics.graph, mechanics.model
    names = {
        **{c.name: node for c, node in zip(model.coordinates, mechanics.q, strict=True)},
        **{c.rate: node for c, node in zip(model.coordinates, mechanics.qd, strict=True)},
        **{p.name: node for p, node in zip(model.parameters, mechanics.parameters, strict=True)},
        **{d.name: mechanics.names[d.name] for d in definitions_before_frames(model)},
        **stand_ins,
    }
    for definition in model.definitions:
        if definition.name not in names:
            names[definition.name] = translate(graph, definition.value, names)
    return names
