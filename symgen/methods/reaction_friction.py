"""Friction that grows with the reactions it changes itself (Remark 3): u and lambda as a fixed point.

M u - B^T lambda = tau + D(lambda),  D(lambda) = sum_j s_j d_j n_j,  d_j = mu_j rho_j tanh(s_j^T q_dot / w_j),

with n_j = |R_j| the reaction that place j carries (N).  u is the smallest one that produces the motion with the friction
as it is, u = M~^+ (tau + D), and lambda = (B^+)^T (M u - tau - D).  Both, and so every R_j, are affine in the n_j:

n_i = |R_i0 + sum_j R_ij d_j n_j|,

R_i0 what place i carries without friction and R_ij what a unit of friction at place j adds.  By the triangle inequality
the right-hand side contracts in the largest of the |n_i| with kappa = max_i sum_j |R_ij d_j|, so that for kappa < 1
there is one solution (Banach).  A place that changes its own reaction is solved for: with a = R_i0 + sum_(j != i),
b = R_ii d_i,

n_i = (a.b + sqrt((a.b)^2 + (1 - b.b) a.a)) / (1 - b.b),

which for one component is lambda = a / (1 - b sgn a).  What is left is iterated place by place, a stated number of
times (`model/configurations/friction_steps.py`).  Where kappa reaches 1/2 there is a status in place of a result.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import chain

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_spaces import NullSpace
from symgen.mechanics.system import System
from symgen.methods.method import divisors
from symgen.model.configurations.friction_steps import LOCKING_SHARE, MOST_FRICTION_STEPS
from symgen.model.kinematics.released import released_model
from symgen.model.model import RoughPlace
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.matrix import Matrix, Vector, dot, matvec, subtract_vectors, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import substitute


class ReactionFriction:
    """The friction of one model's rough places along one null space; `solve` gives u for a generalized force."""

    def __init__(self, mechanics: System, space: NullSpace, solve: Callable[[Vector], Vector]) -> None:
        self.mechanics, self.graph, self._space, self._solve = mechanics, mechanics.graph, space, solve
        self.places = mechanics.model.rough
        self._released = Released(mechanics)

    @cached_property
    def columns(self) -> tuple[Vector, ...]:
        """s_j (n) of each place: the generalized force of a unit force, or torque, along its rate."""
        return tuple(self.mechanics.worked_on(place.velocity) for place in self.places)

    @cached_property
    def sizes(self) -> Vector:
        """mu_j rho_j: friction per reaction, m of pins, a number of guides."""
        names, graph = self.mechanics.names, self.graph
        return tuple(translate(graph, p.coefficient, names) * translate(graph, p.radius, names) for p in self.places)

    @cached_property
    def directions(self) -> Vector:
        """tanh(s_j^T q_dot / w_j), between -1 and 1."""
        names, graph = self.mechanics.names, self.graph
        pairs = ((translate(graph, p.velocity, names), translate(graph, p.width, names)) for p in self.places)
        return tuple(graph.function("tanh", (rate / width,)) for rate, width in pairs)

    @cached_property
    def _factors(self) -> Vector:
        """d_j."""
        return tuple(size * way for size, way in zip(self.sizes, self.directions, strict=True))

    @cached_property
    def _unit_inputs(self) -> tuple[Vector, ...]:
        """M~^+ s_j (m): the inputs that a unit of friction at each place takes."""
        return tuple(self._solve(column) for column in self.columns)

    @cached_property
    def _frictionless(self) -> tuple[Vector, tuple[Vector, ...]]:
        """u and the reactions R_i0 without friction."""
        balance = self.mechanics.balance
        inputs = self._solve(balance)
        return inputs, self._reactions(balance, self._released.balance, inputs)

    @cached_property
    def _answers(self) -> tuple[tuple[Vector, ...], ...]:
        """R_ij: by j, then i, what a unit of friction at place j adds to the reaction of place i."""
        answers = []
        for place, column, inputs in zip(self.places, self.columns, self._unit_inputs, strict=True):
            answers.append(self._reactions(column, self._released.worked_on(place), inputs))
        return tuple(answers)

    def _reactions(self, force: Vector, released: Vector, inputs: Vector) -> tuple[Vector, ...]:
        """What each place carries where a generalized force, and one along what is let go, is met by these inputs."""
        graph, model = self.graph, self.mechanics.model
        supplied = matvec(graph, self.mechanics.control_matrix, inputs)
        multipliers = self._space.lift_transposed(subtract_vectors(supplied, force)) if self.mechanics.r else ()
        held = self._released.reactions(released, inputs, multipliers)
        units = model.row_units or (0,) * model.r
        rows = {row.name: (k, units[k]) for k, row in enumerate(model.constraints)}
        reactions = []
        for place in self.places:
            # rows may be in units of their own, powers of 2 (`quantities/row_units.py`)
            known = [multipliers[rows[name][0]] * Fraction(2) ** rows[name][1] for name in place.rows]
            known += [held[name] for name in place.released]
            reactions.append(without_hidden_zeros(known))
        return tuple(reactions)

    @cached_property
    def gains(self) -> Matrix:
        """mu_j rho_j |R_ij|: the share of a change of reaction j that reaches reaction i where place j slides fully."""
        sizes = self.sizes
        return tuple(
            tuple(self._length(self._answers[j][i]) * sizes[j] for j in range(len(self.places)))
            for i in range(len(self.places))
        )

    @cached_property
    def kappa(self) -> Scalar:
        """What a change of reactions comes back as at most, in the largest of them."""
        graph = self.graph
        ways = [graph.function("abs", (way,)) for way in self.directions]
        shares = [dot(graph, row, ways) for row in self.gains]
        largest = shares[0]
        for share in shares[1:]:
            largest = graph.function("max", (largest, share))
        return largest

    @cached_property
    def steps(self) -> int:
        """How often every reaction is worked out."""
        known = self.mechanics.model.friction_steps
        return MOST_FRICTION_STEPS if known is None else known.steps

    @property
    def guards(self) -> tuple[Guard, ...]:
        """That kappa is less than one half."""
        graph = self.graph
        excess = graph.function("max", (self.kappa - graph.const(LOCKING_SHARE), graph.zero))
        return (Guard(Status.FRICTION_LOCK, excess, 1, scale=graph.one, positive=True, small=True),)

    @cached_property
    def loads(self) -> Vector:
        """n_j (N) after the stated number of steps."""
        loads: list[Scalar] = [self.graph.zero] * len(self.places)
        for _ in range(self.steps):
            for i in range(len(self.places)):
                loads[i] = self._own(i, loads)
        return tuple(loads)

    def _own(self, i: int, loads: Sequence[Scalar]) -> Scalar:
        """n_i for the others as they are, with what it does to itself."""
        graph, one = self.graph, self.graph.one
        others = [0 if j == i else self._factors[j] * loads[j] for j in range(len(loads))]
        a = [
            graph.sum((own, *(x * self._answers[j][i][k] for j, x in enumerate(others) if isinstance(x, Scalar))))
            for k, own in enumerate(self._frictionless[1][i])
        ]
        b = [self._factors[i] * x for x in self._answers[i][i]]
        if all(x.is_zero for x in b):
            return self._length(a)
        across, square = dot(graph, a, b), dot(graph, b, b)
        # where this is less than one half there is a status; above 0 it keeps what is worked out there a number
        left = graph.function("max", (one - square, graph.const(LOCKING_SHARE)))
        if len(a) == 1:
            return (graph.function("abs", (a[0],)) + across) / left
        return (graph.function("sqrt", (across * across + left * dot(graph, a, a),)) + across) / left

    def _length(self, vector: Sequence[Scalar]) -> Scalar:
        left = [x for x in vector if not x.is_zero]
        if len(left) < 2:
            return self.graph.function("abs", (left[0],)) if left else self.graph.zero
        return self.graph.function("sqrt", (dot(self.graph, left, left),))

    @property
    def harmless_divisors(self) -> tuple[Scalar, ...]:
        """What loads are divided by beside what u and reactions without friction are: none is below one half."""
        flat = (x for answers in self._answers for reaction in answers for x in reaction)
        known = {*divisors((*self._frictionless[0], *chain(*self._frictionless[1]), *chain(*self._unit_inputs), *flat))}
        return tuple(one for one in divisors(self.inputs) if one not in known)

    @property
    def inputs(self) -> Vector:
        """u (m), friction included."""
        return self._with(self._frictionless[0], self._unit_inputs, self.loads)

    @property
    def force(self) -> Vector:
        """D (n): what friction takes, with each reaction worked out once more from the others."""
        loads = tuple(self._own(i, self.loads) for i in range(len(self.places)))
        return self._with((self.graph.zero,) * self.mechanics.n, self.columns, loads)

    def _with(self, start: Vector, columns: Sequence[Vector], loads: Vector) -> Vector:
        shares = [factor * load for factor, load in zip(self._factors, loads, strict=True)]
        return tuple(
            self.graph.sum((x, *(share * column[k] for share, column in zip(shares, columns, strict=True))))
            for k, x in enumerate(start)
        )


class Released:
    """A system whose rough joints are let go, where they are shut: what acts along them."""

    def __init__(self, mechanics: System) -> None:
        self._mechanics, self._graph, self._n = mechanics, mechanics.graph, mechanics.n
        model = mechanics.model
        self._names = [name for joint in model.released for name, _ in joint.coordinates]
        self._system = System(released_model(model), mechanics, lumped=mechanics.lumped) if self._names else None

    def _shut(self, values: Sequence[Scalar]) -> Vector:
        """Values where the joints are shut and at rest."""
        system, n = self._system, self._n
        assert system is not None
        symbols = (*system.q[n:], *system.qd[n:], *system.qdd[n:])
        return tuple(substitute(self._graph, values, dict.fromkeys(symbols, self._graph.zero)))

    @cached_property
    def balance(self) -> Vector:
        """tau along what is let go (N)."""
        return () if self._system is None else self._shut(self._system.balance[self._n :])

    def worked_on(self, place: RoughPlace) -> Vector:
        """s_j along what is let go."""
        return () if self._system is None else self._shut(self._system.worked_on(place.velocity)[self._n :])

    @cached_property
    def _columns(self) -> tuple[Matrix, Matrix]:
        """The rows of M, and the columns of B as rows, along what is let go."""
        system, n = self._system, self._n
        assert system is not None
        controls = tuple(self._shut(row) for row in system.control_matrix[n:])
        rows = transpose(system.constraint_jacobian, system.n)[n:] if system.r else ((),) * len(self._names)
        return controls, tuple(self._shut(row) for row in rows)

    def reactions(self, force: Vector, inputs: Vector, multipliers: Vector) -> dict[str, Scalar]:
        """What keeps each joint shut under a force, inputs and multipliers."""
        if self._system is None:
            return {}
        graph, (controls, rows) = self._graph, self._columns
        return {
            name: f - dot(graph, control, inputs) + dot(graph, row, multipliers)
            for name, f, control, row in zip(self._names, force, controls, rows, strict=True)
        }
