"""Rows by the components of points and frames that they hold: their derivatives, by each coordinate and along rates.

B_dot v along v is what a row asks for while no rate changes.  Rows, and B v, are differentiated as they stand, or by
what they hold, whichever counts less.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from symgen.mechanics.held_components import HeldComponents
from symgen.mechanics.rigid_bodies.bodies import Vector3
from symgen.model.kinematics.components import components_in, without_components
from symgen.model.mechanism import component
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import Matrix, Vector, dot, matvec
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import cost, reached, substitute

if TYPE_CHECKING:
    from symgen.mechanics.system import System

AXES = "xyz"


def with_leaves(mechanics: System, owners: Sequence[str]) -> tuple[dict[str, Scalar], dict[str, Vector3]]:
    """The names of formulas with symbols in place of the places of points, and these symbols."""
    leaves = dict[str, Vector3]()
    for owner in owners:
        x, y, z = (mechanics.graph.stand_in(f"{owner}.{axis} held") for axis in AXES)
        leaves[owner] = (x, y, z)
    given = {f"{owner}.{axis}": leaf for owner, three in leaves.items() for axis, leaf in zip(AXES, three, strict=True)}
    return _with_names(mechanics, given), leaves


def _with_names(mechanics: System, given: Mapping[str, Scalar]) -> dict[str, Scalar]:
    """The names of formulas where components are these."""
    names = {**mechanics.names, **given}
    apart = without_components(mechanics.model.definitions)
    for definition in mechanics.model.definitions:
        if definition not in apart:
            names[definition.name] = translate(mechanics.graph, definition.value, names)
    return names


class HeldRows:
    """The geometric rows of a system, with the components that they hold as symbols of their own."""

    def __init__(self, mechanics: System) -> None:
        graph = self._graph = mechanics.graph
        self._mechanics = mechanics
        self._components = HeldComponents(mechanics.bodies)
        known = [name for name in components_in(mechanics.model) if self._components.is_known(component(name))]
        self.leaves = {name: graph.stand_in(f"{name} held") for name in known}
        names = _with_names(mechanics, self.leaves)
        rows = [row.expression for row in mechanics.model.constraints if row.kind == "geometric"]
        self._residual = [translate(graph, row, names) for row in rows]
        used = reached(self._residual)
        self.leaves = {name: leaf for name, leaf in self.leaves.items() if leaf in used}
        self._values = {leaf: mechanics.names[name] for name, leaf in self.leaves.items()}

    @property
    def _variables(self) -> list[Scalar]:
        return [*self._mechanics.q, *self.leaves.values()]

    @cached_property
    def _slopes(self) -> list[list[Scalar]]:
        """Of each row, the derivatives by coordinates, then by what it holds."""
        return [gradient(self._graph, residual, self._variables) for residual in self._residual]

    @cached_property
    def jacobian(self) -> Matrix:
        """The rows of B that stem from geometric constraints."""
        graph, n = self._graph, self._mechanics.n
        moved = [self._components.slopes(component(name)) for name in self.leaves]
        rows = []
        for slopes in self._slopes:
            terms: list[list[Scalar]] = [[slope] for slope in slopes[:n]]
            for slope, by_coordinate in zip(slopes[n:], moved, strict=True):
                for k, entry in by_coordinate.items() if not slope.is_zero else ():
                    terms[k].append(slope * entry)
            rows.append(tuple(substitute(graph, [graph.sum(entries) for entries in terms], self._values)))
        return tuple(rows)

    def bias(self, velocity: Vector) -> Vector:
        """B_dot v along v."""
        graph, mechanics = self._graph, self._mechanics
        accelerations = [self._components.acceleration(component(name)) for name in self.leaves]
        rates = derivative_along(graph, list(self._values.values()), dict(zip(mechanics.q, mechanics.qd, strict=True)))
        along, frozen = ([graph.stand_in(f"{x.serial} {word}") for x in self._variables] for word in ("rate", "frozen"))
        back = {**self._values, **dict(zip((*along, *frozen), (*mechanics.qd, *rates) * 2, strict=True))}
        entries = []
        for slopes in self._slopes:
            moving = dict(zip(self._variables, along, strict=True))
            (turned,) = derivative_along(graph, [dot(graph, slopes, frozen)], moving)
            entries.append(turned + dot(graph, slopes[mechanics.n :], accelerations))
        # the velocity may depend on q, and stands still here all the same
        made = substitute(graph, entries, back)
        return tuple(substitute(graph, made, dict(zip(mechanics.qd, velocity, strict=True))))


def geometric_jacobian(mechanics: System) -> Matrix:
    """dg/dq: of the rows as they stand, or by what they hold."""
    graph = mechanics.graph
    plain: Matrix = tuple(tuple(gradient(graph, g, mechanics.q)) for g in mechanics.constraint_residual)
    held = mechanics.held_rows
    return min((plain, held.jacobian), key=_weight) if held.leaves else plain


def acceleration_bias(mechanics: System, velocity: Vector) -> Vector:
    """B_dot v along v: differentiating B v is cheaper than forming B_dot."""
    graph, rows = mechanics.graph, mechanics.constraint_jacobian
    frozen = tuple(graph.stand_in(f"{c.name}_frozen rate") for c in mechanics.model.coordinates)
    rates = derivative_along(graph, matvec(graph, rows, frozen), dict(zip(mechanics.q, velocity, strict=True)))
    plain = tuple(substitute(graph, rates, dict(zip(frozen, velocity, strict=True))))
    if not mechanics.held_rows.leaves:
        return plain
    held = mechanics.held_rows.bias(velocity)
    least = min((plain[: len(held)], held), key=lambda row: _weight([row]))
    return (*least, *plain[len(held) :])


def _weight(rows: Iterable[Vector]) -> int:
    counted = cost([entry for row in rows for entry in row])
    return counted.weight + counted.signs
