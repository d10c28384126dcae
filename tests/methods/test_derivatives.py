"""Derivatives of u and of accelerations, and the changes that constraints allow: against formulas by hand and laws."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shipped
from numpy.typing import NDArray

from symgen.backends.operations import count_operations
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.system import System
from symgen.methods.derivatives.differentiated import FUNCTIONS
from symgen.methods.method import Candidate
from symgen.methods.selection import Methods
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.model.quantities import ROWS
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.traverse import ANGLE_WEIGHT, QUOTIENT_WEIGHT, reached
from symgen.verify.reference.reference import Reference, State

Array = NDArray[np.float64]
GRADIENTS = ("inverse_dynamics_gradient", "forward_dynamics_gradient", "inverse_dynamics_hessian_product")
ALL = ("inverse_dynamics_jacobian", "forward_dynamics_jacobian", "constraint_variations")
# A cart with a pendulum, driven at the cart, damped.
PENDULUM = """
model: pendulum
derivatives: FLAG
coordinates: {x: {unit: m}, a: {unit: rad}}
parameters: {M: {value: 2}, m: {value: 0.5}, l: {value: 0.7}, g: {value: 9.81}, d: {value: 0.3}}
kinetic_energy: (M + m)*x_dot**2/2 + m*l*cos(a)*x_dot*a_dot + m*l**2*a_dot**2/2
potential_energy: m*g*l*cos(a)
applied_forces: {x: -d*x_dot}
inputs: {push: {acts_on: {x: 1}}, twist: {acts_on: {a: 1}}}
outputs: OUTPUTS
"""
# Two of three parallel cranks are held to the third, one of them twice.
CRANKS = """
model: cranks
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
parameters: {J: {value: 1}}
kinetic_energy: J*(a_dot**2 + b_dot**2 + c_dot**2)/2
constraints: {geometric: {one: a - b, two: b - c, three: a - c}}
inputs: {drive: {acts_on: {a: 1}}}
outputs: [inverse_dynamics_jacobian, forward_dynamics_jacobian, constraint_variations, inverse_dynamics]
"""
# Two inputs that meet on the constraint alone: beside it they span two directions.
MEETING = """
model: meeting
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: (x_dot**2 + y_dot**2 + z_dot**2)/2
constraints: {geometric: {flat: z}}
inputs: {one: {acts_on: {x: 1}}, two: {acts_on: {x: 1, y: z}}}
outputs: [inverse_dynamics, inverse_dynamics_jacobian]
"""


def loaded(folder: Path, text: str) -> Model:
    path = folder / "model.yaml"
    path.write_text(text, encoding="utf-8")
    return load_model(path)


def values(selection: Selection, point: Mapping[str, float]) -> dict[str, Array]:
    """The quantities at a point, by name."""
    given = parameter_values(selection.mechanics) | dict(point)
    return {
        derived.name: np.array(Evaluator(derived.outputs)(given)).reshape(derived.shape)
        for derived in selection.quantities
    }


def test_a_pendulum_on_a_cart_by_hand(tmp_path: Path) -> None:
    model = loaded(tmp_path, PENDULUM.replace("OUTPUTS", f"[{', '.join(ALL[:2])}]").replace("FLAG", "false"))
    a, a_dot, x_ddot, a_ddot = 0.4, -1.3, 0.8, 2.1
    point = {"x": 0.2, "a": a, "x_dot": 0.5, "a_dot": a_dot, "x_ddot": x_ddot, "a_ddot": a_ddot, "push": 3, "twist": -1}
    by_quantity = values(derive_quantities(model, model.outputs), point)
    total, ml, mll, g, s, c = 2.5, 0.35, 0.245, 9.81, math.sin(a), math.cos(a)
    by_hand = [
        [0, -ml * (s * a_ddot + c * a_dot**2), 0.3, -2 * ml * s * a_dot, total, ml * c],
        [0, -ml * (s * x_ddot + g * c), 0, 0, ml * c, mll],
    ]
    assert by_quantity["inverse_dynamics_jacobian"] == pytest.approx(np.array(by_hand), rel=1e-13)
    inverse = np.linalg.inv([[total, ml * c], [ml * c, mll]])
    by_u = by_quantity["forward_dynamics_jacobian"][:, 4:]
    assert by_u == pytest.approx(inverse, rel=1e-12)
    drift = np.array([3 + ml * s * a_dot**2 - 0.3 * 0.5, -1 + ml * g * s])
    turned = np.array([[0, -ml * s], [-ml * s, 0]])
    by_a = inverse @ (np.array([ml * c * a_dot**2, ml * g * c]) - turned @ inverse @ drift)
    assert by_quantity["forward_dynamics_jacobian"][:, 1] == pytest.approx(by_a, rel=1e-12)


def test_forces_of_a_pendulum_by_its_parameters_by_hand(tmp_path: Path) -> None:
    name = "inverse_dynamics_parameter_jacobian"
    model = loaded(tmp_path, PENDULUM.replace("OUTPUTS", f"[{name}]").replace("FLAG", "false"))
    a, a_dot, x_dot, x_ddot, a_ddot = 0.4, -1.3, 0.5, 0.8, 2.1
    point = {"x": 0.2, "a": a, "x_dot": x_dot, "a_dot": a_dot, "x_ddot": x_ddot, "a_ddot": a_ddot}
    m, length, g, s, c = 0.5, 0.7, 9.81, math.sin(a), math.cos(a)
    swing = c * a_ddot - s * a_dot**2
    by_hand = [
        [x_ddot, x_ddot + length * swing, m * swing, 0, x_dot],
        [
            0, length * (c * x_ddot + length * a_ddot - g * s), m * (c * x_ddot + 2 * length * a_ddot - g * s),
            -m * length * s, 0,
        ],
    ]  # fmt: skip
    assert values(derive_quantities(model, (name,)), point)[name] == pytest.approx(np.array(by_hand), rel=1e-13)


def test_reactions_of_a_bead_by_hand(tmp_path: Path) -> None:
    """On y = k x^2/2: lambda (1 + (k x)^2) = u_y - m g - m k x_dot^2 - k x u_x."""
    text = """
model: bead
coordinates: {x: {unit: m}, y: {unit: m}}
parameters: {m: {value: 1.3}, k: {value: 0.7}, g: {value: 9.81}}
kinetic_energy: m*(x_dot**2 + y_dot**2)/2
potential_energy: m*g*y
constraints: {geometric: {wire: y - k*x**2/2}}
inputs: {u_x: {acts_on: {x: 1}}, u_y: {acts_on: {y: 1}}}
outputs: [multipliers_jacobian]
"""
    x, v, f_x, f_y, m, k, g = 0.6, -0.9, 2.0, -3.0, 1.3, 0.7, 9.81
    point = {"x": x, "y": k * x**2 / 2, "x_dot": v, "y_dot": k * x * v, "u_x": f_x, "u_y": f_y}
    matrix = values(derive_quantities(loaded(tmp_path, text), ("multipliers_jacobian",)), point)["multipliers_jacobian"]
    over = 1 / (1 + (k * x) ** 2)
    force = (f_y - m * g - m * k * v**2 - k * x * f_x) * over
    by_hand = [-k * f_x * over - 2 * k**2 * x * force * over, 0, -2 * m * k * v * over, 0, -k * x * over, over]
    assert matrix == pytest.approx(np.array([by_hand]), rel=1e-12, abs=1e-14)


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["rapkm_2rrr_rr", "front_car", "rolling_disc", "delta", "double_pendulum"])
def test_gradients_are_weighted_rows_of_jacobians(name: str) -> None:
    names = ("inverse_dynamics_gradient", "inverse_dynamics_jacobian"), (
        "forward_dynamics_gradient", "forward_dynamics_jacobian",
    )  # fmt: skip
    selection = derive_quantities(shipped.model(name), tuple(one for pair in names for one in pair))
    by_name = {derived.name: derived for derived in selection.quantities}
    graph = selection.mechanics.graph
    for (gradient, jacobian), weights in zip(names, selection.mechanics.further("w_u", "w_qdd"), strict=True):
        rows, columns = by_name[jacobian].shape
        entries = by_name[jacobian].outputs
        products = [
            graph.sum(weights[i] * entries[columns * i + j] for i in range(rows)) for j in range(columns)
        ]
        with every_identity_evaluated():
            same_values(gradient, products, by_name[gradient].outputs)


def test_second_derivatives_of_a_pendulum_by_hand(tmp_path: Path) -> None:
    name = "inverse_dynamics_hessian_product"
    model = loaded(tmp_path, PENDULUM.replace("OUTPUTS", f"[{name}]").replace("FLAG", "false"))
    a, a_dot, x_ddot, a_ddot, push, twist = 0.4, -1.3, 0.8, 2.1, 0.6, -0.9
    point = {"x": 0.2, "a": a, "x_dot": 0.5, "a_dot": a_dot, "x_ddot": x_ddot, "a_ddot": a_ddot}
    point |= {"push_weight": push, "twist_weight": twist}
    v = {"x": 0.3, "a": 0.7, "x_dot": -0.2, "a_dot": 1.1, "x_ddot": -0.5, "a_ddot": 0.9}
    point |= {f"{key}_direction": value for key, value in v.items()}
    ml, g, s, c = 0.35, 9.81, math.sin(a), math.cos(a)
    # of w^T u = push (ml (c a_ddot - s a_dot^2) + ...) + twist (ml (c x_ddot - g s) + ...)
    by_a = push * ml * (-c * a_ddot + s * a_dot**2) - twist * ml * (c * x_ddot - g * s)
    by_rate, by_x, by_own = -2 * push * ml * c * a_dot, -twist * ml * s, -push * ml * s
    by_hand = [
        0, by_a * v["a"] + by_rate * v["a_dot"] + by_x * v["x_ddot"] + by_own * v["a_ddot"],
        0, by_rate * v["a"] - 2 * push * ml * s * v["a_dot"], by_x * v["a"], by_own * v["a"],
    ]  # fmt: skip
    assert values(derive_quantities(model, (name,)), point)[name] == pytest.approx(np.array(by_hand), rel=1e-13)


@pytest.mark.parametrize(
    "name", ["rapkm_2rrr_rr", "front_car", "delta", "slider_crank", "tilted_four_bar", "scara", "chain4"]
)
@pytest.mark.parametrize("quantity", sorted(FUNCTIONS))
def test_equations_and_the_steps_that_solve_them_have_the_same_derivatives(name: str, quantity: str) -> None:
    """At numbers, beside the constraints too: neither holds a rule that the other has."""
    model = shipped.model(name)
    if quantity == "multipliers_jacobian" and not model.constraints:
        return
    methods = Methods(model, genericity(System(model)))
    by_equations = methods.candidate(quantity, "implicit")
    spare = "weighted_jacobian" if quantity in GRADIENTS else "differentiated"
    by_steps = methods.candidate(quantity, spare)
    assert isinstance(by_equations, Candidate)
    assert isinstance(by_steps, Candidate)
    assert by_equations.derived.shape == by_steps.derived.shape
    dice = random.Random(f"{name} {quantity}")
    outputs = [one.derived.outputs for one in (by_equations, by_steps)]
    names = {str(node.payload) for one in outputs for node in reached(one) if node.op == "symbol"}
    values = {one: dice.uniform(0.4, 1.2) for one in sorted(names)}
    first, second = (np.array(Evaluator(one)(values)) for one in outputs)
    assert np.abs(second).max() > 0
    assert np.allclose(first, second, rtol=1e-9, atol=1e-9 * np.abs(second).max())


# The whole Jacobian of u and a gradient, in operations of u: a sine with its cosine counts 30, a division or root 6.
GOALS = {"front_car": 1.4, "delta": 2.3, "rapkm_2rrr_rr": 2.5, "arm7": 5.5, "gough_stewart": 6.0}
GOAL_OF_GRADIENTS = 2.2


@pytest.mark.parametrize("name", shipped.sparing(GOALS, ("rapkm_2rrr_rr", "arm7", "gough_stewart")))
def test_derivatives_count_no_more_than_their_goals(name: str) -> None:
    u, swept, whole = (
        weighted_count(shipped.model(name), quantity)
        for quantity in ("inverse_dynamics", "inverse_dynamics_gradient", "inverse_dynamics_jacobian")
    )
    assert u < whole <= GOALS[name] * u
    assert u < swept <= GOAL_OF_GRADIENTS * u


def weighted_count(model: Model, quantity: str) -> int:
    """What the kernel of a quantity takes, derived by itself."""
    selection = derive_quantities(model, (quantity,))
    (kernel,) = schedule(selection.mechanics, selection.quantities, ("float64",))["float64"].kernels
    counts = count_operations(kernel.statements)
    return counts.add + counts.mul + QUOTIENT_WEIGHT * (counts.div + counts.sqrt) + ANGLE_WEIGHT * counts.sincos


@pytest.mark.campaign
def test_what_stands_still_is_not_in_the_derivatives() -> None:
    """Symbols that were held or loaded while equations were differentiated have values in the end."""
    model = shipped.model("rapkm_2rrr_rr")
    methods = Methods(model, genericity(System(model)))
    for quantity in FUNCTIONS:
        one = methods.candidate(quantity, "implicit")
        assert isinstance(one, Candidate)
        names = {str(node.payload) for node in reached(one.derived.outputs) if node.op == "symbol"}
        assert not {name for name in names if " " in name}


def test_several_internal_forces_are_left_to_the_steps() -> None:
    model = shipped.model("rapkm_2rrr_rr")
    fourth = replace(model.inputs[0], name="fourth")
    wider = replace(model, inputs=(*model.inputs, fourth))
    answer = Methods(wider, genericity(System(wider))).candidate("inverse_dynamics_jacobian", "implicit")
    assert answer == "several inputs are redundant"


@pytest.mark.parametrize("quantity", GRADIENTS)
def test_the_product_with_the_jacobian_is_the_same_gradient(quantity: str) -> None:
    """The method that verification takes where a sweep loses digits, at numbers, and it is nobody's first choice."""
    model = shipped.model("front_car")
    selection = derive_quantities(model, (quantity,))
    (swept,) = selection.quantities
    other = Methods(model, selection.generic).candidate(quantity, "weighted_jacobian")
    assert isinstance(other, Candidate)
    assert "weighted_jacobian" not in {choice.title for choice in selection.choices}
    dice = random.Random(quantity)
    names = {str(n.payload) for one in (swept, other.derived) for n in reached(one.outputs) if n.op == "symbol"}
    values = {name: dice.uniform(0.4, 1.2) for name in sorted(names)}
    first, second = (np.array(Evaluator(one.outputs)(values)) for one in (swept, other.derived))
    assert len(first) == len(second) > 0
    assert np.allclose(first, second, rtol=1e-9, atol=1e-9 * np.abs(first).max())


def test_names_of_weights_are_free(tmp_path: Path) -> None:
    text = PENDULUM.replace("OUTPUTS", "[inverse_dynamics_gradient]").replace("FLAG", "false")
    model = loaded(tmp_path, text.replace("d: {value", "push_weight: {value").replace("-d*x_dot", "-push_weight*x_dot"))
    assert model.further_names("w_u") == ("push_weight_", "twist_weight")
    assert model.further_names("w_qdd") == ("x_ddot_weight", "a_ddot_weight")
    assert model.further_names("v_x")[1:3] == ("a_direction", "x_dot_direction")


@pytest.mark.parametrize("flag", ["true", "false"])
def test_all_takes_derivatives_where_the_model_says_so(flag: str, tmp_path: Path) -> None:
    model = loaded(tmp_path, PENDULUM.replace("OUTPUTS", "all").replace("FLAG", flag))
    made = {derived.name for derived in derive_quantities(model, model.outputs).quantities}
    # of a system without constraints
    absent = {"constraint_variations", "multipliers_jacobian"}
    derivatives = {row.name for row in ROWS.values() if row.is_derivative}
    assert made & derivatives == (derivatives - absent if flag == "true" else set())


def test_what_is_not_differentiable_beside_the_constraints_is_told(tmp_path: Path) -> None:
    selection = derive_quantities(loaded(tmp_path, CRANKS), ("inverse_dynamics", *ALL))
    assert [derived.name for derived in selection.quantities] == ["inverse_dynamics"]
    assert dict(selection.absent).keys() == set(ALL)
    assert all("depend on each other" in why for _, why in selection.absent)
    absent = derive_quantities(loaded(tmp_path, MEETING), ("inverse_dynamics", ALL[0])).absent
    assert [name for name, why in absent if "reach less" in why] == [ALL[0]]


@pytest.mark.parametrize("name", ["rapkm_2rrr_rr", "front_car", "skate", "rolling_disc", "five_bar"])
def test_changes_that_constraints_allow_keep_them(name: str) -> None:
    """They are what is left by a projection, and constraints do not change along them to first order."""
    model = shipped.model(name)
    asked = ("constraint_variations", "constraint_jacobian", "constraint_jacobian_dot", "constraint_residual")
    selection = derive_quantities(model, asked)
    source = random.Random(name)
    n, mechanics = model.n, System(model)
    names = [str(node.payload) for node in mechanics.motion]
    ranges = {c.name: c.range for c in model.coordinates if c.range is not None}
    place = {key: source.uniform(*map(float, ranges[key])) if key in ranges else source.uniform(-1, 1) for key in names}
    at = values(selection, place)
    variations = at["constraint_variations"]
    scale = np.linalg.norm(variations)
    assert np.linalg.norm(variations @ variations - variations) < 1e-12 * scale**2

    def held(step: Array) -> Array:
        moved = {key: place[key] + float(d) for key, d in zip(names, step, strict=True)}
        by_quantity = values(selection, moved)
        qd, qdd = (np.array([moved[key] for key in names[k * n : (k + 1) * n]]) for k in (1, 2))
        rows, rates = by_quantity["constraint_jacobian"], by_quantity["constraint_jacobian_dot"]
        return np.concatenate([by_quantity.get("constraint_residual", np.zeros(0)), rows @ qd, rows @ qdd + rates @ qd])

    for _ in range(3):
        change = variations @ np.array([source.uniform(-1, 1) for _ in names])
        change /= np.linalg.norm(change)
        before, after = (held(sign * 1e-5 * change) for sign in (-1, 1))
        arbitrary = held(1e-5 * np.ones(3 * n) / math.sqrt(3 * n)) - held(np.zeros(3 * n))
        # of second order, where an arbitrary change is of first
        assert np.linalg.norm(after - before) < 1e-3 * np.linalg.norm(arbitrary)


@pytest.mark.campaign
@pytest.mark.parametrize("exponent", [2, 5, 8])
def test_derivatives_keep_their_digits_where_coordinates_fail(exponent: int) -> None:
    """The links of an arm all but in line: derivatives of minimal coordinates lose eps/d^3 there, these no digit."""
    model = shipped.model("rapkm_2rrr_rr")
    selection = derive_quantities(model, (ALL[0],))
    reference = Reference(model)
    parameters = parameter_values(System(model))
    for arm in (1, 2, 3):
        point = {str(node.payload): math.sin(1.7 * k + 0.3) for k, node in enumerate(selection.mechanics.motion)}
        point[f"b_{arm}"] = 10.0**-exponent
        jacobian = values(selection, point)[ALL[0]]
        q, qd, qdd = np.array(list(point.values())).reshape(3, -1).tolist()
        given = tuple(parameters[parameter.name] for parameter in model.parameters)
        state = State(tuple(q), tuple(qd), tuple(qdd), (0.0,) * model.m, given)
        exact = np.array([float(x.mid()) for x in reference.evaluate(state, (ALL[0],))[ALL[0]]])
        assert np.linalg.norm(jacobian.ravel() - exact) < 1e-14 * np.linalg.norm(exact)
