"""Rows by the places of the points that they hold: how these move, and what that asks of accelerations.

B_dot v along v is what a row asks for while no rate changes.  Differentiating B v turns every product of rotations in
it anew for each point; the places of several points of one frame share the second derivatives of its axes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import TYPE_CHECKING

from symgen.mechanics.bodies import Vector3
from symgen.model.kinematics.components import components_in, without_components
from symgen.model.mechanism import WORLD, component
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Vector, dot, matvec
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import substitute

if TYPE_CHECKING:
    from symgen.mechanics.system import System

AXES = "xyz"


def with_leaves(mechanics: System, owners: Sequence[str]) -> tuple[dict[str, Scalar], dict[str, Vector3]]:
    """The names of formulas with symbols in place of the components of points, and these symbols."""
    graph, model = mechanics.graph, mechanics.model
    names, leaves = dict(mechanics.names), dict[str, Vector3]()
    for owner in owners:
        x, y, z = (graph.stand_in(f"{owner}.{axis} held") for axis in AXES)
        leaves[owner] = (x, y, z)
        names |= {f"{owner}.{axis}": leaf for axis, leaf in zip(AXES, (x, y, z), strict=True)}
    apart = without_components(model.definitions)
    for definition in model.definitions:
        if definition not in apart:
            names[definition.name] = translate(graph, definition.value, names)
    return names, leaves


def acceleration_bias(mechanics: System, velocity: Vector) -> Vector:
    """B_dot v along v: differentiating B v is cheaper than forming B_dot, and places where a frame has many."""
    graph, rows = mechanics.graph, mechanics.constraint_jacobian
    found = _by_places(mechanics, velocity)
    frozen = tuple(graph.stand_in(f"{c.name}_frozen rate") for c in mechanics.model.coordinates)
    left = [i for i in range(mechanics.r) if i not in found]
    products = matvec(graph, tuple(rows[i] for i in left), frozen)
    rates = derivative_along(graph, products, dict(zip(mechanics.q, velocity, strict=True)))
    others = substitute(graph, rates, dict(zip(frozen, velocity, strict=True)))
    found |= zip(left, others, strict=True)
    return tuple(found[i] for i in range(mechanics.r))


def _by_places(mechanics: System, velocity: Vector) -> dict[int, Scalar]:
    """B_dot v along v of the rows that hold frames in space by several points, by their numbers."""
    owners = _sharing(mechanics)
    if not owners:
        return {}
    graph, kinematics = mechanics.graph, mechanics.bodies.kinematics
    names, leaves = with_leaves(mechanics, owners)
    held = [leaf for three in leaves.values() for leaf in three]
    places = [place for owner in leaves for place in kinematics.position(owner)]
    # the velocity may depend on q, and stands still here all the same
    still = tuple(graph.stand_in(f"{c.name} standing rate") for c in mechanics.model.coordinates)
    moved = dict(zip(mechanics.q, still, strict=True))
    found_rates = derivative_along(graph, places, moved)
    bound = [*found_rates, *derivative_along(graph, found_rates, moved)]
    made = substitute(graph, bound, dict(zip(still, velocity, strict=True)))
    rates, accelerations = made[: len(places)], made[len(places) :]
    variables = (*mechanics.q, *held)
    along, frozen = ([graph.stand_in(f"{x.serial} {word}") for x in variables] for word in ("rate", "frozen rate"))
    values = [*velocity, *rates]
    back = dict(zip((*held, *along, *frozen), (*places, *values, *values), strict=True))
    found = {}
    for i, row in enumerate(mechanics.model.constraints):
        if row.kind != "geometric":
            continue
        slopes = gradient(graph, translate(graph, row.expression, names), list(variables))
        if all(slope.is_zero for slope in slopes[mechanics.n :]):
            continue
        (turned,) = derivative_along(graph, [dot(graph, slopes, frozen)], dict(zip(variables, along, strict=True)))
        whole = turned + dot(graph, slopes[mechanics.n :], accelerations)
        (found[i],) = substitute(graph, [whole], back)
    return found


def _sharing(mechanics: System) -> list[str]:
    """The points that rows may hold, of frames in space: where there are as many as axes, these are worth deriving."""
    kinematics = mechanics.bodies.kinematics
    owners = dict.fromkeys(component(name).owner for name in components_in(mechanics.model))
    of_frame = defaultdict[str, list[str]](list)
    for owner in owners:
        point = kinematics.points.get(owner)
        of_frame[owner if point is None else point.frame].append(owner)
    several = [(frame, points) for frame, points in of_frame.items() if frame != WORLD and len(points) >= len(AXES)]
    return [owner for frame, points in several if kinematics.plane(WORLD, frame) is None for owner in points]
