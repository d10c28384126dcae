"""The reference against formulas of the paper, laws of mechanics, and other ways to the same number."""

from __future__ import annotations

import random
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

import pytest
from flint import arb, arb_mat
from textbook_mechanisms import build, double_pendulum, skate, slider_crank, three_cranks

from symgen.model.model import Model
from symgen.verify.reference.arithmetic.linear import column, identity, norm, pseudoinverse
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import onto_manifold
from symgen.verify.reference.configurations.manifold import ManifoldRanks, starts
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import REFERENCE_DIGITS, Reference, ReferenceValueError, State

BITS = 256


def state_of(reference: Reference, seed: int = 0, admissible: bool = False) -> State:
    """A state on V to 1e-30 at least, with exact numbers."""
    generator = random.Random(seed)
    model = reference.model
    with precision(BITS):
        parameters = exact(default_parameters(model))
        candidates = starts(reference.system, generator, 20)
        projected = (onto_manifold(reference.system, x, parameters, reference.literals()) for x in candidates)
        q = tuple(next(x for x in projected if x is not None))

        def draw(count: int) -> tuple[float, ...]:
            return tuple(generator.uniform(-1, 1) for _ in range(count))

        state = State(q, draw(model.n), draw(model.n), draw(model.m), parameters)
        if admissible:
            values = reference.evaluate(state, ["admissible_velocity", "admissible_acceleration"])
            rates, accelerations = (exact(values[f"admissible_{kind}"]) for kind in ("velocity", "acceleration"))
            state = State(q, rates, accelerations, state.u, parameters)
    return state


def exact(values: Iterable[Any]) -> tuple[Any, ...]:
    """Midpoints: inputs without radius."""
    return tuple(value.mid() for value in values)


def everything(reference: Reference, state: State) -> dict[str, Any]:
    return reference.precise(state, reference.quantities())


def small(matrix: Any, limit: float = 1e-45) -> bool:
    with precision(BITS):
        return norm(matrix) < limit


def test_skate_agrees_with_equations_34_and_36() -> None:
    reference = Reference(skate())
    assert reference.ranks == ManifoldRanks(constraints=1, geometric=0, actuation=2)
    state = state_of(reference)
    y = everything(reference, state)
    with precision(BITS):
        s, c = arb(state.q[0]).sin_cos()
        projector = arb_mat([[1, 0, 0], [0, c * c, s * c], [0, s * c, s * s]])
        assert small(y["nullspace_projector"] - projector)
        assert small(y["projected_control_pseudoinverse"] - arb_mat([[1, 0, 0], [0, c, s]]))


def test_skate_obeys_the_corrected_equations_32_and_37() -> None:
    reference = Reference(skate())
    state = state_of(reference, seed=1, admissible=True)
    y = everything(reference, state)
    with precision(BITS):
        inertia, mass = state.parameters
        s, c = arb(state.q[0]).sin_cos()
        _, x_ddot, y_ddot = state.qdd
        expected = column([inertia * state.qdd[0], mass * (x_ddot * c + y_ddot * s)])
        assert small(y["inverse_dynamics"] - expected)
        speed = state.qd[1] * c + state.qd[2] * s
        assert small(y["multipliers"] - column([mass * speed * state.qd[0]]))


@pytest.mark.parametrize("model", [skate(), slider_crank(), double_pendulum()], ids=lambda m: m.name)
def test_forward_dynamics_and_multipliers_solve_the_kkt_system(model: Model) -> None:
    reference = Reference(model)
    state = state_of(reference, seed=2)
    y = everything(reference, state)
    with precision(BITS):
        force = -(y["coriolis_force"] + y["potential_force"] - y["applied_force"])
        force += y["control_matrix"] * column(state.u)
        if model.r:
            assert small(
                y["constraint_jacobian"] * y["forward_dynamics"] + y["constraint_jacobian_dot"] * column(state.qd)
            )
            force -= y["constraint_jacobian"].transpose() * y["multipliers"]
        assert small(y["mass_matrix"] * y["forward_dynamics"] - force, 1e-40)


def test_inverse_dynamics_undoes_forward_dynamics() -> None:
    reference = Reference(slider_crank())
    state = state_of(reference, seed=3, admissible=True)
    with precision(BITS):
        qdd = exact(reference.evaluate(state, ["forward_dynamics"])["forward_dynamics"])
    y = everything(reference, State(state.q, state.qd, qdd, state.u, state.parameters))
    with precision(BITS):
        assert small(y["inverse_dynamics"] - column(state.u))
        assert small(y["inverse_dynamics_residual"])


def test_energy_is_conserved_without_friction_and_inputs() -> None:
    """T + U along the flow of forward_dynamics: its first derivative, by a difference quotient of high order."""
    model = slider_crank()
    frictionless = build(
        "free",
        "a b x",
        _text_kinetic(),
        "m_2*9.81*(l_1*sin(a) + l_2/2*sin(b))",
        parameters={"l_1": "0.3", "l_2": "0.8", "J_1": "0.02", "m_2": "1.5", "J_2": "0.08", "m_3": "2"},
        geometric=("l_1*cos(a) + l_2*cos(b) - x", "l_1*sin(a) + l_2*sin(b)"),
    )
    assert model.n == frictionless.n
    reference = Reference(frictionless)
    state = state_of(reference, seed=4, admissible=True)
    with precision(BITS):
        qdd = column(reference.evaluate(state, ["forward_dynamics"])["forward_dynamics"])
        q, qd = column(state.q), column(state.qd)

        def energy(time: Any) -> Any:
            at = q + qd * time + qdd * (time * time / 2)
            moved = State(tuple(at.entries()), tuple((qd + qdd * time).entries()), state.qdd, (), state.parameters)
            kinetic, potential = reference.evaluate(moved, ["energy"])["energy"]
            return kinetic + potential

        h = arb(2) ** -60
        assert abs(float((energy(h) - energy(-h)) / (2 * h))) < 1e-30


def _text_kinetic() -> str:
    return (
        "J_1/2*a_dot**2 + m_2/2*((l_1*sin(a)*a_dot + l_2/2*sin(b)*b_dot)**2"
        " + (l_1*cos(a)*a_dot + l_2/2*cos(b)*b_dot)**2) + J_2/2*b_dot**2 + m_3/2*x_dot**2"
    )


@pytest.mark.parametrize("model", [skate(), slider_crank()], ids=lambda m: m.name)
def test_rates_of_projector_and_complement_match_difference_quotients(model: Model) -> None:
    reference = Reference(model)
    state = state_of(reference, seed=5)
    with precision(BITS):
        h = arb(2) ** -64
        moved = [
            State(
                tuple((column(state.q) + column(state.qd) * step).entries()),
                state.qd,
                state.qdd,
                state.u,
                state.parameters,
            )
            for step in (h, -h)
        ]
        ahead, behind = (reference.evaluation(s) for s in moved)
        here = reference.evaluation(state)
        quotient = (ahead.projector - behind.projector) * (1 / (2 * h))
        assert small(here.projector_dot(here.rate) - quotient, 1e-35)
        quotient = (ahead.complement - behind.complement) * (1 / (2 * h))
        assert small(here.complement_dot - quotient, 1e-35)
        quotient = (ahead.quasi - behind.quasi) * (1 / (2 * h))
        assert small(here.quasi_dot(here.rate) - quotient, 1e-35)


@pytest.mark.parametrize("model", [skate(), slider_crank(), double_pendulum(), three_cranks()], ids=lambda m: m.name)
def test_algebra_of_the_quantities(model: Model) -> None:
    reference = Reference(model)
    y = everything(reference, state_of(reference, seed=6))
    limit = 1e-40
    with precision(BITS):
        n = y["nullspace_projector"]
        g = y["mass_matrix"]
        assert small(n * n - n, limit)
        assert small(n - n.transpose(), limit)
        a, x = y["projected_control_matrix"], y["projected_control_pseudoinverse"]
        assert small(a * x * a - a, limit)
        assert small(x * a * x - x, limit)
        assert small(a * x - (a * x).transpose(), limit)
        assert small(x * a - (x * a).transpose(), limit)
        w = y["weighted_nullspace_projector"]
        assert small(w * w - w, limit)
        assert small(g * w - (g * w).transpose(), limit)
        if model.r:
            b = y["constraint_jacobian"]
            assert small(b * n, limit)
            assert small(b * w, limit)
            assert small(identity(model.n) - y["weighted_pseudoinverse"] * b - w, limit)


def test_skew_symmetry_needs_the_derivative_of_the_projected_mass() -> None:
    reference = Reference(slider_crank())
    state = state_of(reference, seed=7)
    with precision(BITS):
        e = reference.evaluation(state)
        v = e.projected_rate
        half = e.projector_dot(v) * e.at.mass * e.projector
        rate = half + half.transpose() + e.projector * e.mass_dot(v) * e.projector
        c = reference.precise(state, ["projected_coriolis_matrix"])["projected_coriolis_matrix"]
        assert small(rate - c - c.transpose())
        assert not small(e.projector * e.at.mass * e.projector - c - c.transpose(), 1e-3)


def test_dependent_constraints_have_their_generic_rank_everywhere() -> None:
    """Three parallel cranks at 90 degrees, where every fixed choice of five rows fails."""
    reference = Reference(three_cranks())
    assert reference.ranks.constraints == 5
    quarter = arb.pi
    with precision(BITS):
        upright = tuple([quarter() / 2] * 3 + [arb(0), arb(1), arb(0)])
        state = State(upright, (0.1,) * 6, (0.2,) * 6, (1, 1), tuple(default_parameters(reference.model)))
        y = reference.precise(state, ["nullspace_projector", "inverse_dynamics"])
        direction = column([1, 1, 1, -1, 0, 0])
        assert small(y["nullspace_projector"] - direction * direction.transpose() / 4)


def test_underactuated_pseudoinverse_has_the_generic_rank() -> None:
    """M of rank 1 with two inputs and three degrees of freedom."""
    model = build(
        "twins",
        "a b c",
        "a_dot**2 + b_dot**2/2 + c_dot**2/2 + cos(a - b)*a_dot*b_dot/4",
        inputs={"u_1": {"a": "1"}, "u_2": {"a": "2"}},
    )
    reference = Reference(model)
    assert reference.ranks.actuation == 1
    y = everything(reference, state_of(reference))
    with precision(BITS):
        expected = arb_mat([[1, 0, 0], [2, 0, 0]]) / 5
        assert small(y["projected_control_pseudoinverse"] - expected)
        assert not small(y["inverse_dynamics_residual"], 1e-3)
        rank_two = arb_mat([[1, 2, 3], [2, 4, 6], [1, 0, 1]])
        x = pseudoinverse(rank_two, 2)
        assert small(rank_two * x * rank_two - rank_two)
        assert small(x * rank_two - (x * rank_two).transpose())


def test_results_hold_fifty_digits_and_a_singular_state_is_refused() -> None:
    reference = Reference(slider_crank())
    state = state_of(reference)
    for name, entries in reference.evaluate(state, reference.quantities()).items():
        size = max(abs(float(entry)) for entry in entries)
        assert all(float(entry.rad()) <= 10.0**-REFERENCE_DIGITS * max(size, 1e-10) for entry in entries), name
    folded = build("folded", "x y", "x_dot**2/2 + y_dot**2/2", geometric=("(x**2 + y**2 - 1)*x",))
    state = State((0, 1), (0, 0), (0, 0), (), ())
    with pytest.raises(ReferenceValueError, match="rank drops"):
        Reference(folded, ManifoldRanks(1, 1, 0)).evaluate(state, ["nullspace_projector"])


def test_projected_configuration_is_two_newton_steps() -> None:
    model = build("circle", "x y", "x_dot**2/2 + y_dot**2/2", geometric=("x**2 + y**2 - 1",))
    state = State((Fraction(3, 2), 0), (0, 0), (0, 0), (), ())
    x, y = Reference(model).evaluate(state, ["projected_configuration"])["projected_configuration"]
    first = Fraction(3, 2) - (Fraction(9, 4) - 1) / 3
    second = first - (first**2 - 1) / (2 * first)
    assert abs(float(x - second.numerator / arb(second.denominator))) < 1e-15
    assert float(y) == 0
