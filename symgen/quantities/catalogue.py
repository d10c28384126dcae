"""Which quantities a system has, and the derivation of each: one explicit line per quantity."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from symgen.linear_algebra.guards import Guard, tested
from symgen.linear_algebra.null_space.null_spaces import rests_on_rank
from symgen.mechanics.genericity import Genericity
from symgen.methods.coordinates.actuator_coordinates import actuator_bias, actuator_mass_matrix, actuator_velocity
from symgen.methods.derivation import Derivation
from symgen.methods.derivatives.variations import constraint_variations
from symgen.methods.given.functions import GivenBy, measured, task
from symgen.methods.given.least_motion import LeastMotion
from symgen.methods.quantity import Quantity, is_fixed
from symgen.methods.redundancy.utilisation import utilisation
from symgen.methods.regressor import base_parameters, base_regressor, regressor
from symgen.model.availability import lacking
from symgen.model.inertial_parameters import inertial_parameters
from symgen.model.model import Model
from symgen.model.quantities import QUANTITIES, QuantityRow
from symgen.records import dataclass
from symgen.symbolic.matrix import Vector, flatten, matvec


@dataclass(frozen=True, slots=True)
class CatalogueEntry:
    """How one quantity is derived along a null space: its scalars, and what they divide by.

    Without `outputs` it is derived by the methods that `symgen.methods.table` has for it.
    """

    row: QuantityRow
    outputs: Callable[[Derivation], Vector] | None
    guards: Callable[[Derivation], tuple[Guard, ...]]

    @property
    def name(self) -> str:
        """The quantity's."""
        return self.row.name

    @property
    def needs(self) -> str:
        """What a model must have."""
        return self.row.needs

    def shape(self, sizes: Mapping[str, int]) -> tuple[int, ...]:
        """Of its result, in numbers."""
        return self.row.extents(sizes)


def _none(_: Derivation) -> tuple[Guard, ...]:
    return ()


def _constraint(d: Derivation) -> tuple[Guard, ...]:
    return d.space.guards


def _inertia(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *(g for g in d.inertia.guards if g not in d.space.guards))


def _weighted(d: Derivation) -> tuple[Guard, ...]:
    return _inertia(d) if d.r else ()


def _actuation(d: Derivation) -> tuple[Guard, ...]:
    return d.actuation_guards


def _inputs(d: Derivation) -> tuple[Guard, ...]:
    return d.inverse_dynamics_guards


def _actuator(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *d.actuation_guards)


def _residual(d: Derivation) -> tuple[Guard, ...]:
    return () if d.generic.full_actuation else (*d.space.guards, *d.actuation_guards)


def _partition(d: Derivation) -> tuple[Guard, ...]:
    return d.minimal.guards


def _partition_rate(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *d.minimal.guards)


def _variations(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *(g for g in d.geometric_space.guards if g not in d.space.guards))


def _given(given_by: GivenBy) -> Callable[[Derivation], tuple[Guard, ...]]:
    return lambda d: d.given_motion(given_by).guards


def _null_motion(d: Derivation) -> LeastMotion:
    motion = d.given_motion(task)
    assert isinstance(motion, LeastMotion)
    return motion


def _utilisation(d: Derivation) -> Vector:
    allocation = d.mechanics.model.allocation
    assert allocation is not None
    return (utilisation(d.mechanics, d.generic, allocation.limits, d.mechanics.balance),)


_Derived: TypeAlias = tuple[Callable[[Derivation], Vector] | None, Callable[[Derivation], tuple[Guard, ...]]]


def _configuration(given_by: GivenBy) -> _Derived:
    return (lambda d: d.given_configuration(given_by).outputs, lambda d: d.given_configuration(given_by).guards)


_BY_METHODS = (None, _none)
_DERIVED: dict[str, _Derived] = {
    "mass_matrix": (lambda d: flatten(d.mechanics.matrices.mass_matrix), _none),
    "coriolis_matrix": (lambda d: flatten(d.mechanics.matrices.coriolis_matrix(d.mechanics.qd)), _none),
    "coriolis_force": (lambda d: d.mechanics.coriolis_force, _none),
    "potential_force": (lambda d: d.mechanics.potential_force, _none),
    "applied_force": (lambda d: d.mechanics.applied_force, _none),
    "constraint_residual": (lambda d: d.mechanics.constraint_residual, _none),
    "constraint_jacobian": (lambda d: flatten(d.mechanics.constraint_jacobian), _none),
    "constraint_jacobian_dot": (lambda d: flatten(d.mechanics.constraint_jacobian_dot(d.mechanics.qd)), _none),
    "constraint_pseudoinverse": (lambda d: flatten(d.space.pseudoinverse), _constraint),
    "nullspace_projector": (lambda d: flatten(d.space.projector), _constraint),
    "nullspace_projector_dot": (lambda d: flatten(d.projector_dot(d.mechanics.qd)), _constraint),
    "weighted_pseudoinverse": (lambda d: flatten(d.weighted_pseudoinverse), _weighted),
    "weighted_nullspace_projector": (lambda d: flatten(d.weighted_projector), _weighted),
    "control_matrix": (lambda d: flatten(d.mechanics.control_matrix), _none),
    "projected_control_matrix": (
        lambda d: tuple(x for row in zip(*map(d.space.project, d.mechanics.inputs), strict=True) for x in row),
        _constraint,
    ),
    "projected_control_pseudoinverse": (lambda d: flatten(d.control_pseudoinverse), _actuation),
    "orthogonal_complement": (lambda d: flatten(d.minimal.complement), _partition),
    "projected_mass_matrix": (lambda d: flatten(d.projected_mass_matrix()), _constraint),
    "projected_coriolis_matrix": (lambda d: flatten(d.projected_coriolis_matrix()), _constraint),
    "projected_potential_force": (lambda d: d.space.project(d.mechanics.potential_force), _constraint),
    "projected_applied_force": (lambda d: d.space.project(d.mechanics.applied_force_at(d.admissible)), _constraint),
    "minimal_mass_matrix": (lambda d: flatten(d.minimal.matrix(d.mechanics.matrices.mass_matrix)), _partition),
    "minimal_coriolis_matrix": (lambda d: flatten(d.minimal.coriolis_matrix), _partition_rate),
    "minimal_potential_force": (lambda d: d.minimal.vector(d.mechanics.potential_force), _partition),
    "minimal_applied_force": (lambda d: d.minimal.vector(d.mechanics.applied_force), _partition),
    "minimal_control_matrix": (
        lambda d: tuple(x for row in zip(*map(d.minimal.vector, d.mechanics.inputs), strict=True) for x in row),
        _partition,
    ),
    "admissible_velocity": (lambda d: d.admissible, _constraint),
    "admissible_acceleration": (lambda d: d.admissible_acceleration(), _constraint),
    "projected_configuration": (lambda d: d.projected_configuration(), lambda d: d.newton_guards),
    "configuration_from_measured": _configuration(measured),
    "velocity_from_measured": (lambda d: d.given_motion(measured).velocity, _given(measured)),
    "acceleration_from_measured": (lambda d: d.given_motion(measured).acceleration, _given(measured)),
    "task_position": (lambda d: task(d.mechanics).functions, _none),
    "task_velocity": (lambda d: matvec(d.graph, task(d.mechanics).slopes, d.mechanics.qd), _none),
    "task_jacobian": (lambda d: flatten(task(d.mechanics).slopes), _none),
    "configuration_from_task": _configuration(task),
    "velocity_from_task": (lambda d: d.given_motion(task).velocity, _given(task)),
    "acceleration_from_task": (lambda d: d.given_motion(task).acceleration, _given(task)),
    "task_nullspace_projector": (lambda d: flatten(_null_motion(d).projector), _given(task)),
    "inverse_dynamics": _BY_METHODS,
    "inverse_dynamics_jacobian": (lambda d: flatten(d.inverse_dynamics_jacobian(d.mechanics.motion)), _inputs),
    "inverse_dynamics_gradient": (lambda d: d.inverse_dynamics_gradient(), _inputs),
    "inverse_dynamics_hessian_product": (lambda d: d.inverse_dynamics_hessian_product(), _inputs),
    "inverse_dynamics_parameter_jacobian": (
        lambda d: flatten(d.inverse_dynamics_jacobian(d.mechanics.parameters)),
        _inputs,
    ),
    "regressor": (lambda d: flatten(regressor(d)), _actuation),
    "base_regressor": (lambda d: flatten(base_regressor(d)), _actuation),
    "base_parameters": (base_parameters, _none),
    "constraint_variations": (lambda d: flatten(constraint_variations(d)), _variations),
    "inverse_dynamics_residual": (lambda d: d.inverse_dynamics_residual(), _residual),
    "friction_residual": (lambda d: d.friction_residual(), _inputs),
    "utilisation": (_utilisation, _actuator),
    "actuator_velocity": (actuator_velocity, _none),
    "actuator_mass_matrix": (lambda d: flatten(actuator_mass_matrix(d)), _actuation),
    "actuator_bias": (actuator_bias, _actuator),
    "forward_dynamics": _BY_METHODS,
    "forward_dynamics_jacobian": _BY_METHODS,
    "forward_dynamics_gradient": _BY_METHODS,
    "multipliers": _BY_METHODS,
    "multipliers_jacobian": _BY_METHODS,
    "energy": (lambda d: d.energy(), _none),
    "singularity": (lambda d: d.singularity(), _none),
    "point_position": (lambda d: d.mechanics.bodies.point_position, _none),
    "point_jacobian": (lambda d: flatten(d.mechanics.bodies.point_jacobian), _none),
}
CATALOGUE = tuple(CatalogueEntry(row, *_DERIVED[row.name]) for row in QUANTITIES)
BY_NAME = {entry.name: entry for entry in CATALOGUE}


def sizes(model: Model, generic: Genericity) -> dict[str, int]:
    """The sizes of a system, which shapes are made of."""
    geometric = sum(row.kind == "geometric" for row in model.constraints)
    of_system = {"n": generic.n, "r": generic.r, "r_g": geometric, "m": generic.m, "delta": generic.delta}
    of_system |= {"k": len(model.task), "points": len(model.mechanism.points), "parameters": len(model.parameters)}
    base = 0 if model.inertial_base is None else len(model.inertial_base.columns)
    return {
        **of_system,
        "inertial_parameters": len(inertial_parameters(model.mechanism)),
        "base_parameters": base,
    }


def missing(entry: CatalogueEntry, model: Model, generic: Genericity) -> str | None:
    """Why this system does not have a quantity, or None."""
    return lacking(entry.row, model, generic.delta, generic.alpha)


def by_blocks(entry: CatalogueEntry) -> bool:
    """Whether a quantity depends on the null space through N_B and B^+ alone, which blocks of B do not couple."""
    return entry.guards is _constraint


def derive(entry: CatalogueEntry, derivation: Derivation) -> Quantity:
    """A quantity along one null space."""
    assert entry.outputs is not None
    return derived_from(entry, derivation, entry.outputs(derivation), entry.guards)


def derived_from(
    entry: CatalogueEntry, derivation: Derivation, outputs: Vector, guards: Callable[[Derivation], tuple[Guard, ...]]
) -> Quantity:
    """The quantity of these outputs with its guards, where it depends on anything."""
    shape = entry.shape(sizes(derivation.mechanics.model, derivation.generic))
    if is_fixed(outputs) and not rests_on_rank(derivation.space):
        return Quantity(entry.name, shape, outputs, ())
    return Quantity(entry.name, shape, outputs, tested(guards(derivation)))
