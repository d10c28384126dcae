"""The CasADi witness against NumPy's pseudoinverses, derivatives and laws that need no second derivation."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import pytest
from shipped import NAMES
from witness_models import EXTRA

from symgen.model.configurations.assembly import ConfigurationRanks
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.witness.casadi_derivation import witness_functions
from symgen.witness.configurations import configurations
from symgen.witness.lagrange import differentiate
from symgen.witness.ranks import generic_ranks
from symgen.witness.translate import default_parameters

MODELS = Path(__file__).parents[2] / "models"


class Case:
    """One model, its witness functions and an admissible state with arbitrary rates."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.functions = witness_functions(model)
        self.parameters = default_parameters(model)
        generator = np.random.default_rng(7)
        self.q = next(configurations(model, differentiate(model), self.parameters, seed=3, trials=50))
        self.qd, self.qdd = generator.normal(size=model.n), generator.normal(size=model.n)
        self.u = generator.normal(size=model.m)

    def __call__(self, name: str, **changed: Any) -> Any:
        values = {"q": self.q, "qd": self.qd, "qdd": self.qdd, "u": self.u, "p": self.parameters} | changed
        return self.functions[name](*(values[argument] for argument in self.functions[name].name_in())).full()

    def rate(self, name: str, motion: dict[str, Any], **changed: Any) -> Any:
        """d/dt of a quantity of which the arguments in `motion` move, by CasADi's rules of differentiation."""
        function = self.functions[name]
        symbols = {argument: casadi.SX.sym(argument, *function.size_in(argument)) for argument in function.name_in()}
        value = function(*symbols.values())
        moving = [argument for argument in symbols if argument in motion]
        along = casadi.DM(np.concatenate([motion[argument] for argument in moving]))
        flat = casadi.jtimes(casadi.vec(value), casadi.vertcat(*(symbols[argument] for argument in moving)), along)
        values = {"q": self.q, "qd": self.qd, "qdd": self.qdd, "u": self.u, "p": self.parameters} | changed
        derivative = casadi.Function("rate", [*symbols.values()], [casadi.reshape(flat, *value.shape)])
        return derivative(*(values[argument] for argument in symbols)).full()


@functools.cache
def case(name: str) -> Case:
    return Case(load_text(EXTRA[name], name) if name in EXTRA else load_model(MODELS / f"{name}.yaml"))


EVERY = [*NAMES, *EXTRA]
CONSTRAINED = [name for name in EVERY if name not in ("double_pendulum", "under_actuated")]


@pytest.mark.parametrize(
    ("name", "ranks"),
    [
        ("front_car", ConfigurationRanks(2, 0, 2)),
        ("rapkm_2rrr_rr", ConfigurationRanks(4, 4, 2)),
        ("slider_crank", ConfigurationRanks(2, 2, 1)),
        ("cranks", ConfigurationRanks(5, 5, 1)),
        ("under_actuated", ConfigurationRanks(0, 0, 1)),
    ],
)
def test_generic_ranks(name: str, ranks: ConfigurationRanks) -> None:
    assert generic_ranks(case(name).model, differentiate(case(name).model)) == ranks


@pytest.mark.parametrize("name", CONSTRAINED)
def test_projectors_are_numpys(name: str) -> None:
    c = case(name)
    B, N = c("constraint_jacobian"), c("nullspace_projector")
    B_plus = np.linalg.pinv(B, rcond=1e-9)
    assert c("constraint_pseudoinverse") == pytest.approx(B_plus, abs=1e-10)
    assert N.tolist() == pytest.approx(np.eye(c.model.n) - B_plus @ B, abs=1e-10)
    if c.model.inputs:
        M_plus = np.linalg.pinv(N @ c("control_matrix"), rcond=1e-9)
        assert c("projected_control_pseudoinverse") == pytest.approx(M_plus, rel=1e-8, abs=1e-10)


@pytest.mark.parametrize("name", CONSTRAINED)
def test_projector_rate_keeps_a_projector_onto_the_kernel(name: str) -> None:
    """What N = Nᵀ, N² = N and B N = 0 are along an admissible velocity, differentiated: no other rate has all three."""
    c = case(name)
    v = c("admissible_velocity").ravel()
    B, N = c("constraint_jacobian"), c("nullspace_projector")
    B_dot, N_dot = c.rate("constraint_jacobian", {"q": v}), c("nullspace_projector_dot", qd=v)
    scale = 1 + np.linalg.norm(N_dot) + np.linalg.norm(B_dot)
    assert N_dot.tolist() == pytest.approx(N_dot.T, abs=1e-11 * scale)
    assert (N_dot @ N + N @ N_dot).tolist() == pytest.approx(N_dot, abs=1e-11 * scale)
    assert (B @ N_dot).tolist() == pytest.approx(-B_dot @ N, abs=1e-11 * scale * (1 + np.linalg.norm(B)))


@pytest.mark.parametrize("name", EVERY)
def test_christoffel_matrix(name: str) -> None:
    """Ġ − 2C is skew, and C q̇ is what the Lagrange equations leave at q̈ = 0."""
    c = case(name)
    G_dot = c.rate("mass_matrix", {"q": c.qd})
    C = c("coriolis_matrix")
    skew = G_dot - 2 * C
    assert skew + skew.T == pytest.approx(np.zeros_like(C), abs=1e-12 * (1 + np.linalg.norm(G_dot)))
    assert (C @ c.qd).tolist() == pytest.approx(c("coriolis_force").ravel(), rel=1e-12, abs=1e-12 * np.linalg.norm(C))


@pytest.mark.parametrize("name", EVERY)
def test_forward_dynamics_satisfies_the_equations_of_motion(name: str) -> None:
    c = case(name)
    qdd = c("forward_dynamics").ravel()
    balance = c("mass_matrix") @ qdd + (c("coriolis_force") + c("potential_force") - c("applied_force")).ravel()
    scale = 1 + np.linalg.norm(balance)
    if c.model.inputs:
        balance = balance - c("control_matrix") @ c.u
    if c.model.constraints:
        B, N = c("constraint_jacobian"), c("nullspace_projector")
        multipliers = c("multipliers").ravel()
        balance = balance + B.T @ multipliers
        reachable = B @ np.linalg.pinv(B, rcond=1e-9)
        assert B @ qdd == pytest.approx(-(reachable @ c("constraint_jacobian_dot") @ c.qd), abs=1e-9)
        assert reachable @ multipliers == pytest.approx(multipliers, rel=1e-8)
        assert c("weighted_nullspace_projector") @ N == pytest.approx(N, abs=1e-9)
    assert balance == pytest.approx(np.zeros(c.model.n), abs=1e-9 * scale)


@pytest.mark.parametrize("name", [name for name in EVERY if name != "double_pendulum"])
def test_inverse_dynamics_returns_the_inputs_of_least_norm(name: str) -> None:
    """An admissible motion under inputs u₀ needs M̃⁺M̃ u₀, and nothing is left over."""
    c = case(name)
    v = c("admissible_velocity").ravel()
    qdd = c("forward_dynamics", qd=v).ravel()
    expected = c("projected_control_pseudoinverse") @ c("projected_control_matrix") @ c.u
    assert c("inverse_dynamics", qd=v, qdd=qdd).ravel() == pytest.approx(expected, rel=1e-7, abs=1e-7)
    assert c("inverse_dynamics_residual", qd=v, qdd=qdd).ravel() == pytest.approx(np.zeros(c.model.n), abs=1e-7)


@pytest.mark.parametrize("name", ["skate", "front_car", "rapkm_two_drives"])
def test_actuator_equations_are_the_inverse_dynamics(name: str) -> None:
    """Remark 10: WᵀGW ν̇ + bias = u along an admissible motion, ν̇ the derivative of Mᵀ q̇."""
    c = case(name)
    v = c("admissible_velocity").ravel()
    qdd = c("forward_dynamics", qd=v).ravel()
    rate = c.rate("actuator_velocity", {"q": v, "qd": qdd}, qd=v).ravel()
    left = c("actuator_mass_matrix") @ rate + c("actuator_bias", qd=v).ravel()
    assert left == pytest.approx(c.u, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", EVERY)
def test_singularity_lies_between_zero_and_one(name: str) -> None:
    values = case(name)("singularity").ravel()
    assert np.all(values >= 0)
    assert np.all(values <= 1 + 1e-12)
