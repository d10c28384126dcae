"""Systems that fall freely bear no weights: lambda is exactly 0 at rest, and what it was beside."""

from __future__ import annotations

import random

import pytest

from symgen.mechanics.free_fall import falls_freely
from symgen.methods import workspace
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

# A four-bar linkage on a plate that slides and turns in a plane, or on a body that flies.
LINKAGE = """\
model: linkage
parameters:
  g: {value: 9.81}
  m: {value: 1.7}
gravity: GRAVITY
joints:
  base: BASE
  crank: {type: revolute, parent: base, at: [0.3, 0.1, 0], axis: z, coordinate: a}
  coupler: {type: revolute, parent: crank, at: [0.2, 0, 0], axis: z, coordinate: b}
  rocker: {type: revolute, parent: base, at: [-0.2, 0, 0], axis: z, coordinate: c}
bodies:
  base: {mass: m, com: [0.05, 0.02, 0], inertia: {xx: 0.03, yy: 0.04, zz: 0.05}}
  crank: {mass: 0.5, com: [0.1, 0, 0], inertia: {xx: 0.001, yy: 0.003, zz: 0.004}}
  coupler: {mass: 0.7, com: [0.2, 0, 0], inertia: {xx: 0.001, yy: 0.003, zz: 0.004}}
  rocker: {mass: 0.4, com: [0.15, 0, 0], inertia: {xx: 0.001, yy: 0.003, zz: 0.004}}
points:
  here: {frame: coupler, at: [0.5, 0, 0]}
  there: {frame: rocker, at: [0.35, 0, 0]}
  far: {at: [2, 3, 0]}
FURTHER
inputs: {u: {joint: a}}
outputs: [multipliers]
"""
ROWS = """\
constraints:
  geometric:
    along: here.x - there.x
    across: here.y - there.y"""
PLATE = "{type: planar, coordinates: [x, y, p]}"


def linkage(base: str = PLATE, gravity: str = "[0, -g, 0]", further: str = ROWS) -> str:
    return LINKAGE.replace("BASE", base).replace("GRAVITY", gravity).replace("FURTHER", further)


def falls(text: str) -> bool:
    falls_freely.cache_clear()
    return falls_freely(load_text(text, "linkage.yaml"))


@pytest.mark.parametrize("gravity", ["[0, -g, 0]", "[g/2, 9.81, 0]", "[0, -g, 3]"])
def test_a_plate_that_slides_falls(gravity: str) -> None:
    assert falls(linkage(gravity=gravity))


@pytest.mark.parametrize("turned", ["", "rotation: [[z, pi/2]], "])
def test_a_body_that_flies_falls(turned: str) -> None:
    base = f"{{type: floating, {turned}coordinates: [x, y, z, e0, e1, e2, e3]}}"
    assert falls(linkage(base, "[0, 0, -g]"))


def test_forces_beside_weights_change_nothing() -> None:
    spring = ROWS + "\nsprings: {rope: {between: [here, far], stiffness: 20, length: 0.5}}"
    assert falls(linkage(further=spring))


def test_what_a_row_holds_does_not_fall() -> None:
    assert not falls(linkage(further=ROWS + "\n    held: base.y - 0.2"))


def test_what_hangs_on_the_ground_does_not_fall() -> None:
    assert not falls(linkage("{type: revolute, axis: z, coordinate: p}"))
    assert not falls(linkage("{type: prismatic, axis: x, coordinate: x}"))


def test_something_that_hangs_on_the_ground_beside_does_not_let_the_rest_fall_alike() -> None:
    weight = "\n  weight: {type: revolute, axis: z, coordinate: w}\nbodies:\n  weight: {mass: 2, com: [0.3, 0, 0]}"
    assert not falls(linkage().replace("\nbodies:", weight))


def accelerated(text: str) -> Evaluator:
    falls_freely.cache_clear()
    (derived,) = derive_quantities(load_text(text, "linkage.yaml"), ("multipliers",)).quantities
    return Evaluator(list(derived.outputs))


def test_rows_bear_nothing_at_rest_and_else_what_they_did(monkeypatch: pytest.MonkeyPatch) -> None:
    falling = accelerated(linkage())
    monkeypatch.setattr(workspace, "falls_freely", lambda _: False)
    plain = accelerated(linkage())
    names = ["x", "y", "p", "a", "b", "c"]
    for seed in range(10):
        dice = random.Random(seed)
        point = {name: dice.uniform(-1.0, 1.0) for name in (*names, *(f"{name}_dot" for name in names), "u")}
        point |= {"g": 9.81, "m": 1.7}
        assert falling(point) == pytest.approx(plain(point), rel=1e-9)
        still = point | {f"{name}_dot": 0.0 for name in names} | {"u": 0.0}
        assert list(falling(still)) == [0.0, 0.0]
        assert any(plain(still)), "a rounding of weights"
