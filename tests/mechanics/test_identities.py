"""Shapes and identities of the derived quantities at states on and off the constraint manifold, by the interpreter."""

from __future__ import annotations

import math
import random
from functools import cache
from itertools import chain

import numpy as np
import pytest
import shipped
from laws_harness import System, shipped_system

from symgen.ir.kernel import Status
from symgen.model.quantities import ROWS
from symgen.quantities.catalogue import BY_NAME, sizes
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import State

# Every quantity of eight models is derived.
pytestmark = pytest.mark.slow
MODELS = (
    "skate",
    "front_car",
    "front_car_wheelset",
    "rear_car",
    "rapkm_2rrr_rr",
    "rapkm_two_drives",
    "slider_crank",
    "double_pendulum",
)
CLOSE = 2e-9


@cache
def states(name: str) -> tuple[State, ...]:
    """Regular states at random configurations, off the manifold too: identities hold everywhere."""
    given, source = shipped_system(name), random.Random(name)
    regular_states: list[State] = []
    while len(regular_states) < 3:
        q = [source.uniform(-1.4, 1.4) for _ in given.model.coordinates]
        rates = [source.uniform(-2, 2) for _ in q]
        state = given.state(q, rates)
        if min(value for row in given.matrix("singularity", state) for value in row) > 1e-2 and _regular(given, state):
            regular_states.append(state)
    return tuple(regular_states)


def _regular(given: System, state: State) -> bool:
    """What measured coordinates determine aside: that is on the manifold, and near enough to it."""
    names = (name for name in given.names if not ROWS[name].is_of_measured)
    return all(given.run(name, state)[0] is Status.OK for name in names)


def array(given: System, name: str, state: State) -> np.ndarray:
    return np.array(given.matrix(name, state))


def near(a: np.ndarray, b: np.ndarray, scale: float = 1.0) -> bool:
    size = scale * max(1.0, float(np.abs(a).max(initial=0)), float(np.abs(b).max(initial=0)))
    return a.shape == b.shape and bool(np.abs(a - b).max(initial=0) <= CLOSE * size)


@pytest.mark.parametrize("model", shipped.sparing(MODELS, ("rapkm_2rrr_rr", "rapkm_two_drives")))
def test_shapes(model: str) -> None:
    given = shipped_system(model)
    numbers = sizes(given.model, given.derivations.generic)
    for kernel in given.program().kernels:
        assert kernel.shape == BY_NAME[kernel.name].shape(numbers)
        assert len(kernel.outputs) == math.prod(kernel.shape) > 0


@pytest.mark.parametrize("model", MODELS)
def test_projector(model: str) -> None:
    given = shipped_system(model)
    for state in states(model):
        n = array(given, "nullspace_projector", state)
        assert near(n @ n, n)
        assert np.array_equal(n, n.T)
        assert np.trace(n) == pytest.approx(given.derivations.generic.delta)
        rate = array(given, "nullspace_projector_dot", state)
        assert near(rate, rate.T)
        assert near(rate, rate @ n + n @ rate)
        if given.derivations.generic.r == 0:
            continue
        b, inverse = (array(given, name, state) for name in ("constraint_jacobian", "constraint_pseudoinverse"))
        assert near(b @ n, 0 * b)
        assert near(b @ inverse @ b, b)
        assert near(inverse @ b @ inverse, inverse)
        assert near(inverse @ b, (inverse @ b).T)
        assert near(np.eye(len(n)) - inverse @ b, n)
        # d/dt (B N) = 0
        assert near(array(given, "constraint_jacobian_dot", state) @ n, -b @ rate, 100)


@pytest.mark.parametrize("model", [m for m in MODELS if m != "double_pendulum"])
def test_weighted_projector(model: str) -> None:
    given = shipped_system(model)
    for state in states(model):
        g, b, n = (array(given, x, state) for x in ("mass_matrix", "constraint_jacobian", "nullspace_projector"))
        weighted, inverse = (array(given, f"weighted_{x}", state) for x in ("nullspace_projector", "pseudoinverse"))
        assert near(weighted @ weighted, weighted)
        assert near(g @ weighted, (g @ weighted).T)
        assert near(b @ weighted, 0 * b)
        assert near(weighted @ n, n)
        assert near(b @ inverse, np.eye(len(b)))
        assert near(weighted + inverse @ b, np.eye(len(g)))


@pytest.mark.parametrize("model", MODELS)
def test_control_pseudoinverse(model: str) -> None:
    given = shipped_system(model)
    for state in states(model):
        m, inverse = (array(given, f"projected_control_{x}", state) for x in ("matrix", "pseudoinverse"))
        n = array(given, "nullspace_projector", state)
        assert near(n @ array(given, "control_matrix", state), m)
        assert near(m @ inverse @ m, m)
        assert near(inverse @ m @ inverse, inverse)
        assert near(m @ inverse, (m @ inverse).T)
        assert near(inverse @ m, (inverse @ m).T)
        assert near(inverse @ n, inverse)


@pytest.mark.parametrize("model", MODELS)
def test_orthogonal_complement_and_minimal_equations(model: str) -> None:
    given = shipped_system(model)
    chosen = [c.name for c in given.model.coordinates]
    independent = [chosen.index(name) for name in given.model.independent_velocities]
    assert independent
    for state in states(model):
        f, n = (array(given, name, state) for name in ("orthogonal_complement", "nullspace_projector"))
        assert np.array_equal(f[independent], np.eye(len(independent)))
        assert near(n @ f, f, 10)
        g = array(given, "mass_matrix", state)
        assert near(array(given, "minimal_mass_matrix", state), f.T @ g @ f, 10)
        assert near(array(given, "minimal_control_matrix", state), f.T @ array(given, "control_matrix", state), 10)
        for name in ("potential_force", "applied_force"):
            assert near(array(given, f"minimal_{name}", state), f.T @ array(given, name, state), 10)


@pytest.mark.parametrize("model", MODELS)
def test_projected_equations(model: str) -> None:
    given = shipped_system(model)
    for state in states(model):
        n, g = (array(given, name, state) for name in ("nullspace_projector", "mass_matrix"))
        assert near(array(given, "projected_mass_matrix", state), n @ g @ n)
        assert near(array(given, "projected_potential_force", state), n @ array(given, "potential_force", state))
        velocity = array(given, "admissible_velocity", state)
        assert near(velocity, n @ np.array([state.qd]).T)


@pytest.mark.parametrize("model", MODELS)
def test_rates_are_derivatives_along_the_motion(model: str) -> None:
    """Judged by the reference, which differentiates B and N_B by Taylor series at 50 digits."""
    given = shipped_system(model)
    rates = [name for name in ("nullspace_projector_dot", "constraint_jacobian_dot") if name in given.names]
    for state in states(model):
        for name, exact in given.reference.evaluate(state, rates).items():
            rate = array(given, name, state)
            assert near(rate, np.array([float(entry) for entry in exact]).reshape(rate.shape))


def rate_of(given: System, name: str, state: State, acceleration: np.ndarray | None = None) -> np.ndarray:
    """d/dt of a quantity where q moves with qd, and qd with the acceleration, by the rules of differentiation."""
    derivations = given.derivations
    system, graph = derivations.mechanics, derivations.mechanics.graph
    quantity = next(quantity for quantity in derivations.quantities if quantity.name == name)
    direction = dict(zip(system.q, system.qd, strict=True))
    numbers = zip(system.parameters, state.parameters, strict=True)
    if acceleration is not None:
        direction |= zip(system.qd, system.qdd, strict=True)
        state = State(state.q, state.qd, tuple(map(float, acceleration.flat)), state.u, state.parameters)
    for symbols, values in ((system.q, state.q), (system.qd, state.qd), (system.qdd, state.qdd)):
        numbers = chain(numbers, zip(symbols, values, strict=True))
    point = {str(symbol.payload): value for symbol, value in numbers}
    derivative = Evaluator(derivative_along(graph, quantity.outputs, direction))(point)
    return np.array(derivative).reshape(np.array(given.matrix(name, state)).shape)


@pytest.mark.parametrize("model", MODELS)
def test_coriolis_matrices_are_those_of_christoffel(model: str) -> None:
    """d/dt G - 2 C is skew; so is d/dt G~ - 2 C~ along admissible velocities and d/dt G- - 2 C-."""
    given = shipped_system(model)
    for state in states(model):
        velocity = tuple(row[0] for row in given.matrix("admissible_velocity", state))
        along = State(state.q, velocity, state.qdd, state.u, state.parameters)
        for kind in ("", "projected_", "minimal_"):
            rate = rate_of(given, f"{kind}mass_matrix", along)
            skew = rate - 2 * array(given, f"{kind}coriolis_matrix", along)
            assert near(skew, -skew.T, max(1.0, float(np.abs(rate).max())))
        force = array(given, "coriolis_force", state)
        assert near(force, array(given, "coriolis_matrix", state) @ np.array([state.qd]).T)


@pytest.mark.parametrize("model", MODELS)
def test_inverse_and_forward_dynamics_undo_each_other(model: str) -> None:
    given = shipped_system(model)
    for state in states(model):
        velocity = tuple(row[0] for row in given.matrix("admissible_velocity", state))
        moving = State(state.q, velocity, state.qdd, state.u, state.parameters)
        acceleration = array(given, "forward_dynamics", moving)
        back = State(state.q, velocity, tuple(acceleration[:, 0].tolist()), state.u, state.parameters)
        m, force = array(given, "control_matrix", state), np.array([state.u]).T
        # u again where it is unique, the same effect on the motion where it is not
        n = array(given, "nullspace_projector", state)
        assert near(n @ m @ array(given, "inverse_dynamics", back), n @ m @ force, 100)
        assert near(array(given, "inverse_dynamics_residual", back), 0 * acceleration, 1e3)
        if given.derivations.generic.r:
            # G q_ddot + B^T lambda = M u - C q_dot - Q + Q_a and B q_ddot = -B_dot q_dot
            b, g = array(given, "constraint_jacobian", state), array(given, "mass_matrix", state)
            rest = m @ force - sum(array(given, x, moving) for x in ("coriolis_force", "potential_force"))
            rest = rest + array(given, "applied_force", moving)
            assert near(g @ acceleration + b.T @ array(given, "multipliers", moving), rest, 100)
            rates = array(given, "constraint_jacobian_dot", moving) @ np.array([velocity]).T
            assert near(b @ acceleration, -rates, 100)


@pytest.mark.parametrize("model", ["skate", "front_car", "rear_car", "rapkm_two_drives", "slider_crank"])
def test_actuator_equations(model: str) -> None:
    """u = W^T G W nu_dot + bias along an admissible motion (Remark 10)."""
    given = shipped_system(model)
    for state in states(model):
        velocity = tuple(row[0] for row in given.matrix("admissible_velocity", state))
        moving = State(state.q, velocity, state.qdd, state.u, state.parameters)
        acceleration = np.array([given.matrix("forward_dynamics", moving)])[0]
        rate = rate_of(given, "actuator_velocity", moving, acceleration)
        expected = array(given, "actuator_mass_matrix", moving) @ rate + array(given, "actuator_bias", moving)
        assert near(expected, np.array([state.u]).T, 100)
