"""The quantities of the paper along one way to the null space of B.

A `Derivation` holds what several quantities share, each part computed on first use.  The catalogue lists its methods
by quantity name; `select` compares the derivations along different null spaces by counted cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import BasisInertia, ConstrainedInertia, FreeInertia, MinorInertia
from symgen.linear_algebra.guards import Guard, moved
from symgen.linear_algebra.null_space.null_spaces import (
    HouseholderSpace,
    InputEquations,
    MinorSpace,
    NullSpace,
    Restriction,
    residual,
)
from symgen.linear_algebra.null_space.pivoted import reflected
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.coordinates.idle_coordinates import idle_coordinates
from symgen.methods.coordinates.minimal_coordinates import MinimalCoordinates
from symgen.methods.forward_dynamics.minor_motion import LARGEST_DELTA, MinorMotion, minor_motion
from symgen.methods.forward_dynamics.motion import Problem
from symgen.methods.friction.reactions import ReactionFriction
from symgen.methods.given.configuration import GivenConfiguration
from symgen.methods.given.functions import GivenBy
from symgen.methods.given.least_motion import MotionOfGiven, motion_of
from symgen.methods.least_inputs import least_inputs
from symgen.methods.redundancy.allocation import InputAllocation
from symgen.model.quantities import DIRECTION
from symgen.symbolic.accumulation import shortest_jacobian
from symgen.symbolic.calculus import derivative_along, gradient
from symgen.symbolic.matrix import (
    Matrix,
    Vector,
    add,
    dot,
    identity,
    matmul,
    scale,
    subtract,
    subtract_vectors,
    transpose,
)
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, substitute
from symgen.validity.rank_measures import rank_measures
from symgen.validity.solvable import solvable


class Derivation:
    """Every quantity of one system as scalars, along one `NullSpace`."""

    def __init__(self, mechanics: System, generic: Genericity, space: NullSpace) -> None:
        self.mechanics = mechanics
        self.generic = generic
        self.space = space
        self.graph = mechanics.graph
        self.n, self.r, self.m = mechanics.n, mechanics.r, mechanics.m
        self._motions: dict[GivenBy, MotionOfGiven] = {}
        self._configurations: dict[GivenBy, GivenConfiguration] = {}

    # shared parts ----------------------------------------------------------------------------------------------------

    @cached_property
    def admissible(self) -> Vector:
        """v = N_B q_dot, factored where that is no longer."""
        plain = self.space.project(self.mechanics.qd)
        factored = self.mechanics.factoring.shorten(plain)
        return min((factored, plain), key=lambda v: cost(v).weight)

    @cached_property
    def common_speeds(self) -> frozenset[Scalar]:
        """The sums that all components of v are multiples of: v itself varies in fewer directions than it has entries.

        Left whole, they let what vanishes for admissible velocities cancel exactly.
        """
        return self.mechanics.factoring.common_sums(self.admissible)

    @property
    def whole(self) -> frozenset[Scalar]:
        """What must stay whole where results are multiplied out: common speeds, and the minors of B.

        Where the rank of B drops all minors are small together, and what they are multiplied out into is not.
        """
        minors = self.space.forms.minors if isinstance(self.space, MinorSpace) else frozenset()
        return self.common_speeds | minors

    @property
    def whole_for_inputs(self) -> frozenset[Scalar]:
        """The same for u, whose sums of squared determinants vanish where inputs lose an effect."""
        forms, _ = self._actuation
        return self.whole | forms.minors

    @cached_property
    def inertia(self) -> ConstrainedInertia:
        """K = W (W^T G W)^-1 W^T, by the method that is valid wherever G is positive definite on ker B."""
        mass_matrix, space = self.mechanics.mass_matrix, self.space
        if self.generic.rank < self.r and self.generic.delta <= LARGEST_DELTA and isinstance(space, MinorSpace):
            return MinorInertia(space, mass_matrix)
        if isinstance(space, MinorSpace) and self.generic.delta <= LARGEST_DELTA:
            return minor_motion(Problem(self.mechanics, space.guards))
        if self.r == 0:
            return FreeInertia(self.graph, mass_matrix)
        if isinstance(space, HouseholderSpace):
            return BasisInertia(space, mass_matrix)
        return BasisInertia(reflected_rows(self.mechanics, self.generic), mass_matrix)

    @cached_property
    def _actuation(self) -> tuple[InputEquations, Restriction]:
        forms, restriction = self.space.actuation(self.mechanics.inputs, self.generic.alpha)
        return forms.cancelled(self.mechanics.factoring.cancelled), restriction

    @property
    def actuation_guards(self) -> tuple[Guard, ...]:
        """The denominator of the input equations; a drop of rank B is named first."""
        forms, _ = self._actuation
        return self._solvable(forms)

    @property
    def input_measures(self) -> list[Scalar]:
        """What the input equations divide by otherwise, which is 0 only where inputs lose a direction."""
        forms = [self._actuation[0], *(() if self.allocation is None else (self.allocation.forms,))]
        return [measure for one in forms for measure in one.rank_measures]

    def _solvable(self, forms: InputEquations) -> tuple[Guard, ...]:
        inputs = self.mechanics.inputs
        return solvable(self.mechanics, self.generic, self.space, forms, inputs, Status.ACTUATION_RANK)

    def _solve_inputs(self, force: Vector) -> Vector:
        forms, restriction = self._actuation
        given, rest = self._taken_directly(force)
        inputs = least_inputs(self.mechanics, self.generic, forms, restriction, rest)
        return tuple(a + b for a, b in zip(given, inputs, strict=True))

    def _taken_directly(self, force: Vector) -> tuple[Vector, Vector]:
        """Inputs p that take what loads the coordinates that they drive alone, and what is left, f - M p.

        u = p + M~^+ (f - M p) where no input does what others do: a large load of a drive's own passes no projection.
        Where inputs span all directions that is what the elimination of forces does, and less cancels here.
        """
        given, rest = [self.graph.zero] * self.m, list(force)
        if self.m == self.generic.alpha < self.generic.delta:
            for k, column in enumerate(self.mechanics.inputs):
                driven = [(j, entry.constant) for j, entry in enumerate(column) if not entry.is_zero]
                (j, factor), *others = driven or [(0, None)]
                if factor is not None and not others:
                    given[k], rest[j] = rest[j] * (1 / factor), self.graph.zero
        return tuple(given), tuple(rest)

    def _columns(self, solve: Sequence[Vector]) -> Matrix:
        return transpose(tuple(solve), len(solve[0])) if solve else ()

    @cached_property
    def control_pseudoinverse(self) -> Matrix:
        """M~^+ (m x n): the input equations solved for unit forces."""
        return self._columns([self._solve_inputs(axis) for axis in identity(self.graph, self.n)])

    def _projected_square(self, a: Matrix) -> Matrix:
        n, projector = self.n, self.space.projector
        product = matmul(self.graph, matmul(self.graph, projector, a, n), projector, n)
        return tuple(tuple(product[min(i, j)][max(i, j)] for j in range(n)) for i in range(n))

    @cached_property
    def _idle(self) -> frozenset[int]:
        """Coordinates that N_B does not depend on."""
        return idle_coordinates(self.mechanics, self.generic)

    def projector_dot(self, velocity: Vector) -> Matrix:
        """N_B_dot = -X - X^T with X = B^+ B_dot N_B (Remark 9)."""
        graph, n = self.graph, self.n
        if self.r == 0:
            return scale(identity(graph, n), graph.zero)
        turning = tuple(graph.zero if j in self._idle else rate for j, rate in enumerate(velocity))
        rates = matmul(graph, self.mechanics.constraint_jacobian_dot(turning), self.space.projector, n)
        x = matmul(graph, self.space.pseudoinverse, rates, n)
        return tuple(tuple(-(x[min(i, j)][max(i, j)] + x[max(i, j)][min(i, j)]) for j in range(n)) for i in range(n))

    # projections of Remark 9 -----------------------------------------------------------------------------------------

    def admissible_acceleration(self) -> Vector:
        """N q_ddot + N_dot v with v = N q_dot: on the manifold N_dot v = -B^+ B_dot v."""
        projected = self.space.project(self.mechanics.qdd)
        if self.r == 0:
            return projected
        bias = self.mechanics.constraint_acceleration_bias(self.admissible)
        return subtract_vectors(projected, self.space.lift(bias))

    def projected_configuration(self) -> Vector:
        """Two Newton steps q <- q - B_g^+ g with the geometric rows."""
        q = self.mechanics.q
        step = self._newton_step
        first = tuple(a - b for a, b in zip(q, step, strict=True))
        again = substitute(self.graph, step, dict(zip(q, first, strict=True)))
        return tuple(a - b for a, b in zip(first, again, strict=True))

    @cached_property
    def geometric_space(self) -> NullSpace:
        """The velocities that the geometric rows allow."""
        rows = self.mechanics.geometric_jacobian
        if isinstance(self.space, HouseholderSpace):
            return reflected(self.graph, rows, self.n, self.generic.geometric_rank)
        return MinorSpace(self.graph, rows, self.n, self.generic.geometric_rank)

    @cached_property
    def _newton_step(self) -> Vector:
        if not self.mechanics.geometric_jacobian:
            return (self.graph.zero,) * self.n
        return self.geometric_space.lift(self.mechanics.constraint_residual)

    @property
    def newton_guards(self) -> tuple[Guard, ...]:
        """Where the geometric rows lose rank, at the given and at the improved configuration."""
        if not self.mechanics.geometric_jacobian:
            return ()
        q = self.mechanics.q
        step = {a: a - b for a, b in zip(q, self._newton_step, strict=True)}
        guards = self.geometric_space.guards
        return (*guards, *(moved(guard, step) for guard in guards))

    # from what is given ----------------------------------------------------------------------------------------------

    def given_motion(self, given_by: GivenBy) -> MotionOfGiven:
        """What rates determine that are measured, or of a task; of one that leaves directions open the least motion."""
        if given_by not in self._motions:
            self._motions[given_by] = motion_of(self, given_by(self.mechanics))
        return self._motions[given_by]

    def given_configuration(self, given_by: GivenBy) -> GivenConfiguration:
        """What coordinates determine that are measured, or of a task."""
        if given_by not in self._configurations:
            self._configurations[given_by] = GivenConfiguration(self, given_by(self.mechanics))
        return self._configurations[given_by]

    # projected equations (30) ----------------------------------------------------------------------------------------

    def projected_mass_matrix(self) -> Matrix:
        """G~ = N G N."""
        return self._projected_square(self.mechanics.matrices.mass_matrix)

    def projected_coriolis_matrix(self) -> Matrix:
        """C~ = N (C N + G N_dot), both along N q_dot."""
        graph, n, space = self.graph, self.n, self.space
        coriolis = matmul(graph, self.mechanics.matrices.coriolis_matrix(self.admissible), space.projector, n)
        inertial = matmul(graph, self.mechanics.matrices.mass_matrix, self.projector_dot(self.admissible), n)
        return matmul(graph, space.projector, add(coriolis, inertial), n)

    # weighted projection (17), (19) ----------------------------------------------------------------------------------

    @cached_property
    def weighted_projector(self) -> Matrix:
        """N_{B,G} = K G."""
        if self.r == 0:
            return identity(self.graph, self.n)
        return self._columns([self.inertia.solve(row) for row in self.mechanics.mass_matrix])

    @cached_property
    def weighted_pseudoinverse(self) -> Matrix:
        """B_G^+, by the minors of B, or as (I - N_{B,G}) B^+."""
        if isinstance(self.inertia, MinorMotion):
            return self.inertia.pseudoinverse
        complement = subtract(identity(self.graph, self.n), self.weighted_projector)
        return matmul(self.graph, complement, self.space.pseudoinverse, self.r)

    # minimal coordinates (8), (9) ------------------------------------------------------------------------------------

    @cached_property
    def minimal(self) -> MinimalCoordinates:
        """The equations in the velocities that the model names as independent."""
        return MinimalCoordinates(self.mechanics, self.generic, self.space)

    # inverse dynamics (27) and Remark 3 ------------------------------------------------------------------------------

    @cached_property
    def inverse_dynamics(self) -> Vector:
        """u = (W^T M)^+ W^T tau, the minimum-norm least-squares inputs, or as the model's `allocation` says."""
        if self.friction is not None:
            return self.friction.inputs
        if self.allocation is not None:
            return self.allocation.solve(self.mechanics.balance)
        return self._solve_inputs(self.mechanics.balance)

    @cached_property
    def allocation(self) -> InputAllocation | None:
        """What the model's block says, where the motion leaves anything to allocate."""
        allocation = self.mechanics.model.allocation
        if allocation is None or (self.m == self.generic.alpha and not allocation.scale):
            return None
        return InputAllocation(self.mechanics, self.generic, allocation, self.space)

    @cached_property
    def friction(self) -> ReactionFriction | None:
        """Of places whose friction grows with their reactions, where the model has some."""
        rough = self.mechanics.model.rough
        return ReactionFriction(self.mechanics, self.space, self._solve_inputs) if rough else None

    def friction_residual(self) -> Vector:
        """N_B (tau + D - M u) for given u."""
        assert self.friction is not None
        force = tuple(f + d for f, d in zip(self.mechanics.balance, self.friction.force, strict=True))
        return residual(self.space, force, self.mechanics.inputs, self.mechanics.u)

    @property
    def inverse_dynamics_guards(self) -> tuple[Guard, ...]:
        """The denominator of the input equations, with the weights of the inputs; that friction does not lock."""
        if self.friction is not None:
            return (*self.space.guards, *self.actuation_guards, *self.friction.guards)
        if self.allocation is None:
            return self.actuation_guards
        return (*self._solvable(self.allocation.forms), *self.allocation.guards(self.inverse_dynamics))

    def inverse_dynamics_residual(self) -> Vector:
        """N_B (tau - M u); nothing is left where the system is fully actuated."""
        if self.generic.full_actuation:
            return (self.graph.zero,) * self.n
        forms, restriction = self._actuation
        _, rest = self._taken_directly(self.mechanics.balance)
        return residual(self.space, rest, self.mechanics.inputs, forms.solve(restriction(rest)))

    def inverse_dynamics_jacobian(self, by: Vector) -> Matrix:
        """The derivatives of u by symbols, a column each."""
        return shortest_jacobian(self.graph, self.inverse_dynamics, by)

    def inverse_dynamics_gradient(self) -> Vector:
        """The derivatives of w^T u by q, q_dot and q_ddot, in one reverse sweep."""
        weighted = dot(self.graph, self.mechanics.further("w_u")[0], self.inverse_dynamics)
        return tuple(gradient(self.graph, weighted, self.mechanics.motion))

    def inverse_dynamics_hessian_product(self) -> Vector:
        """H v with the second derivatives H of w^T u by q, q_dot and q_ddot: forward over the reverse sweep."""
        (direction,) = self.mechanics.further(DIRECTION)
        along = dict(zip(self.mechanics.motion, direction, strict=True))
        return tuple(derivative_along(self.graph, self.inverse_dynamics_gradient(), along))

    # diagnostics -----------------------------------------------------------------------------------------------------

    def energy(self) -> Vector:
        """[T, U]."""
        return self.mechanics.kinetic_energy, self.mechanics.potential_energy

    def singularity(self) -> Vector:
        """Measures det(B B^T) / prod |b_k|^2 and e(M~)/e(M): how far both ranks are from dropping."""
        return rank_measures(self.mechanics, self.generic, self.space)
