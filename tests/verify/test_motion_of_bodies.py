"""C v and B_dot v from places along a line agree with Christoffel's matrix and the gradient of B to 60 digits."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
import shipped

from symgen.model.load import load_model
from symgen.verify.reference.linear import norm
from symgen.verify.reference.reference import Reference, State
from symgen.verify.reference.system import default_parameters
from symgen.verify.reference.tape import precision

ELEMENTS = Path(__file__).resolve().parents[1] / "mechanisms"


@pytest.mark.parametrize("name", ["delta", "rolling_disc", "gough_stewart", "rear_car", "floating_body", "elements"])
def test_both_ways_agree(name: str) -> None:
    path = ELEMENTS / f"{name}.yaml"
    model = load_model(path) if path.exists() else shipped.model(name)
    reference = Reference(model)
    source = random.Random(name)

    def draw(count: int) -> tuple[float, ...]:
        return tuple(source.uniform(-1, 1) for _ in range(count))

    with precision(256):
        parameters = tuple(float(x) for x in default_parameters(model))
        at = reference.evaluation(State(draw(model.n), draw(model.n), draw(model.n), draw(model.m), parameters))
        force, bias = at.motion(at.rate)
        assert reference.system.motion is not None
        expected = at.coriolis(at.rate) * at.rate
        assert norm(force - expected) <= 1e-60 * (1 + norm(expected))
        assert norm(bias - at.constraints_dot(at.rate) * at.rate) <= 1e-60




def test_an_energy_written_with_velocities_of_points_takes_the_gradients(tmp_path: Path) -> None:
    path = tmp_path / "pendulum.yaml"
    path.write_text(
        """model: pendulum
coordinates:
  a: {unit: rad, range: [-1.5, 1.5]}
parameters:
  l: {value: 0.4, unit: m}
  m: {value: 1.5, unit: kg}
frames:
  arm: {rotation: [[z, a]]}
points:
  tip: {frame: arm, at: [l, 0, 0]}
kinetic_energy: m*(tip.vx**2 + tip.vy**2)/2
inputs:
  u: {unit: N*m, joint: a}
""",
        encoding="utf-8",
    )
    reference = Reference(load_model(path))
    assert reference.system.motion is None
    (mass,) = reference.evaluate(State((0.3,), (1,), (0,), (0,), (0.4, 1.5)), ["mass_matrix"])["mass_matrix"]
    assert float(mass) == pytest.approx(1.5 * 0.4**2)
    (force,) = reference.evaluate(State((0.3,), (1,), (0,), (0,), (0.4, 1.5)), ["coriolis_force"])["coriolis_force"]
    assert abs(float(force)) < 1e-60
