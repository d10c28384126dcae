"""Wheels that lean: the rows of their contact down to where they lie flat, and whatever frame carries them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from shipped import ROOT

from symgen.mechanics.system import System
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

DISC = (ROOT / "models" / "rolling_disc.yaml").read_text(encoding="utf-8")
TURNS = "rotation: [[z, psi], [x, beta]]}\n  disc: {parent: fork, rotation: [[y, phi]]}"


def rows(text: str, lean: float, heading: float = 0.7) -> np.ndarray:
    """B at some spin."""
    model = load_text(text, "disc.yaml")
    B = System(model).constraint_jacobian
    values = default_values(model.parameters) | {"x": 0.1, "y": 0.2, "z": 0.3, "psi": heading, "beta": lean, "phi": 2.1}
    return np.array(Evaluator([entry for row in B for entry in row])(values)).reshape(3, 6)


@pytest.mark.parametrize("lean", [0.2, -1.4, 2.0, math.pi / 2 - 1e-9])
def test_rows_keep_their_digits_until_the_wheel_lies_flat(lean: float) -> None:
    """The contact moves along the heading as the wheel turns, and across it as it leans."""
    R, psi, side = 0.4, 0.7, math.copysign(1, math.cos(lean))
    along, across = np.array([math.cos(psi), math.sin(psi)]), np.array([-math.sin(psi), math.cos(psi)])
    height, *slip = rows(DISC, lean)
    assert height == pytest.approx(np.array([0, 0, 1, 0, side * R * math.sin(lean), 0]), rel=1e-14)
    expected = np.column_stack(
        [
            np.eye(2),
            np.zeros(2),
            -side * R * math.sin(lean) * along,
            side * R * math.cos(lean) * across,
            -side * R * along,
        ]
    )
    assert np.array(slip) == pytest.approx(expected, rel=1e-13, abs=1e-16)


def test_the_spin_may_hide_in_the_wheels_own_frame() -> None:
    """Lean and spin in one frame: no other frame sees the axle at rest."""
    assert TURNS in DISC
    other = DISC.replace(TURNS, "rotation: [[z, psi]]}\n  disc: {parent: fork, rotation: [[x, beta], [y, phi]]}")
    assert rows(other, 0.4) == pytest.approx(rows(DISC, 0.4), rel=1e-13, abs=1e-15)


@pytest.mark.mechanisms
def test_a_disc_stays_upright_above_the_published_speed() -> None:
    """A thin homogeneous disc rolls straight on in a stable way for spins beyond sqrt(g/(3 R)): there the growth of a
    small lean changes its sign (Neimark and Fufaev, Dynamics of Nonholonomic Systems, 1972)."""
    model = load_text(DISC, "disc.yaml")
    (quantity,) = derive_quantities(model, ["forward_dynamics"]).quantities
    evaluator, parameters = Evaluator(quantity.outputs), default_values(model.parameters)
    small = 1e-5

    def lean_and_turn(spin: float, beta: float = 0, beta_dot: float = 0, psi_dot: float = 0) -> np.ndarray:
        """The accelerations of lean and heading of the disc that rolls freely."""
        turning = np.array([psi_dot, beta_dot, spin])
        z_dot, x_dot, y_dot = -rows(DISC, beta, heading=0)[:, 3:] @ turning
        values = {"x": 0, "y": 0, "z": 0.4 * math.cos(beta), "psi": 0, "beta": beta, "phi": 0}
        values |= {"x_dot": x_dot, "y_dot": y_dot, "z_dot": z_dot, "psi_dot": psi_dot, "beta_dot": beta_dot}
        values |= {"phi_dot": spin, "drive": 0, "steer": 0, "tilt": 0}
        return np.array(evaluator(parameters | values))[[4, 3]]

    def growth(spin: float) -> float:
        """The square of the exponent with which a lean grows."""
        by_lean = (lean_and_turn(spin, beta=small) - lean_and_turn(spin, beta=-small))[0] / (2 * small)
        by_turn = (lean_and_turn(spin, psi_dot=small) - lean_and_turn(spin, psi_dot=-small))[0] / (2 * small)
        turned = (lean_and_turn(spin, beta_dot=small) - lean_and_turn(spin, beta_dot=-small))[1] / (2 * small)
        return float(by_lean + by_turn * turned)

    critical = math.sqrt(9.81 / (3 * 0.4))
    assert abs(growth(critical)) < 1e-6 * abs(growth(0))
    assert growth(0.9 * critical) > 0 > growth(1.1 * critical)


LEVEL = """
model: carriage
gravity: [0, 0, -9.81]
definitions: {high: 0.5 + h}
coordinates: {s: {}, h: {}, spin: {}}
frames:
  box: {translation: [s, 0, PLACE]}
  wheel: {parent: box, translation: [0.3, 0, -0.25], rotation: [[y, spin]]}
bodies: {box: {mass: 4}, wheel: {mass: 1, inertia: {yy: 0.02}}}
rolling: {ground: {frame: wheel, radius: 0.25}}
KINETIC
"""


@pytest.mark.parametrize(("place", "names"), [("high", ["along", "height"]), ("0.5", ["along"])])
def test_a_level_wheel_that_could_lift_is_held_on_the_ground(place: str, names: list[str]) -> None:
    other = "" if place == "high" else "kinetic_energy: h_dot**2"
    model = load_text(LEVEL.replace("PLACE", place).replace("KINETIC", other), "carriage.yaml")
    assert sorted(row.name for row in model.constraints) == [f"ground_{name}" for name in names]
