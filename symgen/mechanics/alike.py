"""Bodies that take the same operations: their inertial wrenches as one function, evaluated for each.

Between the way outwards, which finds how all frames move, and the way inwards, which adds up forces, every body needs
its inertial wrench for itself.  Written as one function of the motion and the inertia, with nothing left out that
vanishes for some bodies, two of them can be computed in the lanes of vectors; that takes some operations more than
the recursion in which each body shares what it can with its neighbours, and fewer instructions.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import islice

from symgen.mechanics.bodies import Vector3
from symgen.mechanics.newton_euler import FrameMotion, Wrench, inertial_wrench, motion, newton_euler
from symgen.mechanics.system import System
from symgen.model.mechanism import Body
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.matrix import Vector
from symgen.symbolic.passes.grouping import grouped
from symgen.symbolic.scalar import Graph
from symgen.symbolic.traverse import cost

# What the function takes: motion, mass, centre of mass, inertia tensor about it.
_MOTION = ("w_x", "w_y", "w_z", "dw_x", "dw_y", "dw_z", "a_x", "a_y", "a_z")
_INERTIA = ("m", "c_x", "c_y", "c_z", "I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
_RESULTS = ("N_x", "N_y", "N_z", "F_x", "F_y", "F_z")
# Entries known to vanish up to which a body takes the function: with more it has much less to compute.
MOST_KNOWN = 2
# Bodies computed side by side.
TOGETHER = 2
# Share of operations more that two bodies side by side are worth.
LANES_WORTH = Fraction(1, 8)


@dataclass(frozen=True, slots=True)
class Alike:
    """Inputs of a system in which `results` of a function of bodies are symbols, on the graph of `mechanics`.

    `function` is that function of the symbols `names`, on a graph of its own; `arguments` and `results` are those of
    each body, first the one nearest to the root, for an even number of bodies.
    """

    mechanics: System
    inputs: Vector
    names: tuple[str, ...]
    function: Vector
    arguments: tuple[Vector, ...]
    results: tuple[Vector, ...]

    @property
    def weight(self) -> int:
        """The counted cost with the function evaluated for all bodies."""
        around = cost([*self.inputs, *(x for one in self.arguments for x in one)]).weight
        return around + len(self.arguments) * cost(self.function).weight


def alike_bodies(model: Model, outputs: Vector) -> Alike | None:
    """u by a function of bodies, where that is worth it in place of `outputs`; None else.

    Looked at are systems without constraints in which every input drives one coordinate.
    """
    if model.constraints or model.allocation is not None:
        return None
    system = _Named(model)
    driven = _driven(system)
    if driven is None:
        return None
    inputs = tuple(system.balance[j] for j in driven)
    if len(system.named) % TOGETHER:
        # that nearest to the root has least to compute
        system = _Named(model, next(iter(system.named)))
        inputs = tuple(system.balance[j] for j in driven)
    if not system.named:
        return None
    arguments, results = zip(*system.named.values(), strict=True)
    names, function = _function()
    around = [*inputs, *(x for one in arguments for x in one)]
    shorter = iter(grouped(system.graph, system.factoring, around))
    inputs = tuple(islice(shorter, len(inputs)))
    arguments = tuple(tuple(islice(shorter, len(names))) for _ in arguments)
    found = Alike(system, inputs, names, function, arguments, results)
    return found if found.weight <= cost(outputs).weight * (1 + LANES_WORTH) else None


def _driven(mechanics: System) -> list[int] | None:
    """The coordinate that each input drives, with nothing between them; None where there are others."""
    found = []
    for column in mechanics.inputs:
        places = [j for j, entry in enumerate(column) if not entry.is_zero]
        if len(places) != 1 or not column[places[0]].is_one:
            return None
        found += places
    return found if sorted(found) == list(range(mechanics.n)) else None


def _function() -> tuple[tuple[str, ...], Vector]:
    """The names of what it takes and the inertial wrench of any body."""
    graph = Graph()
    names = (*_MOTION, *_INERTIA)
    x = [graph.symbol(name) for name in names]
    tensor = ((x[13], x[16], x[17]), (x[16], x[14], x[18]), (x[17], x[18], x[15]))
    moving = motion((x[0], x[1], x[2]), (x[3], x[4], x[5]), (x[6], x[7], x[8]))
    wrench = inertial_wrench(moving, x[9], (x[10], x[11], x[12]), tensor)
    # moments need the forces: taken first, they leave fewer values waiting
    return names, (*wrench.moment, *wrench.force)


class _Named(System):
    """A system whose balance has names for what its bodies take; `but` is a body that stays as it is.

    `named` has arguments and results of the others, once the balance has been asked for.
    """

    def __init__(self, model: Model, but: str = "") -> None:
        super().__init__(model)
        self.named: dict[str, tuple[Vector, Vector]] = {}
        self._but = but

    def _forces_of_bodies(self, acceleration: Vector, gravity: Vector3) -> Vector:
        return newton_euler(self.bodies, self.qd, acceleration, gravity, named=self._name)

    def _name(self, body: Body, moving: FrameMotion) -> Wrench | None:
        mass, com = self.bodies.scalars.value(body.mass), self.bodies.kinematics.space.values(body.com)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = self.bodies.inertia(body.name)
        given = (*moving.velocity, *moving.acceleration, *moving.linear, mass, *com, xx, yy, zz, xy, xz, yz)
        if body.name == self._but or sum(x.constant is not None for x in given) > MOST_KNOWN:
            return None
        # no name of a model has a blank
        found = tuple(self.graph.stand_in(f"{name} of {body.name}") for name in _RESULTS)
        self.named[body.name] = given, found
        return Wrench((found[3], found[4], found[5]), (found[0], found[1], found[2]))
