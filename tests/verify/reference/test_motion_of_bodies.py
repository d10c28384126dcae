"""What a velocity adds, from places along a line: forces, and the rates of matrices against their differences."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import shipped

from symgen.model.load import load_model
from symgen.verify.reference.arithmetic.linear import norm
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference, State

ELEMENTS = Path(__file__).resolve().parents[2] / "mechanisms"


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


STEP = Fraction(1, 2**200)
CHANGED = ["delta", "rolling_disc", "rear_car", "floating_body", "elements", "rapkm_2rrr_rr"]


@pytest.mark.parametrize("name", CHANGED)
def test_rates_of_matrices_are_their_differences(name: str) -> None:
    """C by (3) from central differences of G, B_dot and M_dot from those of B and M: to 100 digits."""
    path = ELEMENTS / f"{name}.yaml"
    model = load_model(path) if path.exists() else shipped.model(name)
    reference = Reference(model)
    source = random.Random(name)

    def draw(count: int) -> tuple[Fraction, ...]:
        return tuple(Fraction(source.uniform(-1, 1)) for _ in range(count))

    with precision(1000):
        parameters = tuple(float(x) for x in default_parameters(model))
        q, rate = draw(model.n), draw(model.n)

        def at(place: Sequence[Fraction]) -> Evaluation:
            return reference.evaluation(State(tuple(place), rate, rate, (0,) * model.m, parameters))

        def difference(along: Sequence[Fraction], matrix: Callable[[Evaluation], Any]) -> Any:
            ahead, behind = ([x + side * STEP * a for x, a in zip(q, along, strict=True)] for side in (1, -1))
            return (matrix(at(ahead)) - matrix(at(behind))) / ball(2 * STEP)

        here, n = at(q), model.n
        gradient = [difference([Fraction(i == k) for i in range(n)], lambda e: e.at.mass) for k in range(n)]
        for i in range(n):
            for j in range(n):
                c = sum(
                    (gradient[k][i, j] + gradient[j][i, k] - gradient[i][j, k]) * ball(rate[k]) / 2 for k in range(n)
                )
                assert abs(float(here.coriolis(here.rate)[i, j] - c)) <= 1e-100
        assert norm(here.mass_dot(here.rate) - difference(rate, lambda e: e.at.mass)) <= 1e-100
        assert norm(here.constraints_dot(here.rate) - difference(rate, lambda e: e.at.constraints)) <= 1e-100
        assert norm(here.control_dot(here.rate) - difference(rate, lambda e: e.at.control)) <= 1e-100


def test_an_energy_written_with_velocities_of_points_takes_the_matrices(tmp_path: Path) -> None:
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
