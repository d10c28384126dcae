"""Other units, odd numbers, and the command itself."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from shipped import model
from test_families import reference

from symgen.cli.main import main
from symgen.generation.runnable import PIECES, STRESSED, RunnableKernels
from symgen.laboratory.stress.long_run import long_runs
from symgen.laboratory.stress.odd_numbers import odd_numbers
from symgen.laboratory.stress.reporting.pages import page
from symgen.laboratory.stress.variants.scaling import scaling
from symgen.verify.sampling.states import sample_states

CART = """
model: cart
coordinates: {x: {unit: m}}
parameters: {m: {value: 2, unit: kg}}
kinetic_energy: m/2*x_dot**2
inputs: {F: {unit: N, acts_on: {x: 1}}}
"""


@pytest.fixture(scope="module")
def slider_crank(tmp_path_factory: pytest.TempPathFactory) -> tuple[RunnableKernels, Path]:
    folder = tmp_path_factory.mktemp("kernels")
    names = ("constraint_residual", "energy", "admissible_velocity", "projected_configuration")
    return RunnableKernels(model("slider_crank"), folder, (*PIECES, *STRESSED, *names)), folder


@pytest.mark.campaign
def test_powers_of_two_change_no_bit_of_the_inputs(slider_crank: tuple[RunnableKernels, Path], tmp_path: Path) -> None:
    scaled, failures = scaling(reference("slider_crank"), slider_crank[0], tmp_path)
    assert failures == ()
    changes = {"lengths", "masses", "times", "all three", "m in mm", "rad in deg"}
    assert {one.change for one in scaled} == changes
    u = [one for one in scaled if one.quantity == "inverse_dynamics"]
    for one in u:
        binary = one.change not in ("m in mm", "rad in deg")
        assert one.covariant
        assert one.required == one.identical == binary
        assert one.units < 16


def test_no_odd_number_gives_an_odd_result_with_status_0(tmp_path: Path) -> None:
    kernels = RunnableKernels(model("skate"), tmp_path, STRESSED)
    states = [sample.state for sample in sample_states(reference("skate"), (), 8)][:2]
    counts, failures = odd_numbers(kernels, [name for name in STRESSED if name in kernels.names], states)
    assert failures == ()
    assert all(0 < one.answered < one.calls for one in counts)


@pytest.mark.campaign
@pytest.mark.toolchain
def test_projections_keep_a_long_run_on_the_constraints(
    slider_crank: tuple[RunnableKernels, Path], tool: Callable[[str], str]
) -> None:
    tool("cc")
    (free, projected), _ = long_runs(reference("slider_crank"), *slider_crank, 10_000)
    assert free.complaint == projected.complaint == ""
    assert len(free.time) == 200
    assert max(free.tracking) < 1e-3
    assert max(projected.position_drift) < 1e-14 < max(free.position_drift) < 1e-10
    assert max(projected.energy) < 1e-10


@pytest.mark.campaign
def test_command_writes_numbers_and_charts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "cart.yaml"
    file.write_text(CART)
    assert main(["stress", str(file), "--out", str(tmp_path), "--steps", "0"]) == 0
    shown = capsys.readouterr().out
    assert "mass ratios" in shown
    assert "same bits" in shown
    text = (tmp_path / "cart" / "stress.json").read_text()
    data = json.loads(text)
    assert data["passed"]
    assert data["no_long_run"] == "not asked for"
    for chart in ("stress.svg", "stress.families.svg", "stress.own_methods.svg"):
        assert (tmp_path / "cart" / chart).read_text().startswith("<?xml")
    # the page needs nothing but the numbers
    written = page([text], {"cart": ["cart.methods.svg"]})
    assert "## cart" in written
    assert "(cart.methods.svg)" in written


def test_command_names_mistakes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text("model: bad\ncoordinates: {x: }\nkinetic_energy: y_dot**2\n")
    assert main(["stress", str(file), "--out", str(tmp_path)]) == 1
    assert "y_dot" in capsys.readouterr().err
    assert main(["stress", str(tmp_path / "missing.yaml")]) == 2
