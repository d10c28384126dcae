"""Paths solved from constraints and conditions: exact on the manifold, clear about those nobody can follow."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shipped

from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.paths.path_equations import PathError, path_equations
from symgen.paths.trajectory import Trajectory, solve_path

MODELS = Path(__file__).parents[2] / "models"
WITH_PATHS = [name for name in shipped.ALL if "\npaths:" in (MODELS / f"{name}.yaml").read_text(encoding="utf-8")]

SLIDER = """
model: slider
coordinates: {a: {}, s: {}, h: {}}
parameters: {l: 0.5}
kinetic_energy: a_dot**2 + s_dot**2 + h_dot**2
constraints:
  geometric: {x: s - l*cos(a), y: h - l*sin(a)}
inputs: {f: {acts_on: {s: 1}}}
paths:
  go:
    duration: 2
    samples: 21
"""

SKATE = """
model: skate
coordinates: {phi: {}, x: {}, y: {}}
kinetic_energy: phi_dot**2 + x_dot**2 + y_dot**2
constraints:
  nonholonomic: {edge: sin(phi)*x_dot - cos(phi)*y_dot}
inputs: {f: {acts_on: {phi: 1}}}
paths:
  glide:
    duration: 1
    samples: 11
"""


def solved(text: str, conditions: str, start: str = "{}") -> tuple[Model, Trajectory]:
    model = load_text(f"{text}    conditions: {conditions}\n    start: {start}\n", "model.yaml")
    return model, solve_path(model, model.paths[0])


@pytest.mark.parametrize("name", WITH_PATHS)
def test_samples_satisfy_constraints_and_conditions(name: str) -> None:
    model = shipped.model(name)
    for path in model.paths:
        trajectory, equations = solve_path(model, path), path_equations(model, path)
        assert trajectory.q.shape == trajectory.qd.shape == trajectory.qdd.shape == (path.samples, model.n)
        assert (trajectory.t[0], trajectory.t[-1]) == (0.0, float(path.duration))
        for t, q in zip(trajectory.t, trajectory.q, strict=True):
            residual, _ = equations.position(q, float(t))
            assert np.max(np.abs(residual)) < 1e-12


@pytest.mark.parametrize("name", WITH_PATHS)
def test_rates_are_the_derivatives_of_the_samples(name: str) -> None:
    """Cubic Hermite pieces from q and q̇ meet q of the next sample to fourth order; the same for q̇ and q̈."""
    model = shipped.model(name)
    trajectory = solve_path(model, model.paths[0])
    h = np.diff(trajectory.t)[:, None]
    for value, rate in ((trajectory.q, trajectory.qd), (trajectory.qd, trajectory.qdd)):
        simpson = 2 * h[1:] / 6 * (rate[:-2] + 4 * rate[1:-1] + rate[2:])
        scale = float(np.max(np.abs(rate))) * float(h[0, 0])
        assert np.max(np.abs(value[2:] - value[:-2] - simpson)) < 2e-3 * scale


def test_a_known_motion_is_found_exactly() -> None:
    _, trajectory = solved(SLIDER, "{turn: a - t**2}")
    t = trajectory.t
    expected = np.stack([t**2, 0.5 * np.cos(t**2), 0.5 * np.sin(t**2)], axis=1)
    assert trajectory.q == pytest.approx(expected, abs=1e-13)
    assert trajectory.qd[:, 2] == pytest.approx(t * np.cos(t**2), abs=1e-12)
    assert trajectory.qdd[:, 2] == pytest.approx(np.cos(t**2) - 2 * t**2 * np.sin(t**2), abs=1e-12)


def test_start_selects_the_assembly_mode() -> None:
    for sign in (1, -1):
        _, trajectory = solved(SLIDER, "{reach: s - 0.3 - t/20}", f"{{a: {sign}, s: 0.3, h: {0.4 * sign}}}")
        assert trajectory.q[:, 2] == pytest.approx(sign * np.sqrt(0.25 - trajectory.q[:, 1] ** 2), abs=1e-12)


def test_coarse_samples_stay_on_the_branch() -> None:
    """Ten turns on 21 samples: half a turn from one sample to the next."""
    _, trajectory = solved(SLIDER, "{turn: a - 10*pi*t}")
    assert trajectory.q[-1, 0] == pytest.approx(20 * np.pi, abs=1e-12)


def test_dependent_rows_are_no_obstacle() -> None:
    doubled = SLIDER.replace("y: h - l*sin(a)}", "y: h - l*sin(a), again: (s - l*cos(a))*2 + h - l*sin(a)}")
    _, trajectory = solved(doubled, "{turn: a - t}")
    assert trajectory.q[:, 1] == pytest.approx(0.5 * np.cos(trajectory.t), abs=1e-13)
    assert trajectory.qdd[:, 1] == pytest.approx(-0.5 * np.cos(trajectory.t), abs=1e-12)


def test_rows_in_other_units_are_the_same_rows() -> None:
    scaled = SLIDER.replace("s - l*cos(a)", "1e-7*(s - l*cos(a))").replace("h - l*sin(a)", "1e7*(h - l*sin(a))")
    conditions, start = "{reach: s - 0.3 - t/20}", "{a: 1, s: 0.3, h: 0.4}"
    (_, plain), (_, other) = solved(SLIDER, conditions, start), solved(scaled, conditions, start)
    assert other.q == pytest.approx(plain.q, abs=1e-12)
    assert other.qdd == pytest.approx(plain.qdd, abs=1e-11)


@pytest.mark.parametrize(
    ("conditions", "start", "message"),
    [
        ("{one: a - t, two: s - 0.5*cos(t)}", "{s: 0.5}", "path `go`: the number of conditions is 2, .* freedom is 1"),
        ("{far: s - 2}", "{s: 0.5}", "path `go`: no solution at t = 0 near `start`"),
        ("{far: s - 0.3 - t/4}", "{a: 1, s: 0.3, h: 0.4}", r"path `go`: .* t = 0\.[78]"),
        ("{jolt: a - sqrt(t)}", "{s: 0.5}", "path `go`: rates or accelerations are not finite at t = 0"),
        ("{fold: s - 0.5}", "{s: 0.5}", "path `go`: constraints and conditions do not determine the motion at t = 0"),
    ],
)
def test_paths_that_cannot_be_followed(conditions: str, start: str, message: str) -> None:
    with pytest.raises(PathError, match=message) as caught:
        solved(SLIDER, conditions, start)
    assert caught.value.mistake.span is not None


def test_nonholonomic_rows_must_be_respected() -> None:
    conditions = "{turning: phi - t, along: x - sin(t), across: y - 1 + cos(t)}"
    _, trajectory = solved(SKATE, conditions)
    assert trajectory.qd[:, 0] == pytest.approx(np.ones(11))
    with pytest.raises(
        PathError, match="path `glide`: the prescribed motion violates the non-holonomic constraint edge"
    ):
        solved(SKATE, conditions.replace("1 + cos(t)", "1 + 2*cos(t)"))


def test_too_few_conditions() -> None:
    model, _ = solved(SKATE, "{turning: phi - t, along: x - sin(t), across: y - 1 + cos(t)}")
    path = replace(model.paths[0], conditions=model.paths[0].conditions[:2])
    with pytest.raises(PathError, match=r"path `glide`: the number of conditions is 2, .* freedom is 3"):
        solve_path(model, path)
