"""Weights and forces that do no work along any motion that the rows allow, wherever the system is: the rows bear them.

The weight of a rod between two balls that stand still is one, or of what turns about the vertical.  Such forces are
sums of rows of B, so N_B takes them off, and u, accelerations and all that is projected do not depend on them; the
multipliers do.  Projected in floating point they leave a rounding of themselves, which is all there is where nothing
else acts.

A force is one if it is a sum of rows at a point where coordinates and parameters are residues at random (Schwartz and
Zippel); so it is one beside the constraints, too.  Forces that rows bear on the constraints alone are left as they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

from symgen.linear_algebra.residue_rows import ReducedRows, what_is_left, with_row
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.model.expressions.expression import Binary, Expression, Negation
from symgen.model.mechanism import NO_VECTOR, ZERO
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.angles.circle import FIELD
from symgen.symbolic.calculus import gradient
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.matrix import Vector
from symgen.symbolic.translate import translate

# Quantities that do not depend on such forces.
WITHOUT_WORKLESS = frozenset({
    "inverse_dynamics",
    "inverse_dynamics_residual",
    "forward_dynamics",
    "projected_potential_force",
    "projected_applied_force",
    "minimal_potential_force",
    "minimal_applied_force",
})
# Points in the prime field that are tried: at each of them every second root has a value there.
MOST_POINTS = 8


@dataclass(frozen=True, slots=True)
class WorklessForces:
    """What the rows bear: all weights of bodies, terms of the written potential, force elements, loads of coordinates.

    Terms are told by their numbers in the order of the sum, forces and loads by theirs in the model.
    """

    weights: bool = False
    terms: frozenset[int] = frozenset()
    forces: frozenset[int] = frozenset()
    loads: frozenset[int] = frozenset()

    def __bool__(self) -> bool:
        return self.weights or bool(self.terms or self.forces or self.loads)


@lru_cache(maxsize=1)
def workless_forces(model: Model, generic: Genericity) -> WorklessForces:
    """Those of a model, on a graph of its own; none where friction grows with what the rows bear.

    Nothing is said where rows lose rank on the constraints: off these more of them are independent.  Methods ask, and
    then what tells of things that a system does not need.
    """
    weighs, stores = model.mechanism.gravity != NO_VECTOR, model.potential_energy != ZERO
    if not generic.r or model.rough or not (weighs or stores or model.has_applied_forces):
        return WorklessForces()
    mechanics = System(model)
    borne = _Borne(mechanics, generic.rank)
    names = [c.name for c in model.coordinates]
    axes = [tuple(mechanics.graph.const(int(c.coordinate == name)) for name in names) for c in model.applied_forces]
    return WorklessForces(
        weights=weighs and mechanics.bodies.weights_work and borne.is_one(weights(mechanics)),
        terms=frozenset(_terms(mechanics, borne)) if stores else frozenset(),
        forces=frozenset(k for k, one in enumerate(model.forces) if borne.is_one(mechanics.worked_on(one.velocity))),
        loads=frozenset(k for k, axis in enumerate(axes) if borne.is_one(axis)),
    )


def without_workless_forces(model: Model, workless: WorklessForces) -> Model:
    """The model without them, which has the same u and accelerations, and other multipliers."""
    kept = [term for k, term in enumerate(_addends(model.potential_energy)) if k not in workless.terms]
    mechanism = replace(model.mechanism, gravity=NO_VECTOR) if workless.weights else model.mechanism
    return replace(
        model,
        mechanism=mechanism,
        potential_energy=_sum(kept) if workless.terms else model.potential_energy,
        forces=tuple(one for k, one in enumerate(model.forces) if k not in workless.forces),
        applied_forces=tuple(one for k, one in enumerate(model.applied_forces) if k not in workless.loads),
    )


class _Borne:
    """The forces that are sums of rows, at points in a prime field where these have the rank that they have on V."""

    def __init__(self, mechanics: System, rank: int) -> None:
        self._rows, self._rank = mechanics.constraint_jacobian, rank
        self._points: list[tuple[ReducedRows | None, ExactValues]] = []

    def is_one(self, force: Vector) -> bool:
        """Whether a generalized force is a sum of rows; no where its values are not in the field at any point."""
        for rows, values in self._each():
            whole = _whole(values, force)
            if rows is not None and whole is not None:
                return not any(what_is_left(rows, whole, FIELD.prime))
        return False

    def _each(self) -> Iterator[tuple[ReducedRows | None, ExactValues]]:
        """The points, with the rows there in reduced form; None where these are of no use."""
        for seed in range(MOST_POINTS):
            if seed == len(self._points):
                values = ExactValues(seed, signs=False)
                self._points.append((self._reduced(values), values))
            yield self._points[seed]

    def _reduced(self, values: ExactValues) -> ReducedRows | None:
        reduced: dict[int, Sequence[int]] = {}
        for row in self._rows:
            if (whole := _whole(values, row)) is None:
                return None
            reduced = with_row(reduced, whole, FIELD.prime)
        return reduced if len(reduced) == self._rank else None


def _whole(point: ExactValues, vector: Vector) -> list[int] | None:
    """The values of a vector, None where one is not in the field: the root of what is negative there."""
    values = point(vector)
    whole = [value for value in values if isinstance(value, int)]
    return whole if len(whole) == len(values) else None


def weights(mechanics: System) -> Vector:
    """The slopes of the potential of all bodies' weights."""
    return tuple(gradient(mechanics.graph, mechanics.bodies.potential_energy, mechanics.q))


def _terms(mechanics: System, borne: _Borne) -> Iterator[int]:
    """The terms of the written potential that the rows bear: all where they bear the sum."""
    terms = list(_addends(mechanics.model.potential_energy))
    if borne.is_one(_slopes(mechanics, mechanics.model.potential_energy)):
        yield from range(len(terms))
    elif len(terms) > 1:
        yield from (k for k, term in enumerate(terms) if borne.is_one(_slopes(mechanics, term)))


def _slopes(mechanics: System, energy: Expression) -> Vector:
    return tuple(gradient(mechanics.graph, translate(mechanics.graph, energy, mechanics.names), mechanics.q))


def _addends(expression: Expression) -> Iterator[Expression]:
    """The terms of a sum, those that are taken off with their sign."""
    if isinstance(expression, Binary) and expression.operator in ("+", "-"):
        yield from _addends(expression.left)
        yield from (_addends(expression.right) if expression.operator == "+" else (Negation(expression.right),))
    else:
        yield expression


def _sum(terms: Sequence[Expression]) -> Expression:
    total: Expression = ZERO
    for term in terms:
        total = term if total == ZERO else Binary("+", total, term)
    return total
