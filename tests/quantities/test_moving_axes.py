"""Results that turn with a heading are computed at heading 0: what comes in is turned back, what comes out turned."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import pytest

from symgen.methods.quantity import Quantity, scalars
from symgen.model.load import load_model
from symgen.model.quantities import MOTIONS
from symgen.quantities import moving_axes
from symgen.quantities.moving_axes import in_moving_axes
from symgen.quantities.select import Selection, derive_quantities
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import cost, reached

# A tractor with a blade on an arm that swings sideways.
TRACTOR = """
model: tractor
parameters: {m: {value: 2000}, J: {value: 900}, a: {value: 1.1}, b: {value: 1.7}, slope: {value: 0.1}}
coordinates:
  x: {unit: m}
  y: {unit: m}
  heading: {unit: rad}
  swing: {unit: rad}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2) + a*m*heading_dot*(cos(heading)*y_dot - sin(heading)*x_dot)
  + (J + m*a**2)/2*heading_dot**2 + 60*(heading_dot + swing_dot)**2
potential_energy: POTENTIAL
constraints:
  nonholonomic:
    axle: cos(heading)*y_dot - sin(heading)*x_dot
    blade: cos(heading + swing)*y_dot - sin(heading + swing)*x_dot - b*cos(swing)*heading_dot - 0.4*swing_dot
inputs:
  push: {acts_on: {x: cos(heading), y: sin(heading)}}
  ram: {acts_on: {swing: 1}}
configuration: {x: 0, y: 0, heading: 0.3, swing: 0.4}
"""
LEVEL, UPHILL = (TRACTOR.replace("POTENTIAL", potential) for potential in ("0", "9.81*m*slope*y"))


def _selection(folder: Path, text: str) -> Selection:
    path = folder / "tractor.yaml"
    path.write_text(text, encoding="utf-8")
    return derive_quantities(load_model(path), MOTIONS)


def _both(folder: Path, text: str, monkeypatch: pytest.MonkeyPatch) -> list[tuple[Quantity, Quantity]]:
    """q_ddot and lambda as they are derived, and as they are turned."""
    turned = _selection(folder, text).quantities
    monkeypatch.setattr("symgen.quantities.finish.in_moving_axes", lambda _, derived: derived)
    return list(zip(_selection(folder, text).quantities, turned, strict=True))


@pytest.mark.parametrize("text", [LEVEL, UPHILL])
def test_turned_results_are_the_same(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    dice = random.Random(4)
    for plain, turned in _both(tmp_path, text, monkeypatch):
        held = reached((*plain.outputs, *turned.outputs))
        symbols = sorted(str(node.payload) for node in held if node.op == "symbol")
        for _ in range(5):
            at = {symbol: dice.uniform(0.3, 1.5) for symbol in symbols}
            expected = Evaluator(plain.outputs)(at)
            assert Evaluator(turned.outputs)(at) == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_on_level_ground_axes_turn_with_the_heading(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, (plain, turned) = _both(tmp_path, LEVEL, monkeypatch)
    before, after = (cost(scalars(one)) for one in (plain, turned))
    assert after.additive + after.multiplications < 0.8 * (before.additive + before.multiplications)


def test_what_feels_a_slope_stays_in_axes_of_the_world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for plain, turned in _both(tmp_path, UPHILL, monkeypatch):
        assert cost(scalars(turned)).weight == cost(scalars(plain)).weight


def test_a_denominator_that_feels_the_heading_keeps_the_quantity(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("symgen.quantities.finish.in_moving_axes", lambda _, derived: derived)
    selection = _selection(tmp_path, LEVEL)
    mechanics, derived = selection.mechanics, selection.quantities[1]
    assert in_moving_axes(mechanics, derived) is not derived
    guard, *others = derived.guards
    felt = guard.denominator * (2 + mechanics.graph.trig("cos", mechanics.q[2]))
    other = replace(derived, guards=(replace(guard, denominator=felt), *others))
    assert in_moving_axes(mechanics, other) is other


def test_long_results_are_not_made_anew_for_each_heading(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[int] = []

    class Counted(moving_axes._TurnedNumbers):
        def may_turn(self, heading: moving_axes._Heading) -> bool:
            tried.append(self.size)
            return super().may_turn(heading)

    monkeypatch.setattr(moving_axes, "_TurnedNumbers", Counted)
    _selection(tmp_path, LEVEL)
    usual, most = len(tried), max(tried)
    tried.clear()
    # as often as goes into it, guards included
    monkeypatch.setattr(moving_axes, "MOST_TURNED", 3 * most)
    _selection(tmp_path, LEVEL)
    assert 0 < len(tried) < usual


def test_what_was_derived_beside_does_not_hide_what_a_turn_is_worth(tmp_path: Path) -> None:
    """Equal functions are one node: on the graph of all null spaces the turned one was replaced by what it is to
    replace."""
    path = tmp_path / "tractor.yaml"
    path.write_text(LEVEL, encoding="utf-8")
    model = load_model(path)
    selection = derive_quantities(model, MOTIONS)
    assert {choice.method for choice in selection.choices} == {"minor"}
    alone = derive_quantities(model, MOTIONS, dict.fromkeys(MOTIONS, "minor"))
    for one, other in zip(selection.quantities, alone.quantities, strict=True):
        assert cost(scalars(one)).weight <= 1.02 * cost(scalars(other)).weight


# Two arms on a level table that carry one plate: everything turns with both of their first angles.
PLATE = """
model: plate
parameters: {m: {value: 2}, J: {value: 0.1}, l: {value: 0.5}, slope: {value: 0.2}}
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}}
kinetic_energy: >-
  J*(a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2)/2
  + m*(a_dot**2 + cos(b)*a_dot*(a_dot + b_dot) + (a_dot + b_dot)**2)/2
  + m*(c_dot**2 + cos(d)*c_dot*(c_dot + d_dot) + (c_dot + d_dot)**2)/2
potential_energy: POTENTIAL
constraints:
  geometric:
    along: l*(cos(a) + cos(a + b) - cos(c) - cos(c + d)) - 0.1
    across: l*(sin(a) + sin(a + b) - sin(c) - sin(c + d))
inputs: {left: {acts_on: {a: 1}}, right: {acts_on: {c: 1}}}
configuration: {a: 1.9, b: -0.8, c: 0.8, d: 0.9}
"""
TABLE, TILTED = (PLATE.replace("POTENTIAL", potential) for potential in ("0", "m*slope*sin(a + b)"))


@pytest.mark.parametrize(("text", "pairs"), [(TABLE, 1), (TILTED, 0)])
def test_derivatives_turn_with_the_angles_of_all_legs(
    text: str, pairs: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of these is 0 in axes of its leg, which saves its sine and cosine; not where a slope is felt."""
    path = tmp_path / "plate.yaml"
    path.write_text(text, encoding="utf-8")
    model = load_model(path)

    def jacobian() -> Quantity:
        return derive_quantities(model, ("inverse_dynamics_jacobian",)).quantities[0]

    turned = jacobian()
    monkeypatch.setattr(moving_axes, "_common_headings", lambda *_: iter(()))
    plain = jacobian()
    assert _pairs(plain) - _pairs(turned) == pairs
    dice = random.Random(2)
    names = sorted({str(n.payload) for n in reached((*plain.outputs, *turned.outputs)) if n.op == "symbol"})
    for _ in range(5):
        at = {name: dice.uniform(0.3, 1.5) for name in names}
        assert Evaluator(turned.outputs)(at) == pytest.approx(Evaluator(plain.outputs)(at), rel=1e-9, abs=1e-9)


def _pairs(quantity: Quantity) -> int:
    outputs = scalars(quantity)
    return cost(share_angles(outputs[0].graph, outputs)).angles
