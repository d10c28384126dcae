"""u by elimination: of forces, until a small core is left; u follows from it, internal forces come out.

Where M selects rows, the passive rows give the multipliers and the drive rows give u; in general inputs are unknowns
like the multipliers.  N_B, B B^T or any choice of coordinates do not occur.

All steps of the elimination are invertible.  So the core loses rank exactly where [M, B^T] does, an input
singularity; beside regular ones the internal forces Z = (inputs that do no work along any motion) lose rank exactly
where B does, because a force of B^T alone would then be in balance.  The method is valid at every regular
configuration.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import ActuationForms, RowForms, cross_product, unit, wedge_all
from symgen.linear_algebra.guards import Guard, beside_lengths, magnitude
from symgen.linear_algebra.null_space.null_spaces import LONGEST_PRODUCT, HouseholderSpace
from symgen.linear_algebra.square import by_rows
from symgen.mechanics.absolute_angles import AbsoluteAngles, absolute_angles
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.methods.admission import OfInputs, ranks
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.symbolic.matrix import Matrix, Vector, dot, transpose
from symgen.symbolic.polynomials.content import divided, usual_number
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.transplant import transplanted
from symgen.symbolic.traverse import cost, substitute

# Rows of a core up to which it is solved by minors: with more, these grow faster than reflections.
LARGEST_CORE_BY_MINORS = 3


def elimination_candidate(
    mechanics: System, generic: Genericity, steps: Callable[[System], Elimination] = Elimination
) -> Candidate | None:
    """u by elimination, or None where it does not apply; `mechanics` may be in absolute angles.

    Needs full actuation and independent constraints.  `steps` makes the elimination.
    """
    if not generic.full_actuation or generic.rank < generic.r:
        return None
    elimination = steps(mechanics)
    elimination.reduce()
    names, rows = elimination.names, elimination.core
    internal = generic.m - generic.delta
    if len(names) - len(rows) != internal:
        return None
    graph = mechanics.graph
    core = tuple(tuple(row.coefficients.get(j, graph.zero) for j in names) for row in rows)
    solved = _CoreEquations(elimination, mechanics, names, core, tuple(row.right for row in rows))
    definite = Definite(mechanics)
    u, guards = solved.inputs(internal)
    open_guards = [guard for guard in guards if not definite.holds(guard.denominator)]
    back = _symbols_back(mechanics, mechanics.change) | _positive_sizes(mechanics)
    outputs = tuple(substitute(graph, u, back))
    moved = [_moved(graph, guard, back) for guard in open_guards]
    own = substitute(graph, mechanics.balance, back)
    return solved_for_u(MethodInput(mechanics, generic), outputs, moved, own)


class _CoreEquations:
    """The rows A x = b that elimination leaves, solved for any x, and the inputs that belong to it."""

    def __init__(
        self, elimination: Elimination, mechanics: System, names: Sequence[int], core: Matrix, right: Vector
    ) -> None:
        self._elimination, self._mechanics, self._graph = elimination, mechanics, mechanics.graph
        self._names, self._core, self._right = names, core, right
        self._size, self._factoring = len(core), mechanics.factoring

    def inputs(self, internal: int) -> tuple[Vector, tuple[Guard, ...]]:
        """The u of least norm, and the guards of the core and of the internal forces."""
        guards: list[Guard] = []
        measure: Scalar | None
        if self._size == 0:
            particular: Vector = (self._graph.zero,) * len(self._names)
            null = [tuple(self._graph.one if i == j else self._graph.zero for j in self._names) for i in self._names]
            measure = self._graph.one
            if self._elimination.lengths():
                guards.append(self._tested(measure, measure, 1))
        elif self._size <= LARGEST_CORE_BY_MINORS and internal <= 1:
            particular, null, guard, measure = self._by_minors(internal)
            guards.append(guard)
        else:
            square = not internal and self._size <= LONGEST_PRODUCT
            particular, null, guard = self._by_rows() if square else self._by_reflections()
            measure = None
            guards.append(guard)
        u = self._inputs_of(particular, homogeneous=False)
        z = [self._inputs_of(vector, homogeneous=True) for vector in null]
        # at an input singularity the internal forces vanish with the core's minors: the core stands first
        if internal == 1:
            u, more = self._without_direction(u, z[0], measure)
            guards += more
        elif internal > 1:
            u, more = self._without_directions(u, tuple(z))
            guards += more
        return u, tuple(guards)

    def _inputs_of(self, values: Vector, homogeneous: bool) -> Vector:
        return self._elimination.values(dict(zip(self._names, values, strict=True)), homogeneous)

    def _by_minors(self, internal: int) -> tuple[Vector, list[Vector], Guard, Scalar]:
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
        null = [cross_product(graph, self._core, len(self._names))] if internal else []
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
        lengths = self._elimination.lengths()
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
        solution = by_rows(graph, self._core, self._right, everywhere=bool(self._elimination.lengths()))
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
        if self._elimination.lengths() or self._mechanics.twist_determinant.constant is None:
            rows = self._elimination.multipliers_alone or self._mechanics.coordinate_rows
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
            content = self._elimination.content(z)
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


def _symbols_back(mechanics: System, change: AbsoluteAngles | None) -> dict[Scalar, Scalar]:
    """The symbols of absolute angles in terms of the model's."""
    if change is None:
        return {}
    graph, model = mechanics.graph, mechanics.model
    replacements: dict[Scalar, Scalar] = {}
    given = (
        (mechanics.q, [c.name for c in model.coordinates]),
        (mechanics.qd, [c.rate for c in model.coordinates]),
        (mechanics.qdd, [c.acceleration for c in model.coordinates]),
    )
    for own, names in given:
        absolute = change.absolute(tuple(graph.symbol(name) for name in names))
        replacements |= dict(zip(own, absolute, strict=True))
    return replacements


def _positive_sizes(mechanics: System) -> dict[Scalar, Scalar]:
    """|p| = p for parameters that are declared positive.

    Not for those that are so by nature: an offset in metres may be turned round at run time, and the size of a
    denominator that is not negative then is what keeps its test.
    """
    graph = mechanics.graph
    positive = [graph.symbol(p.name) for p in mechanics.model.parameters if p.range is not None and p.range[0] > 0]
    return {graph.function("abs", (p,)): p for p in positive}


def _moved(graph: Graph, guard: Guard, back: dict[Scalar, Scalar]) -> Guard:
    assert guard.scale is not None
    denominator, scale = substitute(graph, [guard.denominator, guard.scale], back)
    first = tuple(_moved(graph, cause, back) for cause in guard.first)
    return replace(guard, denominator=denominator, first=first, scale=scale)


def _elimination(workspace: Workspace) -> Candidate | str:
    system = _in_body_axes(workspace, workspace.fresh())
    if system.driven is not None:
        return system.driven
    made = elimination_candidate(_in_absolute_angles(system.mechanics), system.generic)
    if made is None:
        return "its steps leave more than a few rows, or M does not select rows"
    return replace(made, system=system)


def _in_body_axes(workspace: Workspace, system: MethodInput) -> MethodInput:
    """The system with the twists of free bodies for rates, where its equations count less that way."""
    if not workspace.model.mechanism.has_mass:
        return system
    from symgen.mechanics.rigid_bodies.free_bodies import free_bodies  # models given by energies start without it

    if not free_bodies(system.mechanics):
        return system
    from symgen.mechanics.rigid_bodies.body_axes import BodyAxes

    turned = MethodInput(BodyAxes(workspace.model, workspace.lumped), workspace.generic)
    return turned if cost(turned.given).weight < cost(system.given).weight else system


def _in_absolute_angles(mechanics: System) -> System:
    """The system in absolute angles, where it has relative ones and its rates are those of the coordinates."""
    if not mechanics.twist_determinant.is_one:
        return mechanics
    change = absolute_angles(mechanics.q, mechanics.constraint_jacobian)
    return mechanics if change.is_identity else System(mechanics.model, mechanics, change, mechanics.lumped)


def _rest(workspace: Workspace, candidate: Candidate) -> list[Scalar]:
    """Minors, or else what the elimination's invertible steps leave."""
    return ranks(workspace, candidate) or [guard.denominator for guard in candidate.derived.guards]


ELIMINATION: Method = OfInputs(_elimination, _rest)
