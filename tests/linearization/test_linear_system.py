"""A mechanism at rest as a linear system: against formulas by hand, and gains that hold the machine itself."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import shipped
from linkages import CART
from scipy.integrate import solve_ivp

from symgen.cli.main import main
from symgen.generation.results import WrongUseError
from symgen.linearization.linear_system import LinearSystem, NotLinearizedError, linearized
from symgen.linearization.regulator import regulator
from symgen.linearization.text import linear_system_text
from symgen.mechanics.genericity import parameter_values
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

# The same pendulum by the place of its bob, hanging.
BOB = """
model: bob
coordinates: {x: {unit: m, range: [-1, 1]}, y: {unit: m, range: [-1, 1]}}
parameters: {m: {value: 0.5}, l: {value: 0.7}, g: {value: 9.81}}
kinetic_energy: m*(x_dot**2 + y_dot**2)/2
potential_energy: m*g*y
constraints: {geometric: {rod: x**2 + y**2 - l**2}}
configuration: {x: 0, y: -0.69}
outputs: [forward_dynamics]
"""


def loaded(folder: Path, text: str) -> Model:
    path = folder / "model.yaml"
    path.write_text(text, encoding="utf-8")
    return load_model(path)


def test_a_cart_by_hand(tmp_path: Path) -> None:
    system = linearized(loaded(tmp_path, CART), {})
    of_a = 9.81 * 0.5 / 2, 9.81 * 2.5 / (2 * 0.7)
    expected = [[0, 0, 1, 0], [0, 0, 0, 1], [0, -of_a[0], 0, 0], [0, of_a[1], 0, 0]]
    assert system.a == pytest.approx(np.array(expected), rel=1e-14)
    assert system.b.ravel() == pytest.approx([0, 0, 1 / 2, -1 / (2 * 0.7)], rel=1e-14)
    assert system.poles.real == pytest.approx([math.sqrt(of_a[1]), 0, 0, -math.sqrt(of_a[1])], abs=1e-7)
    assert len(system.unreached) == 0


def test_gains_hold_the_machine_itself(tmp_path: Path) -> None:
    model = loaded(tmp_path, CART)
    held = regulator(linearized(model, {}), 1, 0.1)
    assert held.poles.real.max() < -0.5
    selection = derive_quantities(model, ("forward_dynamics",))
    evaluate, given = Evaluator(selection.quantities[0].outputs), parameter_values(selection.mechanics)

    def rate(_: float, state: np.ndarray) -> list[float]:
        push = -(held.of_places @ state[:2] + held.of_rates @ state[2:]).item()
        names = ("x", "a", "x_dot", "a_dot")
        return [*state[2:], *evaluate({**given, **dict(zip(names, state.tolist(), strict=True)), "push": push})]

    for begun in ([0.5, 0.3, 0, 0], [0, -0.4, 0, 0.2]):
        run = solve_ivp(rate, (0, 12), begun, rtol=1e-8, atol=1e-10)
        assert abs(run.y[:, -1]).max() < 1e-3
    falling = solve_ivp(lambda t, s: rate(t, s) if t < 0 else [*s[2:], 0, 17.5 * s[1]], (0, 2), [0, 0.01, 0, 0])
    assert abs(falling.y[1, -1]) > 1  # what it does without


def test_poles_do_not_depend_on_coordinates(tmp_path: Path) -> None:
    """The bob of a pendulum, by its place in the plane and a rod, swings as it does by its angle."""
    system = linearized(loaded(tmp_path, BOB), {})
    assert system.q == pytest.approx([0, -0.7], abs=1e-15)
    assert system.a.shape == (2, 2)
    assert abs(system.poles.imag) == pytest.approx([math.sqrt(9.81 / 0.7)] * 2, rel=1e-12)


def test_a_robot_with_loops_is_held_by_its_drives() -> None:
    model = shipped.model("delta")
    system = linearized(model, {})
    assert (system.a.shape, system.b.shape) == ((6, 6), (6, 3))
    assert system.of_places.T @ system.of_places == pytest.approx(np.eye(3), abs=1e-14)
    held = regulator(system, 10, 1)
    assert held.poles.real.max() < 0
    assert held.of_places.shape == (3, model.n)


def test_what_is_no_linear_system_is_told(tmp_path: Path) -> None:
    cart, bob = loaded(tmp_path, CART), BOB
    with pytest.raises(NotLinearizedError, match=r"no equilibrium.* a accelerates by"):
        linearized(cart, {"a": 1.0})
    with pytest.raises(WrongUseError, match="unknown name 'aa'; did you mean"):
        linearized(cart, {"aa": 1.0})
    twice = bob.replace("rod: x**2 + y**2 - l**2}", "rod: x**2 + y**2 - l**2, again: 2*x**2 + 2*y**2 - 2*l**2}")
    with pytest.raises(NotLinearizedError, match="depend on each other"):
        linearized(loaded(tmp_path, twice), {})
    with pytest.raises(NotLinearizedError, match="no inputs"):
        regulator(linearized(loaded(tmp_path, bob), {}), 1, 1)
    parked = linearized(shipped.model("front_car"), {})
    assert len(parked.unreached) > 0
    with pytest.raises(NotLinearizedError, match="do not reach"):
        regulator(parked, 1, 1)


@pytest.mark.parametrize("name", ["delta", "rapkm_2rrr_rr", "arm7", "front_car"])
def test_its_lines_fit_a_terminal(name: str) -> None:
    system: LinearSystem = linearized(shipped.model(name), {})
    text = linear_system_text(system, None if len(system.unreached) else regulator(system, 1, 1))
    # a direction of many coordinates is one word
    assert max(len(line) for line in text.splitlines() if "(" not in line and "  " in line) <= 80


def test_the_command_prints_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cart.yaml"
    path.write_text(CART, encoding="utf-8")
    assert main(["explain", str(path), "linearization", "--lqr", "1,0.1"]) == 0
    printed = capsys.readouterr().out
    assert "  poles         4.185, 0, 0, -4.185\n  the inputs reach all of them" in printed
    assert "  K push        -3.162 x, -78.14 a\n" in printed
    assert main(["explain", str(path), "linearization", "--start", "a=1"]) == 1
    assert "no equilibrium" in capsys.readouterr().err
