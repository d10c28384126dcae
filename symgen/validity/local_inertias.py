"""Whether G is positive definite, frame by frame: what a frame's own bodies show needs no others.

Articulated inertias are at least those of a frame's own bodies, because what is passed on inwards is never negative:
bodies with a negative moment, as identified values may have it, are left to other methods.
So a joint is sure where its own bodies resist it, and only frames without such bodies (the middle of a universal joint)
take in what the next frames outwards pass on.  Their pivots hold a few coordinates each and are proved or minimised one
by one: the pivots of a long chain itself would be small numbers beside its diagonal entries, and a search in all its
coordinates long.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property, lru_cache

from symgen.mechanics.never_zero import Definite
from symgen.mechanics.rigid_bodies.articulated_inertias import ArticulatedFactor, Six
from symgen.mechanics.system import System
from symgen.model.checks.bodies import unsound_bodies
from symgen.model.configurations.mechanics import default_values
from symgen.model.model import Model
from symgen.symbolic.matrix import Matrix, dot
from symgen.symbolic.scalar import Scalar
from symgen.validity.definiteness import SMALLEST, smallest


def definite_by_frames(mechanics: System, factor: ArticulatedFactor) -> bool:
    """Whether every pivot of the factor is positive at every configuration, for parameters in their ranges."""
    if unsound_bodies(mechanics.model.mechanism, default_values(mechanics.model.parameters)):
        return False
    definite = Definite(mechanics)
    single = all(len(own) < 2 for own in factor.directions.values())
    if single and all(definite.holds(own) for own in factor.own.values()):
        return True
    return _definite_apart(mechanics.model)


@lru_cache(maxsize=2)  # asked for each quantity, by each method
def _definite_apart(model: Model) -> bool:
    """The same on a graph of its own, so that no kernel shares what is looked at here."""
    apart = System(model)
    definite = _InertiasAtJoints(apart, ArticulatedFactor(apart.bodies)).definite
    apart.graph.dissolve()
    return definite


def definite_along_motion(mechanics: System, factor: ArticulatedFactor) -> bool:
    """Whether pivots of a system that moves freely vanish only where its motion is not determined."""
    sound = not unsound_bodies(mechanics.model.mechanism, default_values(mechanics.model.parameters))
    return sound and not any(pivot.is_zero for pivot in factor.pivots)


class _InertiasAtJoints:
    """The joints of one factor, each with the inertia it is sure to meet."""

    def __init__(self, mechanics: System, factor: ArticulatedFactor) -> None:
        self._mechanics, self._factor, self._graph = mechanics, factor, factor.graph
        self._definite = Definite(mechanics)

    @cached_property
    def _sure(self) -> frozenset[str]:
        """The frames whose own bodies, or rotors, resist all motions of their joint."""
        return frozenset(name for name in self._factor.frames if self._own_bodies_resist(name))

    @cached_property
    def _alone(self) -> frozenset[str]:
        """Those whose own bodies are taken for all they carry: a joint that a rotor resists may have none."""
        return frozenset(name for name in self._sure if self._factor.bodies_of(name)[0])

    @property
    def definite(self) -> bool:
        """Whether all pivots are positive."""
        freed: dict[str, Matrix] = {}
        whole: dict[str, Matrix] = {}
        sizes = self._factor.sizes(self._alone)
        for name in reversed(self._factor.frames):
            inertia = composite = self._factor.own_inertia(name)
            if name not in self._alone:
                for child in self._factor.children(name):
                    inertia = _plus(inertia, self._factor.carried_inertia(child, freed[child]))
                    composite = _plus(composite, self._factor.carried_inertia(child, whole[child]))
            for coordinate, direction in reversed(self._factor.directions[name]):
                met = self._times(inertia, direction)
                rotor = self._factor.rotors.get(coordinate, self._graph.zero)
                pivot = self._dot(direction, met) + rotor
                entry = self._dot(direction, self._times(composite, direction)) + rotor
                size = self._factor.size(direction, sizes[name]) + rotor
                if name not in self._sure and not self._positive(pivot, entry, size):
                    return False
                share = tuple(x if x.is_zero else x / pivot for x in met)
                inertia = self._factor.freed(inertia, direction, met, share, rotor)
            freed[name], whole[name] = inertia, composite
        return True

    def _positive(self, pivot: Scalar, entry: Scalar, size: Scalar) -> bool:
        """Whether a pivot does not vanish beside its diagonal entry, nor that beside its terms."""
        if pivot.is_zero or entry.is_zero:
            return False
        if self._definite.holds(pivot):
            return True
        measures = [pivot / entry, entry / size]
        if any(measure.constant is not None and measure.constant <= 0 for measure in measures):
            return False
        return smallest(self._mechanics, measures)[0] > SMALLEST

    def _own_bodies_resist(self, name: str) -> bool:
        directions = [direction for _, direction in self._factor.directions[name]]
        if len(directions) < 2:
            return all(self._definite.holds(self._factor.own[j]) for j, _ in self._factor.directions[name])
        numbers = [[x.constant for x in direction] for direction in directions]
        constant = [[x for x in row if x is not None] for row in numbers]
        if any(len(row) < 6 for row in constant) or _rank(constant) < len(directions):
            return False
        masses, inertia = self._factor.bodies_of(name)
        if not self._definite.holds(self._graph.sum(masses)):
            return False
        turning = [row[:3] for row in constant if any(row[:3])]
        return self._resists_turning(inertia, turning)

    def _resists_turning(self, inertia: Matrix, axes: Sequence[Sequence[Fraction]]) -> bool:
        """Whether inertias about the centres of mass resist turning about all axes in the span of these."""
        if _rank(axes) == 0:
            return True
        if _rank(axes) == 1:
            axis = tuple(self._graph.const(x) for x in axes[0])
            return self._definite.holds(dot(self._graph, axis, [dot(self._graph, row, axis) for row in inertia]))
        (a, b, c), (_, d, e), (_, _, f) = inertia
        minors = (a, a * d - b * b, a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d))
        return all(self._definite.holds(minor) for minor in minors)

    def _times(self, inertia: Matrix, direction: Six) -> Six:
        return tuple(self._dot(row, direction) for row in inertia)

    def _dot(self, one: Sequence[Scalar], other: Sequence[Scalar]) -> Scalar:
        return dot(self._graph, one, other)


def _plus(one: Matrix, other: Matrix) -> Matrix:
    return tuple(tuple(a + b for a, b in zip(row, more, strict=True)) for row, more in zip(one, other, strict=True))


def _rank(rows: Sequence[Sequence[Fraction]]) -> int:
    """The exact rank, by elimination."""
    left, rank = [list(row) for row in rows], 0
    while left:
        pivot = left.pop()
        column = next((j for j, x in enumerate(pivot) if x), None)
        if column is not None:
            rank += 1
            left = [[x - row[column] / pivot[column] * y for x, y in zip(row, pivot, strict=True)] for row in left]
    return rank
