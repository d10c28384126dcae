"""What a study says is what the generated Python says at the same states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from studied_arm import SHIPPED, plan_of, python_kernels, result_of, results_of

from symgen.study.chunks import chunk_grid, chunk_values
from symgen.study.kernels import StudyKernels
from symgen.study.states import StudyStates
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import State
from symgen.verify.sampling.states import in_scalar

pytestmark = pytest.mark.toolchain


def test_inputs_along_a_path_are_those_of_the_python_kernels(tmp_path: Path) -> None:
    plan = plan_of(["m=1:8:4", "l=0.3:0.8:3"], "inputs,power", along=("swing",), quantiles=("0.25", "0.75"))
    results = results_of(tmp_path / "partial", plan)
    module = python_kernels(plan.kernels)
    states = StudyStates(plan, StudyKernels(result_of(plan)))
    for i, m in enumerate(np.linspace(1, 8, 4)):
        for j, length in enumerate(np.linspace(0.3, 0.8, 3)):
            q, qd, qdd = (part[0].T for part in states.of(np.array([[m, length]])).parts.values())
            p = module.Parameters(m=m, l=length)
            u = module.inverse_dynamics(q, qd, qdd, p)
            here = results.isel(m=i, l=j)
            assert (here.inputs_max.values == u.max(axis=0)).all()
            assert (here.inputs_min.values == u.min(axis=0)).all()
            assert (here.inputs_largest.values == np.abs(u).max(axis=0)).all()
            assert (here.inputs_at.values == np.abs(u).argmax(axis=0)).all()
            assert np.allclose(here.inputs_mean.values, u.mean(axis=0), rtol=0, atol=1e-13 * np.abs(u).max())
            assert np.allclose(here.inputs_rms.values, np.sqrt((u * u).mean(axis=0)), rtol=1e-13)
            # a bin of the histogram is a 256th of what is between the ends, and an order statistic may be in the next
            ordered = np.sort(u, axis=0)
            width = np.ptp(u, axis=0) / 256
            assert (here.inputs_quantiles.values[:, 0] >= ordered[9] - width).all()
            assert (here.inputs_quantiles.values[:, 0] <= ordered[11] + width).all()
            power = u * np.einsum("...ij,...i", module.control_matrix(q, p), qd)
            assert np.allclose(here.power_max.values, power.max(axis=0), rtol=1e-13)
            assert here.valid.values == 41


@pytest.mark.parametrize("along", [("swing",), ()])
def test_errors_in_float32_are_those_of_its_kernel_by_interpretation(tmp_path: Path, along: tuple[str, ...]) -> None:
    over = ["m=1:8:3", "l=0.3:0.8:2"] if along else ["a=-1:1:5", "b=0.4:2.4:7", "m=1:8:3"]
    plan = plan_of(over, "float32,inputs", along=along)
    results = results_of(tmp_path / "partial", plan)
    made = result_of(plan)
    module, single = python_kernels(plan.kernels), made.programs["float32"]
    kernel = next(one for one in single.kernels if one.name == "inverse_dynamics")
    axes = [np.linspace(one.axis.first, one.axis.last, one.axis.count or 1) for one in plan.over]
    values = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    states = StudyStates(plan, StudyKernels(made)).of(values)
    largest = []
    for k in range(len(values)):
        p = states.parameters[k]
        parts = [part[states.group[k]].T for part in states.parts.values()]
        given = [State(*(tuple(map(float, row)) for row in rows), (), tuple(p)) for rows in zip(*parts, strict=True)]
        short = outcomes(kernel, single.sincos, "float32", [in_scalar(state, "float32") for state in given])
        long = module.inverse_dynamics(*parts, module.Parameters(*p))
        largest.append(np.abs(np.array([one.entries for one in short]) - long).max(axis=0))
    shown = (results.float32_largest if along else results.float32).values.reshape(len(values), -1)
    assert (shown == np.array(largest)).all()
    assert (shown > 0).any()
    assert (shown < 1e-5 * 8 * 9.81).all()


def test_coordinates_of_a_machine_without_loops(tmp_path: Path) -> None:
    plan = plan_of(["a=-1:1:5", "b=0.4:2.4:21"], "inputs,singularity,utilisation,control")
    results = results_of(tmp_path / "partial", plan)
    module = python_kernels(plan.kernels)
    q = np.stack(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(0.4, 2.4, 21), indexing="ij"), axis=-1)
    rest = np.zeros_like(q)
    assert (results.inputs.values == module.inverse_dynamics(q, rest, rest)).all()
    assert (results.utilisation.values == module.utilisation(q, rest, rest)[..., 0]).all()
    assert (results.singularity.values == module.singularity(q)).all()
    values = np.linalg.svd(module.projected_control_matrix(q), compute_uv=False)
    assert np.allclose(results.control.values, values[..., 1], rtol=1e-13)


def test_the_determinant_of_two_drives_changes_its_sign_where_they_are_singular(tmp_path: Path) -> None:
    results = results_of(tmp_path / "partial", plan_of(["b=0.4:2.4:21"], "singularity"))
    b = np.linspace(0.4, 2.4, 21)
    both = results.choice.sel(drives="u_2+u_3").values
    # M = [[1, 0, cos b], [0, 1, 1]]: the last two columns depend on each other where cos b = 0
    assert np.allclose(both, -np.cos(b) / np.sqrt(1 + np.cos(b) ** 2), atol=1e-15)
    assert (np.sign(both[:-1]) != np.sign(both[1:])).sum() == 1


def test_a_task_is_reached_inside_of_its_circle_alone(tmp_path: Path) -> None:
    plan = plan_of(["x=-1.2:1.2:25", "y=-1.2:1.2:25"], "reach,inputs")
    results = results_of(tmp_path / "partial", plan)
    distance = np.hypot(results.x, results.y).transpose("x", "y").values
    reach = results.reach.values
    assert (reach[distance > 1.001] == 0).all()
    # those behind the base, too, to which no straight way leads from the front
    assert (reach[(distance > 0.1) & (distance < 0.98)] == 1).all()
    assert (np.isfinite(results.inputs.values).all(axis=-1) == (results.status.values == 0)).all()
    assert (results.status.values[reach == 0] != 0).all()


def test_a_parameter_that_closes_loops_is_walked_to(tmp_path: Path) -> None:
    model = SHIPPED / "rapkm_2rrr_rr.yaml"
    plan = plan_of(["l_1=0.18:0.25:5", "l_2=0.18:0.25:4"], "control,inputs", model=model)
    work_states = results_of(tmp_path / "partial", plan)
    assert (work_states.status.values == 0).all()
    assert len(np.unique(work_states.control.values)) == 20


def test_configurations_of_a_walk_close_the_loops_at_the_task(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    model = SHIPPED / "rapkm_2rrr_rr.yaml"
    plan = plan_of(["l_1=0.19:0.22:3", "x=0.15:0.25:3", "y=0.08:0.15:3"], "singularity", model=model)
    walked: list[tuple[np.ndarray, np.ndarray]] = []
    walk = StudyKernels.walked

    def seen(self, name, start, p, given):  # type: ignore[no-untyped-def]
        q, status = walk(self, name, start, p, given)
        walked.append((p.copy(), q.copy()))
        return q, status

    monkeypatch.setattr(StudyKernels, "walked", seen)
    results = results_of(tmp_path / "partial", plan)
    assert (results.status.values == 0).all()
    ((p, q),) = walked
    grid = chunk_values(plan, chunk_grid(plan), 0)
    first, second = q[:, 0, 0], q[:, 3, 0]
    tip_x = p[:, 2] + p[:, 0] * np.cos(first) + p[:, 1] * np.cos(first + second)
    tip_y = p[:, 3] + p[:, 0] * np.sin(first) + p[:, 1] * np.sin(first + second)
    assert np.allclose(tip_x, grid[:, 1], atol=1e-12)
    assert np.allclose(tip_y, grid[:, 2], atol=1e-12)
    assert (p[:, 0] == grid[:, 0]).all()


def test_states_along_ranges_are_reduced_at_each_point(tmp_path: Path) -> None:
    plan = plan_of(["m=1:2:3"], "inputs,reach", along=("x=0.3:0.6:4", "y=-0.2:0.2:5"))
    results = results_of(tmp_path / "partial", plan)
    alone = results_of(tmp_path / "alone" / "partial", plan_of(["m=1:2:3", "x=0.3:0.6:4", "y=-0.2:0.2:5"], "inputs"))
    assert plan.states == 20
    assert (results.inputs_max.values == alone.inputs.values.max(axis=(1, 2))).all()
    assert (results.reach_mean.values == 1).all()


def test_a_path_that_cannot_be_followed_has_a_status(tmp_path: Path) -> None:
    model = SHIPPED / "rapkm_2rrr_rr.yaml"
    plan = plan_of(["l_1=0.05:0.2:2"], "inputs", model=model, along=("circle",))
    results = results_of(tmp_path / "partial", plan)
    assert results.status.values.tolist() == [255, 0]
    assert np.isnan(results.inputs_max.values[0]).all()
    assert results.valid.values.tolist() == [0, 201]


@pytest.mark.parametrize("along", [("swing",), ("x=0.3:0.6:9", "y=-0.2:0.2:9")])
def test_what_is_reduced_at_once_is_what_is_reduced_from_entries(along: tuple[str, ...], tmp_path: Path) -> None:
    shown = "inputs,utilisation,singularity"
    at_once = results_of(tmp_path / "a" / "partial", plan_of(["m=1:8:30", "g=5:10:3"], shown, along=along))
    plan = plan_of(["m=1:8:30", "g=5:10:3"], f"{shown},power", along=along, quantiles=("0.5",))
    assert at_once.inputs_max.values.std() > 1
    for name, values in results_of(tmp_path / "b" / "partial", plan).items():
        if not name.startswith("power") and not name.endswith("quantiles"):
            assert np.array_equal(values, at_once[name], equal_nan=True), name


def test_sensitivities_are_what_the_inputs_change_by(tmp_path: Path) -> None:
    """Of the arm at rest p du/dp is the weight's share: u is proportional to m, to g and to l, and no limit is met."""
    results = results_of(tmp_path / "partial", plan_of(["m=1:3:3", "b=0.4:2.4:5"], "sensitivity,inputs"))
    largest = np.abs(results.inputs.values).max(axis=-1)
    for name in ("m", "l", "g"):
        assert np.allclose(results.sensitivity.sel(parameter=name).values, largest, rtol=1e-13)
    assert (results.sensitivity.sel(parameter="u_max").values == 0).all()
    assert results.sensitivity.attrs["units"] == "N*m"
