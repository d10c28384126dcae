"""A system in absolute angles, and what was derived there in terms of the model's coordinates again.

Accelerations of a chain in relative angles are badly scaled: with each link more its G has larger entries in the
corner and a smaller smallest eigenvalue.  In absolute angles G keeps the links' own sizes, and q_ddot = S y_ddot takes
one difference for each joint (lambda and u stay as they are).
"""

from __future__ import annotations

from dataclasses import replace

from symgen.mechanics.absolute_angles import absolute_angles
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.motion import Motion
from symgen.methods.graphs import GraphCopy
from symgen.methods.quantity import Quantity
from symgen.model.model import Model
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar


def in_absolute_angles(model: Model) -> System | None:
    """The system in absolute angles on a graph of its own; None where no angle is relative to another."""
    mechanics = System(model)
    change = absolute_angles(mechanics.q, mechanics.constraint_jacobian)
    return None if change.is_identity else System(model, mechanics, change)


def brought_back(graph: Graph, mechanics: System, derived: Quantity) -> Quantity:
    """q_ddot or lambda that was derived on `mechanics` in absolute angles, on `graph` in the symbols of the model.

    Carried over as they stand: beside the nodes they were derived from, equal functions would take their place.
    """
    assert mechanics.change is not None
    outputs = mechanics.change.relative(derived.outputs) if derived.name == "forward_dynamics" else derived.outputs
    there = GraphCopy(graph, _of_the_model(graph, mechanics))
    guards = there.guards(derived.guards)
    return replace(derived, outputs=there.scalars(outputs), guards=guards)


def motion_brought_back(graph: Graph, mechanics: System | None, motion: Motion) -> Motion:
    """The same for q_ddot and lambda together; in the coordinates they have where no `mechanics` are given."""
    change = None if mechanics is None else mechanics.change
    accelerations = motion.accelerations if change is None else change.relative(motion.accelerations)
    there = GraphCopy(graph, {} if mechanics is None or change is None else _of_the_model(graph, mechanics))
    return replace(
        motion,
        accelerations=there.scalars(accelerations),
        multipliers=there.scalars(motion.multipliers),
        guards=there.guards(motion.guards),
        divisors=there.scalars(motion.divisors),
    )


def _of_the_model(graph: Graph, mechanics: System) -> dict[str, Scalar]:
    """The symbols of absolute angles, by name, in terms of the model's coordinates."""
    change, coordinates = mechanics.change, mechanics.model.coordinates
    assert change is not None
    symbols: dict[str, Scalar] = {}
    for own, names in (
        (mechanics.q, [c.name for c in coordinates]),
        (mechanics.qd, [c.rate for c in coordinates]),
        (mechanics.qdd, [c.acceleration for c in coordinates]),
    ):
        given = change.absolute(tuple(map(graph.symbol, names)))
        symbols |= {str(symbol.payload): value for symbol, value in zip(own, given, strict=True)}
    return symbols
