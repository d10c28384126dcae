"""Every peer by every method computes the same u as the 50-digit reference: none is fast because it is wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from shipped import NAMES, ROOT, model

from symgen.laboratory.bench import build as build_module
from symgen.laboratory.bench.build import build, results_of
from symgen.laboratory.bench.candidate import Task
from symgen.laboratory.bench.peers.roster import peers, python_peers
from symgen.laboratory.bench.python_timing import run_python
from symgen.laboratory.bench.symgen_kernels import programs_of, symgen_candidates, symgen_python
from symgen.laboratory.bench.workload import admissible_samples, errors_of, workload
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.verify.reference.reference import Reference

pytestmark = pytest.mark.toolchain
STATES = 12
DRIVEN = tuple(name for name in NAMES if name != "front_car_wheelset")
ACCURATE = 1e-9  # far above what a fixed choice of coordinates loses at these states, far below a wrong formula


@pytest.fixture(autouse=True)
def gcc(tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr(build_module, "FLAGS", ("-O0", *build_module.FLAGS[1:]))  # errors do not need the optimiser
    return tool("gcc")


def quiet(_: str) -> None:
    pass


def under_actuated(folder: Path) -> Model:
    """The double pendulum without its second drive."""
    text = (ROOT / "models" / "double_pendulum.yaml").read_text(encoding="utf-8")
    path = folder / "model.yaml"
    path.write_text("\n".join(line for line in text.splitlines() if not line.startswith("  elbow:")), encoding="utf-8")
    return load_model(path)


@pytest.mark.parametrize(
    "name",
    ["skate", *(pytest.param(n, marks=pytest.mark.bench) for n in ("under-actuated", *DRIVEN) if n != "skate")],
)
def test_inverse_dynamics_of_every_peer(name: str, tmp_path: Path) -> None:
    described = under_actuated(tmp_path) if name == "under-actuated" else model(name)
    reference = Reference(described)
    task = Task("inverse_dynamics", "qdd", described.m)
    samples = admissible_samples(reference, STATES, (task.quantity,))
    load = workload(reference, samples, task, "float64", quiet)
    all_peers = peers(described, task, load.states)
    candidates = list(all_peers.candidates)
    if described.n <= 4:  # the other models' kernels are verified elsewhere, but not with the library's sine
        candidates += symgen_candidates(described, programs_of(described, task, ("float64",)), "float64")
    built = build(tmp_path, described, task, candidates, {"float64": load})
    results = results_of(built, tmp_path, candidates, task)
    errors = {c.label: errors_of(load, results[c.entry]).largest for c in candidates}
    for peer in python_peers(described, task):
        errors[peer.label] = errors_of(load, run_python(described, peer, load)[0]).largest
    assert {label: error for label, error in errors.items() if not error < ACCURATE} == {}
    expected = {"NumPy pinv", "CasADi native", "CasADi SSA lean", "SymPy lean", "SymPy lean LDLᵀ", "C Householder QR"}
    assert expected <= errors.keys()
    assert all(built.footprints[c.entry].code > 50 for c in candidates)


@pytest.mark.parametrize("quantity", ["forward_dynamics", pytest.param("multipliers", marks=pytest.mark.bench)])
@pytest.mark.parametrize("name", ["slider_crank", pytest.param("front_car", marks=pytest.mark.bench)])
def test_forward_dynamics_and_multipliers(name: str, quantity: str, tmp_path: Path) -> None:
    described = model(name)
    reference = Reference(described)
    task = Task(quantity, "u", described.n if quantity == "forward_dynamics" else described.r)
    load = workload(reference, admissible_samples(reference, STATES, (quantity,)), task, "float64", quiet)
    candidates = peers(described, task, load.states).candidates
    built = build(tmp_path, described, task, candidates, {"float64": load})
    results = results_of(built, tmp_path, candidates, task)
    native, in_lines, *others = candidates
    assert [native.label, in_lines.label] == ["CasADi native", "CasADi SSA native"]
    assert [c.label for c in others] == ["CasADi SSA Schur", "CasADi SSA null space"]
    # the function that does the work is counted, whether it is inlined or not
    assert built.footprints[native.entry].code > built.footprints[in_lines.entry].code / 2
    assert all(errors_of(load, results[c.entry]).largest < ACCURATE for c in candidates)
    python, *_ = symgen_python(described, programs_of(described, task, ("float64",)), task)
    assert errors_of(load, run_python(described, python, load)[0]).largest < ACCURATE


SIZES: dict[str, Callable[[Model], int]] = {
    "mass_matrix": lambda m: m.n**2,
    "coriolis_matrix": lambda m: m.n**2,
    "coriolis_force": lambda m: m.n,
    "constraint_jacobian": lambda m: m.r * m.n,
    "nullspace_projector": lambda m: m.n**2,
    "nullspace_projector_dot": lambda m: m.n**2,
    "projected_control_pseudoinverse": lambda m: m.m * m.n,
}


@pytest.mark.parametrize("quantity", SIZES)
def test_matrices(quantity: str, tmp_path: Path) -> None:
    described = model("front_car")
    reference, task = Reference(described), Task(quantity, "qdd", SIZES[quantity](described))
    load = workload(reference, admissible_samples(reference, STATES, (quantity,)), task, "float64", quiet)
    (peer,) = peers(described, task, load.states).candidates
    own = [c for c in symgen_candidates(described, programs_of(described, task, ("float64",)), "float64") if c.chosen]
    candidates = [*own, peer]
    results = results_of(build(tmp_path, described, task, candidates, {"float64": load}), tmp_path, candidates, task)
    errors = {c.label: errors_of(load, results[c.entry]).largest for c in candidates}
    assert {label: error for label, error in errors.items() if not error < ACCURATE} == {}


@pytest.mark.parametrize("quantity", ["nullspace_projector", "projected_control_pseudoinverse"])
def test_matrices_of_rows_have_no_peer_where_there_are_none(quantity: str) -> None:
    described = model("double_pendulum")
    states = np.ones((1, 3 * described.n + len(described.parameters)))
    all_peers = peers(described, Task(quantity, "qdd", described.n**2), states)
    assert all_peers.candidates == ()
    assert [name for name, _ in all_peers.left_out] == ["peers"]


def test_a_formula_that_is_singular_everywhere_is_no_peer() -> None:
    """M~^+ by a basis of ker B needs inputs that span all motions."""
    text = """
model: board
coordinates: {x: {}, y: {}, a: {}}
kinetic_energy: (x_dot**2 + y_dot**2 + a_dot**2)/2
constraints: {nonholonomic: {edge: sin(a)*x_dot - cos(a)*y_dot}}
inputs: {turn: {acts_on: {a: 1}}}
"""
    described = load_text(text, "board.yaml")
    states = np.ones((2, 3 * described.n))
    all_peers = peers(described, Task("projected_control_pseudoinverse", "qdd", 3), states)
    assert all_peers.candidates == ()
    assert "inputs span less" in dict(all_peers.left_out)["peers"]


def test_accelerations_of_an_arm_by_articulated_bodies(tmp_path: Path) -> None:
    described = model("scara")
    reference, task = Reference(described), Task("forward_dynamics", "u", described.n)
    load = workload(reference, admissible_samples(reference, STATES, (task.quantity,)), task, "float64", quiet)
    candidates = peers(described, task, load.states).candidates
    results = results_of(build(tmp_path, described, task, candidates, {"float64": load}), tmp_path, candidates, task)
    errors = {c.label: errors_of(load, results[c.entry]).largest for c in candidates}
    assert {"CasADi SSA articulated bodies", "SSA articulated bodies"} <= errors.keys()
    assert {label: error for label, error in errors.items() if not error < ACCURATE} == {}


def test_a_wrong_kernel_has_a_large_error() -> None:
    described = model("skate")
    reference = Reference(described)
    task = Task("inverse_dynamics", "qdd", described.m)
    load = workload(reference, admissible_samples(reference, STATES, (task.quantity,)), task, "float64", quiet)
    exact = errors_of(load, load.high)
    assert exact.largest < 2**-53
    assert exact.failed == 0
    off = errors_of(load, load.high * (1 + 1e-6))
    assert off.median == pytest.approx(1e-6)
    assert off.largest_in_units > 1e3
    broken = load.high.copy()
    broken[3, 0] = float("nan")
    assert errors_of(load, broken).failed == 1
    assert errors_of(load, broken).largest == float("inf")
