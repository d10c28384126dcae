"""Derivatives of u and of accelerations, and the changes that constraints allow: against formulas by hand and laws."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
import shipped
from numpy.typing import NDArray

from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference, State

Array = NDArray[np.float64]
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
    found = values(derive_quantities(model, model.outputs), point)
    total, ml, mll, g, s, c = 2.5, 0.35, 0.245, 9.81, math.sin(a), math.cos(a)
    by_hand = [
        [0, -ml * (s * a_ddot + c * a_dot**2), 0.3, -2 * ml * s * a_dot, total, ml * c],
        [0, -ml * (s * x_ddot + g * c), 0, 0, ml * c, mll],
    ]
    assert found["inverse_dynamics_jacobian"] == pytest.approx(np.array(by_hand), rel=1e-13)
    inverse = np.linalg.inv([[total, ml * c], [ml * c, mll]])
    by_u = found["forward_dynamics_jacobian"][:, 4:]
    assert by_u == pytest.approx(inverse, rel=1e-12)
    drift = np.array([3 + ml * s * a_dot**2 - 0.3 * 0.5, -1 + ml * g * s])
    turned = np.array([[0, -ml * s], [-ml * s, 0]])
    by_a = inverse @ (np.array([ml * c * a_dot**2, ml * g * c]) - turned @ inverse @ drift)
    assert found["forward_dynamics_jacobian"][:, 1] == pytest.approx(by_a, rel=1e-12)


@pytest.mark.parametrize("flag", ["true", "false"])
def test_all_takes_derivatives_where_the_model_says_so(flag: str, tmp_path: Path) -> None:
    model = loaded(tmp_path, PENDULUM.replace("OUTPUTS", "all").replace("FLAG", flag))
    made = {derived.name for derived in derive_quantities(model, model.outputs).quantities}
    assert made & set(ALL) == (set(ALL[:2]) if flag == "true" else set())


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
        found = values(selection, moved)
        qd, qdd = (np.array([moved[key] for key in names[k * n : (k + 1) * n]]) for k in (1, 2))
        rows, rates = found["constraint_jacobian"], found["constraint_jacobian_dot"]
        return np.concatenate([found.get("constraint_residual", np.zeros(0)), rows @ qd, rows @ qdd + rates @ qd])

    for _ in range(3):
        change = variations @ np.array([source.uniform(-1, 1) for _ in names])
        change /= np.linalg.norm(change)
        before, after = (held(sign * 1e-5 * change) for sign in (-1, 1))
        arbitrary = held(1e-5 * np.ones(3 * n) / math.sqrt(3 * n)) - held(np.zeros(3 * n))
        # of second order, where an arbitrary change is of first
        assert np.linalg.norm(after - before) < 1e-3 * np.linalg.norm(arbitrary)


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
        found = values(selection, point)[ALL[0]]
        q, qd, qdd = np.array(list(point.values())).reshape(3, -1).tolist()
        given = tuple(parameters[parameter.name] for parameter in model.parameters)
        state = State(tuple(q), tuple(qd), tuple(qdd), (0.0,) * model.m, given)
        exact = np.array([float(x.mid()) for x in reference.evaluate(state, (ALL[0],))[ALL[0]]])
        assert np.linalg.norm(found.ravel() - exact) < 1e-14 * np.linalg.norm(exact)
