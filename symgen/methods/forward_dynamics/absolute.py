"""A system in absolute angles, and what was derived there in terms of the model's coordinates again.

Accelerations of a chain in relative angles are badly scaled: with each link more its G has larger entries in the
corner and a smaller smallest eigenvalue.  In absolute angles G keeps the links' own sizes, and q_ddot = S y_ddot takes
one difference for each joint (lambda and u stay as they are).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.absolute_angles import absolute_angles
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.motion import MotionMethod
from symgen.model.model import Model
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.transplant import transplanted

if TYPE_CHECKING:
    from symgen.methods.quantity import Quantity


def in_absolute_angles(model: Model) -> System | None:
    """The system in absolute angles on a graph of its own; None where no angle is relative to another."""
    mechanics = System(model)
    change = absolute_angles(mechanics.graph, mechanics.q, mechanics.constraint_jacobian)
    return None if change.is_identity else System(model, mechanics, change)


def brought_back(graph: Graph, mechanics: System, derived: Quantity) -> Quantity:
    """q_ddot or lambda that was derived on `mechanics` in absolute angles, on `graph` in the symbols of the model.

    Carried over as they stand: beside the nodes they were derived from, equal functions would take their place.
    """
    assert mechanics.change is not None
    outputs = mechanics.change.relative(derived.outputs) if derived.name == "forward_dynamics" else derived.outputs
    symbols = _of_the_model(graph, mechanics)
    guards = tuple(_moved(graph, guard, symbols) for guard in derived.guards)
    return replace(derived, outputs=tuple(transplanted(graph, outputs, symbols)), guards=guards)


def motion_brought_back(graph: Graph, mechanics: System | None, motion: MotionMethod) -> MotionMethod:
    """The same for q_ddot and lambda together; in the coordinates they have where no `mechanics` are given."""
    change = None if mechanics is None else mechanics.change
    accelerations = motion.accelerations if change is None else change.relative(motion.accelerations)
    symbols = {} if mechanics is None or change is None else _of_the_model(graph, mechanics)
    return replace(
        motion,
        accelerations=tuple(transplanted(graph, accelerations, symbols)),
        multipliers=tuple(transplanted(graph, motion.multipliers, symbols)),
        guards=tuple(_moved(graph, guard, symbols) for guard in motion.guards),
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


def _moved(graph: Graph, guard: Guard, symbols: Mapping[str, Scalar]) -> Guard:
    (denominator,) = transplanted(graph, [guard.denominator], symbols)
    scale = None if guard.scale is None else transplanted(graph, [guard.scale], symbols)[0]
    first = tuple(_moved(graph, cause, symbols) for cause in guard.first)
    return replace(guard, denominator=denominator, scale=scale, first=first)
