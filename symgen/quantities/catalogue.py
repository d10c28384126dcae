"""Which quantities a system has, their shapes, and the derivation of each: one explicit line per quantity."""

from __future__ import annotations

from collections.abc import Callable

from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_spaces import rests_on_rank
from symgen.mechanics.genericity import Genericity
from symgen.methods.derivation import Derivation
from symgen.methods.quantity import Quantity, is_fixed
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.matrix import Vector, flatten


@dataclass(frozen=True, slots=True)
class Sizes:
    """The numbers shapes are made of."""

    n: int
    r: int
    r_g: int
    m: int
    delta: int
    points: int


@dataclass(frozen=True, slots=True)
class Entry:
    """How one quantity is derived: its shape and its scalars; `needs` names what else must hold for it to exist."""

    name: str
    shape: Callable[[Sizes], tuple[int, ...]]
    outputs: Callable[[Derivation], Vector]
    guards: Callable[[Derivation], tuple[Guard, ...]] = lambda _: ()
    needs: tuple[str, ...] = ()


def _constraint(d: Derivation) -> tuple[Guard, ...]:
    return d.space.guards


def _inertia(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *(g for g in d.inertia.guards if g not in d.space.guards))


def _weighted(d: Derivation) -> tuple[Guard, ...]:
    return _inertia(d) if d.r else ()


def _actuation(d: Derivation) -> tuple[Guard, ...]:
    return d.actuation_guards


def _inverse_dynamics(d: Derivation) -> tuple[Guard, ...]:
    return d.inverse_dynamics_guards


def _actuator(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *d.actuation_guards)


def _residual(d: Derivation) -> tuple[Guard, ...]:
    return () if d.generic.full_actuation else (*d.space.guards, *d.actuation_guards)


def _partition(d: Derivation) -> tuple[Guard, ...]:
    return d.partition_guards


def _partition_rate(d: Derivation) -> tuple[Guard, ...]:
    return (*d.space.guards, *d.partition_guards)


def _nxn(s: Sizes) -> tuple[int, ...]:
    return s.n, s.n


def _n(s: Sizes) -> tuple[int, ...]:
    return (s.n,)


def _nxm(s: Sizes) -> tuple[int, ...]:
    return s.n, s.m


def _rxn(s: Sizes) -> tuple[int, ...]:
    return s.r, s.n


def _nxr(s: Sizes) -> tuple[int, ...]:
    return s.n, s.r


def _dxd(s: Sizes) -> tuple[int, ...]:
    return s.delta, s.delta


def _d(s: Sizes) -> tuple[int, ...]:
    return (s.delta,)


PARTITION = ("independent_velocities",)
ACTUATORS = ("m = delta",)
POINTS = ("points",)

CATALOGUE: tuple[Entry, ...] = (
    Entry("mass_matrix", _nxn, lambda d: flatten(d.mechanics.mass_matrix)),
    Entry("coriolis_matrix", _nxn, lambda d: flatten(d.mechanics.coriolis_matrix(d.mechanics.qd))),
    Entry("coriolis_force", _n, lambda d: d.mechanics.coriolis_force),
    Entry("potential_force", _n, lambda d: d.mechanics.potential_force),
    Entry("applied_force", _n, lambda d: d.mechanics.applied_force),
    Entry("constraint_residual", lambda s: (s.r_g,), lambda d: d.mechanics.constraint_residual),
    Entry("constraint_jacobian", _rxn, lambda d: flatten(d.mechanics.constraint_jacobian)),
    Entry("constraint_jacobian_dot", _rxn, lambda d: flatten(d.mechanics.constraint_jacobian_dot(d.mechanics.qd))),
    Entry("constraint_pseudoinverse", _nxr, lambda d: flatten(d.space.pseudoinverse), _constraint),
    Entry("nullspace_projector", _nxn, lambda d: flatten(d.space.projector), _constraint),
    Entry("nullspace_projector_dot", _nxn, lambda d: flatten(d.projector_dot(d.mechanics.qd)), _constraint),
    Entry("weighted_pseudoinverse", _nxr, lambda d: flatten(d.weighted_pseudoinverse), _weighted),
    Entry("weighted_nullspace_projector", _nxn, lambda d: flatten(d.weighted_projector), _weighted),
    Entry("control_matrix", _nxm, lambda d: flatten(d.mechanics.control_matrix)),
    Entry(
        "projected_control_matrix",
        _nxm,
        lambda d: tuple(x for row in zip(*map(d.space.project, d.mechanics.inputs), strict=True) for x in row),
        _constraint,
    ),
    Entry(
        "projected_control_pseudoinverse",
        lambda s: (s.m, s.n),
        lambda d: flatten(d.control_pseudoinverse),
        _actuation,
    ),
    Entry("orthogonal_complement", lambda s: (s.n, s.delta), lambda d: flatten(d.complement), _partition, PARTITION),
    Entry("projected_mass_matrix", _nxn, lambda d: flatten(d.projected_mass_matrix()), _constraint),
    Entry("projected_coriolis_matrix", _nxn, lambda d: flatten(d.projected_coriolis_matrix()), _constraint),
    Entry("projected_potential_force", _n, lambda d: d.space.project(d.mechanics.potential_force), _constraint),
    Entry(
        "projected_applied_force",
        _n,
        lambda d: d.space.project(d.mechanics.applied_force_at(d.admissible)),
        _constraint,
    ),
    Entry("minimal_mass_matrix", _dxd, lambda d: flatten(d.minimal(d.mechanics.mass_matrix)), _partition, PARTITION),
    Entry("minimal_coriolis_matrix", _dxd, lambda d: flatten(d.minimal_coriolis_matrix()), _partition_rate, PARTITION),
    Entry(
        "minimal_potential_force",
        _d,
        lambda d: d.minimal_vector(d.mechanics.potential_force),
        _partition,
        PARTITION,
    ),
    Entry("minimal_applied_force", _d, lambda d: d.minimal_vector(d.mechanics.applied_force), _partition, PARTITION),
    Entry(
        "minimal_control_matrix",
        lambda s: (s.delta, s.m),
        lambda d: tuple(x for row in zip(*map(d.minimal_vector, d.mechanics.inputs), strict=True) for x in row),
        _partition,
        PARTITION,
    ),
    Entry("admissible_velocity", _n, lambda d: d.admissible, _constraint),
    Entry("admissible_acceleration", _n, lambda d: d.admissible_acceleration(), _constraint),
    Entry("projected_configuration", _n, lambda d: d.projected_configuration(), lambda d: d.newton_guards),
    Entry("inverse_dynamics", lambda s: (s.m,), lambda d: d.inverse_dynamics, _inverse_dynamics),
    Entry("inverse_dynamics_residual", _n, lambda d: d.inverse_dynamics_residual(), _residual),
    Entry("actuator_velocity", lambda s: (s.m,), lambda d: d.actuator_velocity(), needs=ACTUATORS),
    Entry(
        "actuator_mass_matrix",
        lambda s: (s.m, s.m),
        lambda d: flatten(d.actuator_mass_matrix()),
        _actuation,
        ACTUATORS,
    ),
    Entry("actuator_bias", lambda s: (s.m,), lambda d: d.actuator_bias(), _actuator, ACTUATORS),
    Entry("forward_dynamics", _n, lambda d: d.forward_dynamics, lambda d: d.acceleration.guards),
    Entry("multipliers", lambda s: (s.r,), lambda d: d.multipliers(), lambda d: d.reaction.guards),
    Entry("energy", lambda _: (2,), lambda d: d.energy()),
    Entry("singularity", lambda _: (2,), lambda d: d.singularity()),
    Entry("point_position", lambda s: (s.points, 3), lambda d: d.mechanics.bodies.point_position, needs=POINTS),
    Entry(
        "point_jacobian",
        lambda s: (3 * s.points, s.n),
        lambda d: flatten(d.mechanics.bodies.point_jacobian),
        needs=POINTS,
    ),
)
BY_NAME = {entry.name: entry for entry in CATALOGUE}


def sizes(model: Model, generic: Genericity) -> Sizes:
    """The sizes of a system."""
    geometric = sum(row.kind == "geometric" for row in model.constraints)
    return Sizes(generic.n, generic.r, geometric, generic.m, generic.delta, len(model.mechanism.points))


def missing(entry: Entry, model: Model, generic: Genericity) -> str | None:
    """Why this system does not have a quantity, or None."""
    if entry.needs == POINTS and not model.mechanism.points:
        return "the model has no points"
    shape = entry.shape(sizes(model, generic))
    if 0 in shape:
        return "its result would be empty"
    if PARTITION[0] in entry.needs and not model.independent_velocities:
        return "the model names no independent_velocities"
    if ACTUATORS[0] in entry.needs and not (generic.m == generic.delta == generic.alpha):
        return "it needs as many independent inputs as degrees of freedom"
    return None


def by_blocks(entry: Entry) -> bool:
    """Whether a quantity depends on the null space through N_B and B^+ alone, which blocks of B do not couple."""
    return entry.guards is _constraint


def derive(entry: Entry, derivation: Derivation) -> Quantity:
    """A quantity along one null space."""
    shape = entry.shape(sizes(derivation.mechanics.model, derivation.generic))
    outputs = entry.outputs(derivation)
    if is_fixed(outputs) and not rests_on_rank(derivation.space):
        return Quantity(entry.name, shape, outputs, ())
    guards = tuple(guard for guard in entry.guards(derivation) if guard.denominator.constant is None)
    return Quantity(entry.name, shape, outputs, guards)
