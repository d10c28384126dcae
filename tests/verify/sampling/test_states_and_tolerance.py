"""Verification states lie where they should, and the tolerance is d + eps |y|, 16 times."""

from __future__ import annotations

import struct
from fractions import Fraction
from itertools import pairwise
from math import pi
from typing import Any

import pytest
from flint import arb
from linkages import row_of_four_bars
from textbook_mechanisms import build, double_pendulum, skate, slider_crank, three_cranks

from symgen.model.expressions.expression import Pi
from symgen.model.load import load_text
from symgen.verify.expected import Expected
from symgen.verify.reference.arithmetic.linear import column, norm
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import VerificationError, affordable_states, rounded, sample_states
from symgen.verify.tolerance import expectations, is_beyond, perturbed


def test_states_satisfy_the_constraints_and_half_of_the_rates_do() -> None:
    reference = Reference(slider_crank())
    samples = sample_states(reference, ["mass_matrix"], 16)
    assert len(samples) == 16
    assert [sample.admissible for sample in samples] == [index % 2 == 0 for index in range(16)]
    for index, sample in enumerate(samples):
        y = reference.matrices(sample.state, ["constraint_residual", "constraint_jacobian", "constraint_jacobian_dot"])
        with precision(128):
            rates = y["constraint_jacobian"] * column(sample.state.qd)
            accelerations = y["constraint_jacobian"] * column(sample.state.qdd)
            accelerations += y["constraint_jacobian_dot"] * column(sample.state.qd)
            drifted = index % 4 == 3
            assert (norm(y["constraint_residual"]) < 1e-14) is not drifted
            assert (norm(rates) < 1e-14) is sample.admissible
            assert (norm(accelerations) < 1e-13) is sample.admissible


def test_states_are_deterministic_spread_and_vary_ranged_parameters() -> None:
    samples = sample_states(Reference(skate()), ["mass_matrix"], 12)
    assert samples == sample_states(Reference(skate()), ["mass_matrix"], 12)
    assert samples != sample_states(Reference(skate()), ["mass_matrix"], 12, seed=1)
    masses = {sample.state.parameters[1] for sample in samples}
    # those of the file in two of five, so that what is special in them is met
    assert len(masses) == 8
    assert sum(sample.state.parameters[1] == 2.5 for sample in samples) == 5
    assert all(2 <= mass <= 3 or mass == 2.5 for mass in masses)
    assert {sample.state.parameters[0] for sample in samples} == {0.8}
    assert max(abs(sample.state.q[0]) for sample in samples) > 1.5


def test_dependent_constraints_get_states_without_drift() -> None:
    reference = Reference(three_cranks())
    for sample in sample_states(reference, ["mass_matrix"], 8):
        residual = reference.matrices(sample.state, ["constraint_residual"])["constraint_residual"]
        assert norm(residual) < 1e-14


def test_states_stay_where_the_inputs_reach_no_more_than_on_the_constraints() -> None:
    # on x = y both forces push along the same line; beside it they do not
    reference = Reference(
        build(
            "two_pushes",
            "x y a b",
            "x_dot**2 + y_dot**2 + m*a_dot**2 + b_dot**2",
            parameters={"m": "3", "s": "0.7"},
            geometric=("x - y",),
            inputs={"F": {"a": "sqrt(s)*cos(x)", "b": "sqrt(s)*sin(x)"}, "G": {"a": "cos(y)", "b": "sin(y)"}},
        )
    )
    assert reference.ranks.actuation == 1
    for sample in sample_states(reference, ["inverse_dynamics"], 16):
        residual = reference.matrices(sample.state, ["constraint_residual"])["constraint_residual"]
        assert norm(residual) < 1e-14


@pytest.mark.parametrize("gain", ["5e-38", "1", "2e41"])
def test_units_of_inputs_are_no_measure_of_each_other(gain: str) -> None:
    inputs = {"F": {"x": f"{gain}*x", "y": gain}, "G": {"x": "3", "y": "y"}}
    reference = Reference(build("gains", "x y", "x_dot**2 + y_dot**2", inputs=inputs))
    assert reference.ranks.actuation == 2


def test_joints_that_cannot_move_have_no_rate() -> None:
    # a triangle of two cranks is rigid beside a slider: what projection leaves of its rates is noise
    reference = Reference(
        build(
            "triangle",
            "a b x",
            "J/2*(a_dot**2 + b_dot**2) + m/2*x_dot**2",
            parameters={"J": "0.2", "m": "3"},
            geometric=("2*cos(a) + cos(b) - 2.2", "2*sin(a) + sin(b) - 1.3"),
            inputs={"F": {"x": "1"}},
            configuration={"a": "0.1", "b": "1.5", "x": "0"},
        )
    )
    samples = [sample for sample in sample_states(reference, ["coriolis_force"], 8) if sample.admissible]
    assert samples
    for sample in samples:
        assert sample.state.qd[:2] == (0, 0)
        assert sample.state.qd[2] != 0
        assert sample.state.qdd[:2] == (0, 0)


def test_no_state_where_a_row_of_the_jacobian_all_but_vanishes() -> None:
    # three parallel cranks: Newton's method is drawn to all of them in line, where the singularity measures stay large
    reference = Reference(
        build(
            "parallelogram",
            "a b c d",
            "a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2",
            geometric=(
                "cos(a) + 2*cos(d) - 2 - cos(b)",
                "sin(a) + 2*sin(d) - sin(b)",
                "cos(a) + cos(d) - 1 - cos(c)",
                "sin(a) + sin(d) - sin(c)",
            ),
        )
    )
    samples = sample_states(reference, ["constraint_jacobian"], 32)
    assert min(abs(float(sample.state.q[0])) for sample in samples) > 1e-4


def test_rounding_to_float32_is_exact_in_float32() -> None:
    (sample, *_) = sample_states(Reference(double_pendulum()), ["mass_matrix"], 8)
    for value in rounded(sample, "float32").state.q:
        assert struct.unpack("f", struct.pack("f", value))[0] == value
    assert rounded(sample, "float64") is sample


def test_too_few_states_are_an_error() -> None:
    nowhere = build("nowhere", "x y", "x_dot**2/2 + y_dot**2/2", "sqrt(-1 - x**2)")
    with pytest.raises(VerificationError, match="only 0 regular configurations"):
        sample_states(Reference(nowhere), ["potential_force"], 8)


def test_affordable_states_shrink_with_the_model_only() -> None:
    assert affordable_states(Reference(slider_crank()), ["mass_matrix"], 64) == 64
    assert affordable_states(Reference(slider_crank()), ["mass_matrix"], 1000) == 1000
    names = [f"x_{i}" for i in range(30)]
    masses = [f"{n}_dot**2" for n in names]
    coupled = [f"({a}_dot - {b}_dot)**2" for a, b in pairwise(names)]
    long_chain = build("chain", " ".join(names), " + ".join([*masses, *coupled]))
    assert 8 <= affordable_states(Reference(long_chain), ["mass_matrix"], 64) < 64
    apart = build("apart", " ".join(names), " + ".join(masses))
    assert affordable_states(Reference(apart), ["mass_matrix"], 64) == 64


def test_error_unit_follows_condition_inputs_parameters_and_literals() -> None:
    """U' = 3 k x**2 moves by up to (2 + 1 + 1 + 1) eps |U'|: x twice, k and the literals 3 and 3 once each."""
    model = build("spring", "x", "x_dot**2/2", "3*k*x**3/3", parameters={"k": "0.7"})
    reference = Reference(model)
    state = State((0.3,), (0.1,), (0.2,), (), (0.7,))
    for scalar, eps in (("float64", 2.0**-53), ("float32", 2.0**-24)):
        expectation = expectations(reference, state, ["potential_force"], scalar, "seed")["potential_force"]
        assert expectation.size == pytest.approx(0.189, rel=1e-12)
        assert 2 * eps * expectation.size < expectation.unit < 6.01 * eps * expectation.size


@pytest.mark.parametrize("units", [0.0, 0.5, 3.0, 15.9, 16.1, 40.0])
def test_what_is_beyond_needs_no_more_changes_than_it_takes(units: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The verdict is that of all changes; what is right to the roundoff of the value asks for none."""
    model = build("spring", "x", "x_dot**2/2", "3*k*x**3/3", parameters={"k": "0.7"})
    reference = Reference(model)
    state = State((0.3,), (0.1,), (0.2,), (), (0.7,))
    expectation = expectations(reference, state, ["potential_force"], "float32", "seed")["potential_force"]
    entries = [float(expectation.value[0, 0]) + units * expectation.unit]
    evaluated = 0
    matrices: Any = Reference.matrices

    def counted(*given: Any) -> Any:
        nonlocal evaluated
        evaluated += 1
        return matrices(*given)

    monkeypatch.setattr(Reference, "matrices", counted)
    assert is_beyond(reference, state, "potential_force", "float32", "seed", entries, 16.0) == (units > 16)
    # the value itself, and up to eight changes
    if units < 1:
        assert evaluated == 1
    elif units > 16:
        assert evaluated == 9
    else:
        assert 1 <= evaluated <= 9


def test_perturbations_move_every_number_by_eps() -> None:
    reference = Reference(slider_crank())
    state = sample_states(reference, ["mass_matrix"], 8)[0].state
    with precision(200):
        signs = [k % 2 for k in range(100)]
        moved, literals = perturbed(reference, state, "float32", signs)
        eps = Fraction(1, 2**24)
        before = [*state.q, *state.qd, *state.qdd, *state.u, *state.parameters]
        after = [*moved.q, *moved.qd, *moved.qdd, *moved.u, *moved.parameters]
        for x, y in zip(before, after, strict=True):
            assert abs(y - x) == abs(arb(x)) * arb(eps.numerator) / arb(eps.denominator)
        assert len(literals) == len(reference.literals()) > 3


def test_perturbations_leave_literals_that_the_type_holds() -> None:
    """0.3 moves, in two places; 3 and 0.5 are held by both types, 2^24 + 1 by float64 only."""
    model = build("made_up", "x y", "x_dot**2/2 + y_dot**2/2", "0.3*x + 0.3*y + 3*x**2 + 0.5*y**2 + 16777217*x*y")
    reference = Reference(model)
    state = State((0.3, 0.2), (0.1, 0.1), (0.2, 0.2), (), ())
    for scalar, moving in (("float64", {0.3}), ("float32", {0.3, 16777217.0})):
        for first_sign in (0, 1):
            with precision(200):
                _, literals = perturbed(reference, state, scalar, [(k + first_sign) % 2 for k in range(100)])
                pairs = [(float(x), float(y / x - 1)) for x, y in zip(reference.literals(), literals, strict=True)]
            assert {x for x, shift in pairs if abs(shift) > 1e-17} == moving


MAST = """\
model: mast
gravity: [0, 0, -9.81]
joints:
  post: {{type: revolute, axis: z, coordinate: a}}
  head: {{type: revolute, parent: post, rotation: [[x, {turn}]], axis: y, coordinate: b}}
bodies: {{post: {{mass: 2, inertia: {{zz: 0.25}}}}, head: {{mass: 1, com: [0.5, 0, 0], inertia: {{yy: 0.125}}}}}}
points: {{tip: {{frame: head, at: [0.75, 0, 0]}}, anchor: {{at: [1.25, 0.5, 0]}}}}
loops: {{rod: {{type: distance, between: [tip, anchor], length: 1}}}}
inputs: {{drive: {{joint: a}}}}
"""


@pytest.mark.parametrize(("turn", "stays"), [("pi/2", True), ("-3*pi/2", True), ("pi*0.49", False)])
def test_quarter_turns_are_directions(turn: str, stays: bool) -> None:
    """No kernel rounds the pi of a quarter turn, with which the axes were not parallel and N_B not constant."""
    reference = Reference(load_text(MAST.format(turn=turn), "mast.yaml"))
    with precision(100):
        assert any(abs(x - arb.pi()) < 1e-20 for x in reference.literals()) != stays
    state = sample_states(reference, ["nullspace_projector"], 8)[0].state
    unit = expectations(reference, state, ["nullspace_projector"], "float64", "seed")["nullspace_projector"].unit
    assert (unit < 1.001 * 2.0**-53) == stays


def test_equal_numbers_do_not_always_move_together() -> None:
    """By chance they did for one seed in 256, and what vanishes where they are equal had no unit of error."""
    reference = Reference(build("twins", "x y", "x_dot**2/2 + y_dot**2/2", "(x - y)**2/2"))
    state = State((0.7, 0.7), (0.0, 0.0), (0.0, 0.0), (), ())
    for seed in range(1000):
        expectation = expectations(reference, state, ["potential_force"], "float64", f"{seed}")["potential_force"]
        assert expectation.unit > 2.0**-53 * 0.7


def test_distance_is_exact_where_floats_cancel() -> None:
    reference = Reference(double_pendulum())
    sample = sample_states(reference, ["mass_matrix"], 8)[0]
    expectation = expectations(reference, sample.state, ["mass_matrix"], "float64", "seed")["mass_matrix"]
    nearest = [float(entry) for entry in expectation.value.entries()]
    assert 0 < expectation.distance(nearest) <= 2.0**-53 * expectation.size
    assert expectation.in_units(expectation.distance(nearest)) < 1
    worse = [nearest[0] * (1 + 2.0**-40), *nearest[1:]]
    assert expectation.in_units(expectation.distance(worse)) > 16


@pytest.mark.campaign
def test_states_are_found_where_most_branches_hold_the_drive() -> None:
    """Of twelve four-bars in a row each may lie on a branch that stops those before it."""
    model = load_text(row_of_four_bars(12), "row.yaml")
    reference = Reference(model)
    samples = sample_states(reference, ("inverse_dynamics",), 12)
    assert len(samples) == 12
    assert all(sample.measures[1] > 0 for sample in samples)


def test_angles_far_outside_of_their_ranges_are_not_taken() -> None:
    # near a pose where rows depend on each other, a step that is to satisfy them throws angles turns away
    model = load_text(
        """
model: closed_chain
coordinates: {a: {unit: rad, range: [-2.35, -1.29]}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}, e: {unit: rad}}
parameters: {l: {value: 1, range: [0.7, 1.4]}}
kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2 + e_dot**2
constraints:
  geometric:
    rod: l**2*(cos(b) + cos(c))**2 + l**2*(sin(b) + sin(c))**2 - 2.141474403335406
    close_x: l*(cos(a) + cos(b) + cos(c)) + 0.0646334804616911
    close_y: l*(sin(a) + sin(b) + sin(c)) - 0.4971771243905144
inputs: {motor: {acts_on: {d: 1}}}
configuration: {a: -1.92, b: 0.63, c: 2.13, d: -2.38, e: -0.71}
""",
        "closed_chain.yaml",
    )
    samples = sample_states(Reference(model), ["mass_matrix"], 64)
    assert max(abs(x) for sample in samples for x in sample.state.q) <= 5 * pi + 0.1


def test_where_a_loop_stands_still_nearly_stretched_its_small_measure_is_regular() -> None:
    """It is the same wherever the machine goes; elsewhere, off the constraints, it is a thousand times as large."""
    model = load_text(
        "model: dyad\ncoordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}\n"
        "kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2\n"
        "constraints:\n  geometric:\n    x: cos(a) + 0.5*cos(b) - 1.499999*cos(0.7)\n"
        "    y: sin(a) + 0.5*sin(b) - 1.499999*sin(0.7)\n"
        "configuration: {a: 0.6995, b: 0.701}\n",
        "dyad.yaml",
    )
    samples = sample_states(Reference(model), ("forward_dynamics",), 8)
    assert len(samples) == 8
    assert all(0 < sample.measures[0] < 1e-4 for sample in samples)
    assert len({sample.state.q[2] for sample in samples}) == 8


def far_away(reach: int) -> Expected:
    """A row that vanishes at one place so far from 0 that single precision has few numbers beside it."""
    text = f"""\
model: far_away
coordinates: {{x: {{}}, y: {{}}, z: {{}}}}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2
constraints: {{nonholonomic: {{row: (x - 1e8)*y_dot}}}}
inputs: {{u: {{acts_on: {{z: 1}}}}}}
ranges: {{x: [{10**8 - reach}, {10**8 + reach}]}}
"""
    model = load_text(text, "far_away.yaml")
    return Expected(model, ["nullspace_projector"], 24, lambda _: None)


def test_states_that_are_singular_once_they_are_rounded_are_let_go_of() -> None:
    expected = far_away(20)
    assert len(expected.values("float64")) == len(expected.samples("float64")) == 24
    assert 8 <= len(expected.values("float32")) == len(expected.samples("float32")) < 24
    assert all(sample.state.q[0] != 1e8 for sample in expected.samples("float32"))


def test_where_too_few_states_are_left_once_they_are_rounded_a_remedy_is_told() -> None:
    expected = far_away(3)
    assert len(expected.values("float64")) == 24
    with pytest.raises(VerificationError, match=r"only 0 regular .* rounded to float32 .*; give .*--scalar float64"):
        expected.values("float32")


def test_independent_velocities_that_fail_at_the_start_are_no_matter_of_verification() -> None:
    """A ring on a sphere, told by its first two places: on the equator, where it starts, the third is anything."""
    text = """\
model: ring
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2
constraints: {geometric: {sphere: x**2 + y**2 + z**2 - 1}}
inputs: {u: {acts_on: {z: 1}}}
independent_velocities: [x, y]
configuration: {x: 0.6, y: 0.8, z: 0}
"""
    reference = Reference(load_text(text, "ring.yaml"))
    heights = {name: [abs(s.state.q[2]) for s in sample_states(reference, [name], 16)] for name in
               ("mass_matrix", "minimal_mass_matrix")}  # fmt: skip
    assert min(heights["mass_matrix"]) == 0
    assert min(heights["minimal_mass_matrix"]) > 1e-4


def test_quarter_turns_that_are_written_out_are_no_literals() -> None:
    """Two slides along y and a rod that never turns: moved, pi/2 turned the light slides' rush into a weight."""
    text = """\
model: slides
coordinates: {s: {unit: m}, w: {unit: m}, a: {unit: rad}}
parameters: {l: {value: 0.8}, m: {value: 2e-6}}
definitions:
  x: s*cos(pi/2) + w*cos(-pi*3/2) + l*cos(a)
  y: s*sin(pi/2) - w*sin(3*pi/2) + l*sin(a) + l*sin(pi/6)
kinetic_energy: m/2*s_dot**2 + m/2*(s_dot + 0.4*w_dot)**2 + 3/2*(s_dot + w_dot)**2 + a_dot**2*cos(pi/7)
potential_energy: 3*9.81*y
constraints: {geometric: {along: x - 0.7, across: y - 1.9}}
inputs: {u: {acts_on: {s: 1}}}
configuration: {s: 0.4, w: 0.7, a: 0.5}
"""
    reference = Reference(load_text(text, "slides.yaml"))
    assert [literal for literal in reference.system.literals if isinstance(literal, Pi)] == [Pi()]
    samples = [sample for sample in sample_states(reference, ["multipliers"], 16) if sample.admissible]
    assert samples
    for sample in samples:
        (rows,) = reference.matrices(sample.state, ["constraint_jacobian"]).values()
        assert (rows[0, 0], rows[0, 1], rows[1, 0], rows[1, 1]) == (0, 0, 1, 1)
        expected = expectations(reference, sample.state, ["multipliers"], "float64", "slides")["multipliers"]
        assert expected.in_units(1e-12 * expected.size) > 100
