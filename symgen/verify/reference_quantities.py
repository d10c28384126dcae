"""The quantities of interface.md section 2 at one state, each from its definition.

Equation numbers are those of the paper as corrected in theory.md.  Notation: N = I - B+B projects onto ker B,
P = I - N, v = N qd, Z = N (N G N + P)^-1 N = F (F'GF)^-1 F' for every basis F of ker B.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, wraps
from itertools import combinations
from math import comb
from typing import Any, TypeAlias

from flint import arb, arb_mat

from symgen.verify.reference_allocation import allocated
from symgen.verify.reference_linear import (
    column,
    columns_of,
    determinant,
    identity,
    pseudoinverse,
    right_pseudoinverse,
    rows_of,
    solve,
)
from symgen.verify.reference_manifold import Ranks
from symgen.verify.reference_system import Configuration, System

MOST_DETERMINANTS = 10

Derivative: TypeAlias = Callable[["Evaluation", Any], Any]


def _once_a_velocity(derivative: Derivative) -> Derivative:
    """A derivative along a velocity, computed once for each; an evaluation keeps the few velocities it has."""

    @wraps(derivative)
    def known(evaluation: Evaluation, velocity: Any) -> Any:
        key = derivative.__name__, id(velocity)
        if key not in evaluation.derivatives:
            evaluation.derivatives[key] = velocity, derivative(evaluation, velocity)
        return evaluation.derivatives[key][1]

    return known


@dataclass
class Evaluation:
    """One state; every intermediate is computed once, when it is needed."""

    system: System
    ranks: Ranks
    q: Sequence[Any]
    qd: Sequence[Any]
    qdd: Sequence[Any]
    u: Sequence[Any]
    parameters: Sequence[Any]
    literals: Sequence[Any]
    derivatives: dict[tuple[str, int], tuple[Any, Any]] = field(default_factory=dict)

    @cached_property
    def at(self) -> Configuration:
        """What depends on q alone."""
        return self.system.configuration(self.q, self.parameters, self.literals)

    @cached_property
    def points(self) -> tuple[Any, Any]:
        """Places of the points and their velocities per rate."""
        return self.system.points(self.q, self.parameters, self.literals)

    @cached_property
    def gradients(self) -> tuple[Any, ...]:
        """dG/dq, dB/dq and dM/dq."""
        return self.system.gradients.at(self.q, self.parameters, self.literals)

    def _along(self, what: str, velocity: Any) -> tuple[Any, ...]:
        return self.system.gradients.along(what, self.gradients, velocity)

    @_once_a_velocity
    def motion(self, velocity: Any) -> tuple[Any, Any]:
        """C v (n x 1) and B_dot v (r x 1) along a velocity v, without the matrices."""
        motion = self.system.motion
        if motion is None:
            return self.coriolis(velocity) * velocity, self.constraints_dot(velocity) * velocity
        return motion.along(self.q, velocity.entries(), self.parameters, self.literals, self.at.jacobian)

    @cached_property
    def inverse(self) -> Any:
        """B+ (n x r)."""
        return right_pseudoinverse(self.at.constraints, self.ranks.constraints)

    @cached_property
    def projector_off(self) -> Any:
        """P = B+B."""
        return self.inverse * self.at.constraints

    @cached_property
    def projector(self) -> Any:
        """N_B (21)."""
        return identity(self.system.n) - self.projector_off

    @cached_property
    def rate(self) -> Any:
        """qd as given."""
        return column(self.qd)

    @cached_property
    def projected_rate(self) -> Any:
        """N qd."""
        return self.projector * self.rate

    @_once_a_velocity
    def coriolis(self, velocity: Any) -> Any:
        """Christoffel C (3) along a velocity."""
        return arb_mat(self.system.n, self.system.n, self._along("coriolis", velocity))

    def mass_dot(self, velocity: Any) -> Any:
        """d/dt G along a velocity."""
        return arb_mat(self.system.n, self.system.n, self._along("mass", velocity))

    @_once_a_velocity
    def constraints_dot(self, velocity: Any) -> Any:
        """d/dt B along a velocity."""
        return arb_mat(self.system.r, self.system.n, self._along("constraints", velocity))

    def control_dot(self, velocity: Any) -> Any:
        """d/dt M along a velocity."""
        return arb_mat(self.system.n, self.system.m, self._along("control", velocity))

    @_once_a_velocity
    def projector_dot(self, velocity: Any) -> Any:
        """d/dt N_B along a velocity (Remark 9): -X - X', X = B+ Bdot N."""
        x = self.inverse * (self.constraints_dot(velocity) * self.projector)
        return -x - x.transpose()

    def applied(self, velocity: Any) -> Any:
        """Q_a at a velocity."""
        return self.system.applied(self.q, velocity.entries(), self.parameters, self.literals)

    @cached_property
    def rate_coriolis(self) -> Any:
        """C along qd as given."""
        return self.coriolis(self.rate)

    @cached_property
    def bias(self) -> Any:
        """C qd + Q - Q_a."""
        return self.motion(self.rate)[0] + self.at.potential_gradient - self.applied(self.rate)

    @cached_property
    def load(self) -> Any:
        """tau = G qdd + C qd + Q - Q_a."""
        return self.at.mass * column(self.qdd) + self.bias

    @cached_property
    def weighted(self) -> Any:
        """Z (symmetric): N_BG = Z G."""
        inner = self.projector * self.at.mass * self.projector + self.projector_off
        return self.projector * solve(inner, self.projector)

    @cached_property
    def projected_control(self) -> Any:
        """N_B M (21)."""
        return self.projector * self.at.control

    @cached_property
    def control_inverse(self) -> Any:
        """M~+ (27), (28), at the generic degree of actuation."""
        full = self.ranks.actuation == self.system.n - self.ranks.constraints < self.system.m
        if full:  # range(N M) = ker B: (M~ M~' + P) is regular
            gram = self.projected_control * self.projected_control.transpose() + self.projector_off
            return solve(gram, self.projected_control).transpose()
        return pseudoinverse(self.projected_control, self.ranks.actuation)

    @cached_property
    def inverse_dynamics(self) -> Any:
        """u (27), or as the model's allocation says."""
        allocation = self.system.model.allocation
        if allocation is not None:
            return allocated(self, allocation)
        return self.control_inverse * (self.projector * self.load)

    @cached_property
    def accelerations(self) -> Any:
        """qdd of the KKT system: a - Z (G a - f), a = -B+ Bdot qd, f = M u - C qd - Q + Q_a."""
        particular = -(self.inverse * self.motion(self.rate)[1])
        return particular - self.weighted * (self.at.mass * particular - self.force)

    @cached_property
    def force(self) -> Any:
        """M u - C qd - Q + Q_a."""
        return self.at.control * column(self.u) - self.bias

    @cached_property
    def independent(self) -> list[int]:
        """Positions of the independent velocities."""
        names = [coordinate.name for coordinate in self.system.model.coordinates]
        return [names.index(name) for name in self.system.model.independent_velocities]

    @cached_property
    def complement(self) -> Any:
        """F (8): the basis of ker B with the identity in the rows of the independent velocities."""
        basis = columns_of(self.projector, self.independent)
        return solve(rows_of(basis, self.independent).transpose(), basis.transpose()).transpose()

    @cached_property
    def complement_dot(self) -> Any:
        """d/dt F along qd as given, from d/dt (B F) = 0 and the constant rows."""
        x = self.inverse * (self.constraints_dot(self.rate) * self.complement)
        return self.complement * rows_of(x, self.independent) - x

    @cached_property
    def quasi(self) -> Any:
        """W = (M~+)' (Remark 10), for m = delta."""
        return self.control_inverse.transpose()

    @cached_property
    def quasi_velocity(self) -> Any:
        """v = W nu, nu = M' qd."""
        return self.quasi * (self.at.control.transpose() * self.rate)

    def quasi_dot(self, velocity: Any) -> Any:
        """d/dt W along a velocity: W = N M S^-1, S = M' N M."""
        control, projector = self.at.control, self.projector
        control_dot, projector_dot = self.control_dot(velocity), self.projector_dot(velocity)
        mixed = control_dot.transpose() * self.projected_control
        gram = control.transpose() * self.projected_control
        gram_dot = mixed + mixed.transpose() + control.transpose() * (projector_dot * control)
        top = projector_dot * control + projector * control_dot - self.quasi * gram_dot
        return solve(gram, top.transpose()).transpose()


def _inverse_dynamics_residual(e: Evaluation) -> Any:
    return e.projector * (e.load - e.at.control * (e.control_inverse * (e.projector * e.load)))


def _weighted_pseudoinverse(e: Evaluation) -> Any:
    return e.inverse - e.weighted * (e.at.mass * e.inverse)


def _projected_coriolis_matrix(e: Evaluation) -> Any:
    velocity = e.projected_rate
    inner = e.coriolis(velocity) * e.projector + e.at.mass * e.projector_dot(velocity)
    return e.projector * inner


def _minimal_coriolis_matrix(e: Evaluation) -> Any:
    return e.complement.transpose() * (e.rate_coriolis * e.complement + e.at.mass * e.complement_dot)


def _admissible_acceleration(e: Evaluation) -> Any:
    velocity = e.projected_rate
    if e.ranks.constraints == e.system.r:  # B+' v = 0, and N_dot v = -B+ B_dot v by Remark 9
        return e.projector * column(e.qdd) - e.inverse * e.motion(velocity)[1]
    return e.projector * column(e.qdd) + e.projector_dot(velocity) * velocity


def _projected_configuration(e: Evaluation) -> Any:
    q = column(e.q)
    if e.system.r_geometric == 0:
        return q
    for _ in range(2):
        residual, jacobian = e.system.geometry(q.entries(), e.parameters, e.literals)
        q = q - right_pseudoinverse(jacobian, e.ranks.geometric) * residual
    return q


def _actuator_bias(e: Evaluation) -> Any:
    velocity = e.quasi_velocity
    nu = e.at.control.transpose() * e.rate
    inner = e.at.mass * (e.quasi_dot(velocity) * nu) + e.coriolis(velocity) * velocity
    return e.quasi.transpose() * (inner + e.at.potential_gradient - e.applied(velocity))


def _multipliers(e: Evaluation) -> Any:
    return e.inverse.transpose() * (e.force - e.at.mass * e.accelerations)


def _energy(e: Evaluation) -> Any:
    return column(e.system.energies(e.q, e.qd, e.parameters, e.literals))


def _singularity(e: Evaluation) -> Any:
    return column([_constraint_measure(e), _actuation_measure(e)])


def _constraint_measure(e: Evaluation) -> Any:
    """Mean of det(B_I B_I') over the subsets I of rho rows divided by their norms; 0 for a vanishing row."""
    r, rank = e.system.r, e.ranks.constraints
    if r == 0:
        return arb(1)
    rows = []
    vanishing = set()
    for index, row in enumerate(e.at.constraints.tolist()):
        size = sum((x * x for x in row), arb(0)).sqrt()
        if size.contains(0):
            vanishing.add(index)
            rows.append(row)
        else:
            rows.append([x / size for x in row])
    subsets = [s for s in combinations(range(r), rank) if not vanishing.intersection(s)]
    if not subsets:
        return arb(0)
    unit = arb_mat(r, e.system.n, [x for row in rows for x in row])
    total = arb(0)
    for subset in subsets:
        part = rows_of(unit, subset) if rank < r else unit
        total += determinant(part * part.transpose())
    return total / len(subsets)


def _actuation_measure(e: Evaluation) -> Any:
    """e(M~)/e(M), e(X) the sum of det(X_J'X_J) over the subsets J of alpha inputs; 0/0 is 0."""
    projected = _sum_of_minors(e.projected_control.transpose() * e.projected_control, e.ranks.actuation)
    plain = _sum_of_minors(e.at.control.transpose() * e.at.control, e.ranks.actuation)
    return arb(0) if plain.contains(0) else projected / plain


def _sum_of_minors(gram: Any, size: int) -> Any:
    """The sum of the principal minors of a size; many of them as a coefficient of the characteristic polynomial."""
    if comb(gram.nrows(), size) > MOST_DETERMINANTS:
        coefficient = gram.charpoly()[gram.nrows() - size]
        return -coefficient if size % 2 else coefficient
    total = arb(0)
    for subset in combinations(range(gram.nrows()), size):
        total += determinant(rows_of(columns_of(gram, subset), subset))
    return total


Definition = Callable[[Evaluation], Any]
QUANTITIES: dict[str, Definition] = {
    "mass_matrix": lambda e: e.at.mass,
    "coriolis_matrix": lambda e: e.rate_coriolis,
    "coriolis_force": lambda e: e.motion(e.rate)[0],
    "potential_force": lambda e: e.at.potential_gradient,
    "applied_force": lambda e: e.applied(e.rate),
    "constraint_residual": lambda e: e.at.residual,
    "constraint_jacobian": lambda e: e.at.constraints,
    "constraint_jacobian_dot": lambda e: e.constraints_dot(e.rate),
    "constraint_pseudoinverse": lambda e: e.inverse,
    "nullspace_projector": lambda e: e.projector,
    "nullspace_projector_dot": lambda e: e.projector_dot(e.rate),
    "weighted_pseudoinverse": _weighted_pseudoinverse,
    "weighted_nullspace_projector": lambda e: e.weighted * e.at.mass,
    "control_matrix": lambda e: e.at.control,
    "projected_control_matrix": lambda e: e.projected_control,
    "projected_control_pseudoinverse": lambda e: e.control_inverse,
    "orthogonal_complement": lambda e: e.complement,
    "projected_mass_matrix": lambda e: e.projector * e.at.mass * e.projector,
    "projected_coriolis_matrix": _projected_coriolis_matrix,
    "projected_potential_force": lambda e: e.projector * e.at.potential_gradient,
    "projected_applied_force": lambda e: e.projector * e.applied(e.projected_rate),
    "minimal_mass_matrix": lambda e: e.complement.transpose() * e.at.mass * e.complement,
    "minimal_coriolis_matrix": _minimal_coriolis_matrix,
    "minimal_potential_force": lambda e: e.complement.transpose() * e.at.potential_gradient,
    "minimal_applied_force": lambda e: e.complement.transpose() * e.applied(e.rate),
    "minimal_control_matrix": lambda e: e.complement.transpose() * e.at.control,
    "admissible_velocity": lambda e: e.projected_rate,
    "admissible_acceleration": _admissible_acceleration,
    "projected_configuration": _projected_configuration,
    "inverse_dynamics": lambda e: e.inverse_dynamics,
    "inverse_dynamics_residual": _inverse_dynamics_residual,
    "actuator_velocity": lambda e: e.at.control.transpose() * e.rate,
    "actuator_mass_matrix": lambda e: e.quasi.transpose() * e.at.mass * e.quasi,
    "actuator_bias": _actuator_bias,
    "forward_dynamics": lambda e: e.accelerations,
    "multipliers": _multipliers,
    "energy": _energy,
    "singularity": _singularity,
    "point_position": lambda e: e.points[0],
    "point_jacobian": lambda e: e.points[1],
}

# The others do with what a velocity adds to forces and accelerations.
NEED_GRADIENTS = {
    "coriolis_matrix",
    "constraint_jacobian_dot",
    "nullspace_projector_dot",
    "projected_coriolis_matrix",
    "minimal_coriolis_matrix",
    "actuator_bias",
}

NEEDS_CONSTRAINTS = {
    "constraint_jacobian",
    "constraint_jacobian_dot",
    "constraint_pseudoinverse",
    "weighted_pseudoinverse",
    "multipliers",
}
NEEDS_INPUTS = {
    "control_matrix",
    "projected_control_matrix",
    "projected_control_pseudoinverse",
    "inverse_dynamics",
    "minimal_control_matrix",
}


def offered(name: str, system: System, ranks: Ranks) -> bool:
    """Whether the model has this quantity, its result not being empty."""
    delta = system.n - ranks.constraints
    if name.startswith("point_"):
        return bool(system.model.mechanism.points)
    if name == "constraint_residual":
        return system.r_geometric > 0
    if name in NEEDS_CONSTRAINTS and system.r == 0:
        return False
    if name in NEEDS_INPUTS and system.m == 0:
        return False
    if (name.startswith("minimal_") or name == "orthogonal_complement") and not system.model.independent_velocities:
        return False
    if name.startswith("actuator_"):
        return system.m == delta == ranks.actuation
    return True
