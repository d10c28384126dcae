"""What friction of a model's rough places acts along, and what those carry: multipliers, or what joints are held by."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property

from symgen.mechanics.system import System
from symgen.model.kinematics.released import released_model
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.matrix import Matrix, Vector, dot, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import substitute


class RoughColumns:
    """The rough places of one system; joints whose reactions are no multipliers are let go in a second one."""

    def __init__(self, mechanics: System) -> None:
        self._mechanics, self._graph, self._n = mechanics, mechanics.graph, mechanics.n
        self._places = mechanics.model.rough
        self._names = [name for joint in mechanics.model.released for name, _ in joint.coordinates]

    @cached_property
    def columns(self) -> tuple[Vector, ...]:
        """s_j (n) of each place: the generalized force of a unit force, or torque, along its rate."""
        return tuple(self._mechanics.worked_on(place.velocity) for place in self._places)

    @cached_property
    def sizes(self) -> Vector:
        """mu_j rho_j: friction per reaction, m of pins, a number of guides."""
        names, graph = self._mechanics.names, self._graph
        return tuple(translate(graph, p.coefficient, names) * translate(graph, p.radius, names) for p in self._places)

    @cached_property
    def directions(self) -> Vector:
        """tanh(s_j^T q_dot / w_j), between -1 and 1."""
        names, graph = self._mechanics.names, self._graph
        pairs = ((translate(graph, p.velocity, names), translate(graph, p.width, names)) for p in self._places)
        return tuple(graph.function("tanh", (rate / width,)) for rate, width in pairs)

    def loaded(self, reactions: Sequence[Vector]) -> tuple[Vector, ...]:
        """The reactions with the loads that are known (N) as a further component."""
        names = self._mechanics.names
        loads = [() if p.load is None else (translate(self._graph, p.load, names),) for p in self._places]
        return tuple((*reaction, *load) for reaction, load in zip(reactions, loads, strict=True))

    def unloaded(self, reactions: Sequence[Vector]) -> tuple[Vector, ...]:
        """The same of what friction adds to reactions: 0."""
        loads = [() if place.load is None else (self._graph.zero,) for place in self._places]
        return tuple((*reaction, *load) for reaction, load in zip(reactions, loads, strict=True))

    @cached_property
    def _system(self) -> System:
        return System(released_model(self._mechanics.model), self._mechanics, lumped=self._mechanics.lumped)

    def _shut(self, values: Sequence[Scalar]) -> Vector:
        """Values where the joints are shut and at rest."""
        system, n = self._system, self._n
        symbols = (*system.q[n:], *system.qd[n:], *system.qdd[n:])
        return tuple(substitute(self._graph, values, dict.fromkeys(symbols, self._graph.zero)))

    @cached_property
    def balance(self) -> Vector:
        """tau along what is let go (N)."""
        return self._shut(self._system.balance[self._n :]) if self._names else ()

    @cached_property
    def beside(self) -> tuple[Vector, ...]:
        """s_j along what is let go."""
        if not self._names:
            return ((),) * len(self._places)
        return tuple(self._shut(self._system.worked_on(place.velocity)[self._n :]) for place in self._places)

    @cached_property
    def masses(self) -> Matrix:
        """The rows of G along what is let go, by the accelerations of the system."""
        return tuple(self._shut(row[: self._n]) for row in self._system.mass_matrix[self._n :]) if self._names else ()

    @cached_property
    def _held_by(self) -> tuple[Matrix, Matrix]:
        """The rows of M, and the columns of B as rows, along what is let go."""
        system, n = self._system, self._n
        controls = tuple(self._shut(row) for row in system.control_matrix[n:])
        rows = transpose(system.constraint_jacobian, system.n)[n:] if system.r else ((),) * len(self._names)
        return controls, tuple(self._shut(row) for row in rows)

    def reactions(self, force: Vector, inputs: Vector, multipliers: Vector) -> tuple[Vector, ...]:
        """What each place carries where a force along what is let go is met by these inputs and multipliers."""
        graph, model, held = self._graph, self._mechanics.model, dict[str, Scalar]()
        if self._names:
            for name, f, control, row in zip(self._names, force, *self._held_by, strict=True):
                held[name] = f - dot(graph, control, inputs) + dot(graph, row, multipliers)
        units = model.row_units or (0,) * model.r
        # rows may be in units of their own, powers of 2 (`quantities/row_units.py`)
        pressing = {
            row.name: x * Fraction(2) ** unit
            for row, x, unit in zip(model.constraints, multipliers, units, strict=True)
        }
        return tuple(
            without_hidden_zeros([*(pressing[name] for name in place.rows), *(held[name] for name in place.released)])
            for place in self._places
        )
