"""The rows A x = b that elimination leaves, solved for any x, and the u of least norm that belongs to it."""

from __future__ import annotations

from collections.abc import Callable

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import ActuationForms, RowForms, cross_product, unit, wedge_all
from symgen.linear_algebra.guards import Guard, beside_lengths, magnitude
from symgen.linear_algebra.null_space.null_spaces import LONGEST_PRODUCT, HouseholderSpace
from symgen.linear_algebra.square import by_rows
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, transpose
from symgen.symbolic.polynomials.content import divided, usual_number
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.transplant import transplanted
from symgen.symbolic.traverse import cost

# Rows of a core up to which it is solved by minors: with more, these grow faster than reflections.
LARGEST_CORE_BY_MINORS = 3


@dataclass(frozen=True, slots=True)
class CoreSolution:
    """u of least norm with the guards of the core and of the internal forces.

    `particular` and `null` are a solution of the core and the solutions of A x = 0, in the order of its unknowns.
    """

    u: Vector
    guards: tuple[Guard, ...]
    particular: Vector
    null: tuple[Vector, ...]


def core_equations(
    mechanics: System, generic: Genericity, steps: Callable[[System], Elimination]
) -> CoreEquations | None:
    """The core of a system, or None where elimination does not apply; `mechanics` may be in absolute angles.

    `steps` makes the elimination.
    """
    if not generic.full_actuation or generic.rank < generic.r:
        return None
    elimination = steps(mechanics)
    elimination.reduce()
    internal = generic.m - generic.delta
    applies = len(elimination.names) - len(elimination.core) == internal
    return CoreEquations(elimination, mechanics, internal) if applies else None


class CoreEquations:
    """The rows that elimination leaves, with as many internal forces as inputs are redundant."""

    def __init__(self, elimination: Elimination, mechanics: System, internal: int) -> None:
        self.elimination, self.internal = elimination, internal
        self._mechanics, self._graph = mechanics, mechanics.graph
        self._names, rows = elimination.names, elimination.core
        self._core = tuple(tuple(row.coefficients.get(j, self._graph.zero) for j in self._names) for row in rows)
        self._right = tuple(row.right for row in rows)
        self._size, self._factoring = len(rows), mechanics.factoring

    def solved(self) -> CoreSolution:
        """The u of least norm."""
        guards: list[Guard] = []
        measure: Scalar | None
        if self._size == 0:
            particular: Vector = (self._graph.zero,) * len(self._names)
            null = [tuple(self._graph.one if i == j else self._graph.zero for j in self._names) for i in self._names]
            measure = self._graph.one
            if self.elimination.lengths():
                guards.append(self._tested(measure, measure, 1))
        elif self._size <= LARGEST_CORE_BY_MINORS and self.internal <= 1:
            particular, null, guard, measure = self._by_minors()
            guards.append(guard)
        else:
            square = not self.internal and self._size <= LONGEST_PRODUCT
            particular, null, guard = self._by_rows() if square else self._by_reflections()
            measure = None
            guards.append(guard)
        u = self._inputs_of(particular, homogeneous=False)
        z = [self._inputs_of(vector, homogeneous=True) for vector in null]
        # at an input singularity the internal forces vanish with the core's minors: the core stands first
        if self.internal == 1:
            u, more = self._without_direction(u, z[0], measure)
            guards += more
        elif self.internal > 1:
            u, more = self._without_directions(u, tuple(z))
            guards += more
        return CoreSolution(u, tuple(guards), particular, tuple(null))

    def all_values(self, core: Vector, homogeneous: bool) -> Vector:
        """What belongs to unknowns of the core: all multipliers, then the inputs."""
        return self.elimination.all_values(dict(zip(self._names, core, strict=True)), homogeneous)

    def _inputs_of(self, values: Vector, homogeneous: bool) -> Vector:
        return self.elimination.values(dict(zip(self._names, values, strict=True)), homogeneous)

    def _by_minors(self) -> tuple[Vector, list[Vector], Guard, Scalar]:
        """A particular solution, the null vector if there is one, and what small minors make small."""
        if self._size == len(self._names) == LARGEST_CORE_BY_MINORS:
            return self._bordered()
        graph = self._graph
        forms = ActuationForms(RowForms(graph, (), self._size, 0), transpose(self._core, len(self._names)), self._size)
        denominator = forms.denominator()
        guard, measure = self._guarded(denominator, 1 if forms.single else 2)
        if self._size == 1 and not forms.single:
            # any solution serves, because internal forces are taken out of u afterwards
            share = self._right[0] / denominator
            particular = tuple(entry * share for entry in self._core[0])
        else:
            particular = forms.solve(self._right)
        null = [cross_product(graph, self._core, len(self._names))] if self.internal else []
        return particular, null, guard, measure

    def _bordered(self) -> tuple[Vector, list[Vector], Guard, Scalar]:
        """The solution of a square core as the null vector of [A, b].

        All its determinants share the minors of the rows that are multiplied first; which row comes last is counted.
        """
        rows = tuple((*row, right) for row, right in zip(self._core, self._right, strict=True))
        orders = [(*rows[:k], *rows[k + 1 :], rows[k]) for k in reversed(range(len(rows)))]
        *minors, denominator = cross_product(self._graph, min(orders, key=_null_vector_cost), len(rows) + 1)
        guard, measure = self._guarded(denominator, 1)
        inverse = 1 / denominator
        return tuple(-minor * inverse for minor in minors), [], guard, measure

    def _guarded(self, denominator: Scalar, degree: int) -> tuple[Guard, Scalar]:
        """The guard of the core's minors, and what they are of their bound."""
        scale = self._scale(denominator)
        return self._tested(denominator, scale, degree), denominator / scale

    def _tested(self, denominator: Scalar, scale: Scalar, degree: int) -> Guard:
        """The guard of the core, to which pivots belong, and with twists for rates the coordinates' own determinant.

        Each pivot is a direction of its own: several legs may be nearly stretched without any of them being so.
        """
        lengths = self.elimination.lengths()
        turns = self._mechanics.twist_determinant * self._graph.product(lengths)
        bound = magnitude(self._graph, [turns])[0]
        directions = len(lengths) + (denominator.constant is None)
        for _ in range(degree):
            denominator, scale = denominator * turns, scale * bound
        return Guard(Status.ACTUATION_RANK, denominator, degree, (self._regularity(),), scale, max(1, directions))

    def _scale(self, minors: Scalar) -> Scalar:
        """The sum of absolute terms, in which terms of minors that cancel in sign are equal, with factors taken out."""
        graph = self._graph
        (given,) = magnitude(graph, [minors])
        entries = [entry for row in self._core for entry in row]
        (shorter,) = self._factoring.shorten((given,), frozenset(magnitude(graph, entries)))
        number = usual_number([shorter])
        # a number in front becomes part of the threshold
        return min((given, number * divided(graph, shorter, number)), key=lambda scale: cost([scale]).weight)

    def _by_rows(self) -> tuple[Vector, list[Vector], Guard]:
        """The solution of a square core; its determinant is measured by the lengths of its rows."""
        graph = self._graph
        # off the constraints legs that are bodies may well be parallel inside the ranges of their coordinates
        solution = by_rows(graph, self._core, self._right, everywhere=bool(self.elimination.lengths()))
        measured = self._tested(graph.product(solution.squares), graph.product(solution.lengths), 2)
        return solution.values, [], measured

    def _by_reflections(self) -> tuple[Vector, list[Vector], Guard]:
        """The solution of least norm, an orthonormal null-space basis, and the product of the pivots."""
        space = HouseholderSpace(self._graph, self._core, len(self._names))
        measure = space.volume
        assert measure.scale is not None
        guard = self._tested(measure.denominator, measure.scale, 2)
        count = len(self._names) - self._size
        return space.lift(self._right), list(transpose(space.basis, count)) if count else [], guard

    def _unit_columns(self) -> list[Vector]:
        """What a unit of each unknown does to the inputs."""
        zero, one = self._graph.zero, self._graph.one
        return [
            self._inputs_of(tuple(one if i == j else zero for j in self._names), homogeneous=True) for i in self._names
        ]

    def _regularity(self) -> Guard:
        """Vanishes exactly where the rank of B drops: no force of multipliers alone is in balance.

        Inputs left in the core or for the end count as rows of their own, so that they are held at zero.
        """
        graph = self._graph
        # what was solved by tested pivots is no column of the core any more
        rows = self.elimination.multipliers_alone or self._mechanics.coordinate_rows
        # without rows there is no force of multipliers
        if rows and (self.elimination.lengths() or self._mechanics.twist_determinant.constant is None):
            return HouseholderSpace(graph, rows, len(rows[0])).volume
        whole = [
            (*column, *effect)
            for column, effect in zip(transpose(self._core, len(self._names)), self._unit_columns(), strict=True)
        ]
        if len(whole) > LARGEST_CORE_BY_MINORS:
            return HouseholderSpace(graph, tuple(whole), len(whole[0])).volume
        minors = wedge_all(unit(graph), whole)
        denominator = graph.sum(value * value for value in minors.values())
        lengths = [graph.sum(x * x for x in magnitude(graph, column)) for column in whole]
        return Guard(Status.CONSTRAINT_RANK, denominator, 2, scale=graph.product(lengths))

    def _without_direction(self, u: Vector, z: Vector, measure: Scalar | None) -> tuple[Vector, tuple[Guard, ...]]:
        """u - z (z . u) / (z . z); |z|^2 is measured by its terms, which are small where the core's minors are.

        Without a `measure` z is what a null vector of length 1 does: at most what all unknowns together do.
        """
        graph = self._graph
        if measure is None:
            scale = graph.sum(x * x for column in self._unit_columns() for x in column)
        else:
            content = self.elimination.content(z)
            z = tuple(graph.products.quotient(x, content) for x in z)
            scale = graph.sum(x * x for x in magnitude(graph, z)) * measure
        length = graph.sum(x * x for x in z)
        share = dot(graph, z, u) / length
        u = tuple(a - b * share for a, b in zip(u, z, strict=True))
        return u, (Guard(Status.CONSTRAINT_RANK, length, 2, scale=scale),)

    def _without_directions(self, u: Vector, z: Matrix) -> tuple[Vector, tuple[Guard, ...]]:
        """u less its components along several internal forces."""
        graph = self._graph
        space = HouseholderSpace(graph, z, len(u))
        length = graph.sum(x * x for column in self._unit_columns() for x in column)
        beside = space.reflections.combinations([length] * len(z))
        return space.project(u), beside_lengths(Status.CONSTRAINT_RANK, space.reflections.pivots, beside)


def _null_vector_cost(rows: Matrix) -> int:
    """What the null vector costs on a graph of its own: on the same one, orders would share each other's minors."""
    graph, n = Graph(), len(rows) + 1
    entries = transplanted(graph, [entry for row in rows for entry in row])
    there = tuple(tuple(entries[n * k : n * k + n]) for k in range(len(rows)))
    return cost(cross_product(graph, there, n)).weight
