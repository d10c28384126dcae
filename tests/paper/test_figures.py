"""Figures 4 to 7 of the paper, recomputed for the RA-PKM on its circle."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from generated_python import load_generated

from symgen.backends.python.module import emit_python
from symgen.lowering.schedule import schedule
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.paths.figures import Curve, FigureData, figure_data
from symgen.paths.forces import forces_along
from symgen.paths.printed import inverse_dynamics, pseudoinverse
from symgen.paths.trajectory import PathSolver, Trajectory
from symgen.quantities.select import derive_quantities

MODELS = Path(__file__).parents[2] / "models"
PAIRS = {(0, 1): (0.690, 0.875), (0, 2): (0.495, 0.582), (1, 2): (0.295, 0.400)}


@functools.cache
def rapkm(name: str = "rapkm_2rrr_rr") -> tuple[Model, FigureData]:
    model = load_model(MODELS / f"{name}.yaml")
    return model, figure_data(model, model.paths[0])


def curve(pair: tuple[int, int]) -> Curve:
    return next(curve for curve in rapkm()[1].curves if curve.inputs == pair)


def test_figure_5_the_path_is_closed_and_at_rest_at_both_ends() -> None:
    trajectory = rapkm()[1].trajectory
    assert trajectory.q[-1] == pytest.approx(trajectory.q[0], abs=1e-12)
    for k in (0, -1):
        assert trajectory.qd[k] == pytest.approx(np.zeros(6), abs=1e-11)
        assert trajectory.qdd[k] == pytest.approx(np.zeros(6), abs=1e-9)
    assert np.all(trajectory.q[:, 3:] > 0)  # all elbows keep their side


@pytest.mark.parametrize(("pair", "times"), PAIRS.items())
def test_figure_6_two_zeros_for_every_pair_of_drives(pair: tuple[int, int], times: tuple[float, float]) -> None:
    assert curve(pair).zeros == pytest.approx(times, abs=5e-4)


def test_figure_6_some_pair_is_always_far_from_singular() -> None:
    values = np.array([c.values for c in rapkm()[1].curves])
    assert values.shape[0] == 3
    assert np.max(values, axis=0).min() == pytest.approx(0.0386, abs=1e-4)
    assert np.sum(values, axis=0).min() == pytest.approx(0.0978, abs=1e-4)


def test_figure_6_determinants_are_those_of_the_projected_columns() -> None:
    """det M̃_JᵀM̃_J = Δ_J²/det BBᵀ with Δ_J = det[M_J, Bᵀ] (decision 1)."""
    data = rapkm()[1]
    for c in data.curves:
        bordered = np.concatenate([data.forces.M[:, :, list(c.inputs)], np.swapaxes(data.forces.B, 1, 2)], axis=2)
        gram = data.forces.B @ np.swapaxes(data.forces.B, 1, 2)
        assert c.values == pytest.approx(np.linalg.det(bordered) ** 2 / np.linalg.det(gram), abs=1e-14)


@pytest.mark.parametrize("pair", PAIRS)
def test_figure_4_middle_links_are_parallel_or_the_third_arm_is_stretched(pair: tuple[int, int]) -> None:
    poses = curve(pair).poses
    third = ({0, 1, 2} - set(pair)).pop()
    direction = poses[:, :3] + poses[:, 3:]
    parallel = np.sin(direction[:, pair[0]] - direction[:, pair[1]])
    stretched = np.sin(poses[:, 3 + third])
    assert np.abs(parallel * stretched) == pytest.approx(np.zeros(2), abs=1e-9)


def test_switching_starts_with_drives_2_and_3_and_uses_every_pair_once() -> None:
    data = rapkm()[1]
    assert data.printed is not None
    used = [data.curves[k].inputs for k in data.printed.partition]
    sequence = [pair for k, pair in enumerate(used) if k == 0 or pair != used[k - 1]]
    assert data.threshold == pytest.approx(0.05 * max(float(np.max(c.values)) for c in data.curves))
    assert sequence == [(1, 2), (0, 1), (0, 2)]


def test_figure_7_torques_are_smooth_and_small() -> None:
    data = rapkm()[1]
    assert np.max(np.abs(data.u)) == pytest.approx(1.48, abs=5e-3)
    model = rapkm()[0]
    fine = figure_data(model, replace(model.paths[0], samples=401)).u
    # Third differences of a smooth curve fall with the third power of the step; a jump would keep them.
    coarse_third, fine_third = (float(np.max(np.abs(np.diff(u, 3, axis=0)))) for u in (data.u, fine))
    assert fine_third < coarse_third / 6


def generated(model: Model, folder: Path) -> ModuleType:
    """symgen's own Python module of the model, imported from a file."""
    derivations = derive_quantities(model, ("inverse_dynamics",))
    files = emit_python(model, schedule(derivations.mechanics, derivations.quantities, ("float64",))["float64"])
    (text,) = (text for name, text in files.items() if name.endswith(f"{model.name}.py"))
    (folder / "figure_kernel.py").write_text(str(text), encoding="utf-8")
    return load_generated(folder / "figure_kernel.py")


def test_switching_as_printed_agrees_with_symgens_own_form(tmp_path: Path) -> None:
    model, data = rapkm()
    own = generated(model, tmp_path).inverse_dynamics(data.trajectory.q, data.trajectory.qd, data.trajectory.qdd)
    assert data.printed is not None
    assert data.printed.u == pytest.approx(own, abs=1e-13)
    assert data.u == pytest.approx(own, abs=1e-13)


def test_a_fixed_partition_loses_accuracy_where_switching_does_not() -> None:
    """A millionth of a second beside a zero of det M̃₁ᵀM̃₁ the fixed partition is wrong in the tenth digit or worse."""
    model, _ = rapkm()
    solver, t = PathSolver(model, model.paths[0]), curve((0, 1)).zeros[0] + 1e-6
    q = solver.follow(solver.start(), 0.0, t)
    qd, qdd = solver.derivatives(q, t)
    forces = forces_along(model, Trajectory(np.array([t]), q[None], qd[None], qdd[None]))
    u = {first: inverse_dynamics(forces.B[0], forces.M[0], forces.tau[0], first) for first in PAIRS}
    assert np.max(np.abs(u[0, 2] - u[1, 2])) < 1e-13
    assert np.max(np.abs(u[0, 1] - u[1, 2])) > 1e-10


def test_two_drives_alone_have_true_input_singularities() -> None:
    _, data = rapkm("rapkm_two_drives")
    (only,) = data.curves
    assert only.zeros == pytest.approx(PAIRS[0, 1], abs=5e-4)
    assert np.max(np.abs(data.u)) > 1e3


def test_pseudoinverse_as_printed_does_not_depend_on_the_partition() -> None:
    generator = np.random.default_rng(5)
    M = generator.normal(size=(6, 2)) @ generator.normal(size=(2, 4))
    for first in ((0, 1), (1, 3), (3, 2)):
        assert pseudoinverse(M, first) == pytest.approx(np.linalg.pinv(M, rcond=1e-9), abs=1e-12)
