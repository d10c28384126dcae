"""Coordinates out of ranges that a file states: where a kernel loses digits there it has bounds, and no others."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest

from symgen.generation.acceptance.coordinate_bounds import CoordinateBounds
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.draft import Draft, draft_of
from symgen.generation.results import Options
from symgen.ir.bounded_coordinates import CoordinateBound
from symgen.ir.kernel import Kernel, Scalar, Status
from symgen.model.load import load_text
from symgen.pipeline import generate
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.margins.far_coordinates import FarCoordinates
from symgen.verify.margins.lost_digits import LostDigits
from symgen.verify.reference.reference import State
from symgen.verify.sampling.outside import OutsideStates
from symgen.verify.sampling.states import in_scalar
from symgen.verify.tolerance import FACTOR, expectations

# A chain of three links closes a loop and stretches where c is 0, out of its range: the crank moves the load no more.
STRETCHED = """\
model: stretched
joints:
  crank: {type: revolute, axis: z, coordinate: a}
  load: {type: revolute, axis: z, parent: crank, at: [0.4, 0, 0], coordinate: s}
  rod: {type: revolute, axis: z, parent: crank, at: [0.4, 0, 0], coordinate: b}
  rocker: {type: revolute, axis: z, parent: rod, at: [0.6, 0, 0], coordinate: c}
gravity: [0, -9.81, 0]
bodies:
  crank: {mass: 6, com: [0.4, 0, 0], inertia: {zz: 0.18}}
  load: {mass: 7, com: [0.3, 0, 0], inertia: {zz: 0.13}}
  rod: {mass: 3, com: [0.24, 0, 0], inertia: {zz: 0.2}}
  rocker: {mass: 5, com: [0.14, 0, 0], inertia: {zz: 0.3}}
points: {tip: {frame: rocker, at: [0.29, 0, 0]}, ground: {at: [-0.163, -0.866, 0]}}
loops: {pin: {type: point, between: [tip, ground]}}
inputs: {u: {joint: a}}
configuration: {a: -2.04, s: 0.66, b: 0, c: 2.13}
ranges: {a: [-3, -1.5], s: [0.1, 1.1], c: [1.2, 3.1]}
"""
# Euler's angles: upright, two of them are turns about one axis, and the inertia about another is none.
TOP = """\
model: top
coordinates: {psi: {unit: rad}, theta: {unit: rad}, phi: {unit: rad}}
parameters: {J_x: {value: 0.17}, J_y: {value: 0.14}, J_z: {value: 0.11}}
definitions:
  w_x: psi_dot*sin(theta)*sin(phi) + theta_dot*cos(phi)
  w_y: psi_dot*sin(theta)*cos(phi) - theta_dot*sin(phi)
  w_z: psi_dot*cos(theta) + phi_dot
kinetic_energy: J_x/2*w_x**2 + J_y/2*w_y**2 + J_z/2*w_z**2
potential_energy: 5*cos(theta)
inputs: {u_1: {acts_on: {theta: 1}}, u_2: {acts_on: {psi: cos(theta), phi: 1}}}
outputs: [forward_dynamics]
configuration: {theta: 1}
ranges: {theta: [0.7, 1.3]}
"""


def bounded(text: str, name: str, method: str) -> tuple[Draft, Expected]:
    model = load_text(text, "model.yaml")
    expected = Expected(model, [name], 64, lambda _: None)
    for scalar in ("float64", "float32"):
        expected.values(scalar)
    draft = draft_of(model, [name], Options(methods={name: method}))
    return CoordinateBounds(expected).of(draft), expected


def units(expected: Expected, draft: Draft, kernel: Kernel, scalar: Scalar, state: State) -> float | Status:
    state = in_scalar(state, scalar)
    (made,) = outcomes(kernel, draft.programs[scalar].sincos, scalar, [state])
    if not made.valid:
        return Status(made.status)
    known = expectations(expected.reference, state, [kernel.name], scalar, "outside")[kernel.name]
    return known.in_units(known.distance(made.entries))


def test_where_masses_are_singular_out_of_a_range_a_coordinate_is_bounded() -> None:
    name = "forward_dynamics"
    draft, expected = bounded(TOP, name, "schur_qr")
    for scalar in ("float64", "float32"):
        ((_, (bound,)),) = draft.coordinate_bounds[scalar].items()
        assert bound.coordinate == "theta"
        assert bound.low is not None
        assert 0.2 < bound.low < 0.7
        # half of the way to where something is lost, which is at the other end if anywhere
        assert bound.high is None or 1.3 < bound.high < 3
        plain, written = (
            next(one for one in program.kernels if one.name == name)
            for program in (draft.programs[scalar], draft.written[scalar])
        )
        rest = ((0.3, 0.4, 0.5), (0.1, 0.2, -0.3), (1.0, 2.0), (0.17, 0.14, 0.11), ())
        upright, within, beside = (State((0.2, theta, 0.6), *rest) for theta in (2e-2, 0.8, float(bound.low) + 0.01))
        lost = units(expected, draft, plain, scalar, upright)
        assert isinstance(lost, float)
        assert lost > FACTOR
        assert units(expected, draft, written, scalar, upright) is Status.COORDINATE_RANGE
        for state in (within, beside):
            before, after = (units(expected, draft, one, scalar, state) for one in (plain, written))
            assert after == before
            assert isinstance(after, float)
            assert after < FACTOR


@pytest.mark.campaign
def test_where_inputs_lose_a_direction_out_of_a_range_a_coordinate_is_bounded() -> None:
    """The chain stretches at 0, and u by minors loses digits there: the end that it comes from is bounded."""
    draft, _ = bounded(STRETCHED, "inverse_dynamics", "minor")
    ((_, bounds),) = draft.coordinate_bounds["float64"].items()
    low = next(bound.low for bound in bounds if bound.coordinate == "c")
    assert low is not None
    assert 0.5 < low < 1.2


def test_ranges_that_nobody_states_bound_nothing() -> None:
    model = load_text(TOP.replace("ranges: {theta: [0.7, 1.3]}\n", ""), "top.yaml")
    expected = Expected(model, ["forward_dynamics"], 16, lambda _: None)
    draft = draft_of(model, ["forward_dynamics"], Options(methods={"forward_dynamics": "schur_qr"}))
    bounds = FarCoordinates(expected).bounds(draft.kernels("forward_dynamics"), draft.programs)
    assert bounds == {"float64": (), "float32": ()}


def test_the_coordinate_that_is_furthest_out_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half of the way to the nearest loss, in a digit of that; none where nothing is lost."""
    model = load_text(STRETCHED, "stretched.yaml")
    expected = Expected(model, ["inverse_dynamics"], 16, lambda _: None)
    far = FarCoordinates(expected)
    draft = draft_of(model, ["inverse_dynamics"], Options(methods={"inverse_dynamics": "minor"}))
    kernels = {"float64": draft.kernels("inverse_dynamics")["float64"]}

    def lost(*_: object) -> list[tuple[float, ...]]:
        return [(-2.0, 0.5, 0.0, 0.2), (-2.0, 1.7, 0.0, 0.7), (-2.0, 0.5, 0.0, 3.42)]

    monkeypatch.setattr(FarCoordinates, "_lost", lost)
    assert far.bounds(kernels, draft.programs)["float64"] == (
        CoordinateBound("s", None, Fraction(7, 5)),
        CoordinateBound("c", Fraction(7, 10), Fraction(163, 50)),
    )


def test_a_loss_that_constraints_lead_back_into_the_ranges_bounds_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    model = load_text(TOP, "top.yaml")
    expected = Expected(model, ["forward_dynamics"], 16, lambda _: None)
    monkeypatch.setattr(OutsideStates, "settled", lambda *_: expected.drawn[0])
    monkeypatch.setattr(LostDigits, "units", lambda *given: 100 + 0 * given[-1].origins)
    monkeypatch.setattr(LostDigits, "is_lost", lambda *_: True)
    draft = draft_of(model, ["forward_dynamics"], Options(methods={"forward_dynamics": "schur_qr"}))
    assert FarCoordinates(expected).bounds(draft.kernels("forward_dynamics"), draft.programs)["float64"] == ()


@pytest.mark.campaign
def test_bounds_of_coordinates_are_told_and_taken_up_again(tmp_path: Path) -> None:
    path = tmp_path / "top.yaml"
    path.write_text(TOP, encoding="utf-8")
    made = generate(path, Options(parts=("c",)), lambda _: None)
    derivation = json.loads(made.files["derivation.json"])
    kernel = derivation["kernels"]["forward_dynamics"]
    # a method that holds within the range is enough
    assert "twice_the_digits" not in kernel
    ends = kernel["coordinate_bounds"]["float64"]["theta"]
    assert "COORDINATE_RANGE" in kernel["statuses"]
    (message,) = (one.message for one in made.notices if "out of the range" in one.message)
    assert message.startswith("forward_dynamics refuses theta below ")
    header = str(made.files["c/top.h"])
    assert f"forward_dynamics {ends[0]:g} <= theta" in header
    assert "TOP_COORDINATE_RANGE = 13" in header
    (tmp_path / "top").mkdir()
    (tmp_path / "top" / "derivation.json").write_text(str(made.files["derivation.json"]), encoding="utf-8")
    again = as_recorded(made.model, made.model.outputs, Options(measured=tmp_path))
    (bound,) = again.coordinate_bounds["float64"]["forward_dynamics"]
    assert [bound.low, bound.high] == [None if end is None else Fraction(str(end)) for end in ends]
