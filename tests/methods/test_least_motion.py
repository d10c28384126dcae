"""A task with fewer functions than directions: the least motion against NumPy's pseudoinverse, laws, and a path."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray

from symgen.cli.main import main
from symgen.ir.kernel import Status
from tests.methods.test_measured import kernels
from tests.methods.test_task import differences

Array = NDArray[np.float64]
LENGTHS = np.array([0.4, 0.3, 0.2])
OF_TASK = "configuration_from_task, velocity_from_task, acceleration_from_task, task_nullspace_projector"
ALL = f"outputs: [task_position, task_jacobian, {OF_TASK}]"
ARM = f"""
model: arm
parameters: {{l_1: {{value: 0.4, unit: m}}, l_2: {{value: 0.3, unit: m}}, l_3: {{value: 0.2, unit: m}}}}
joints:
  one: {{type: revolute, axis: z, coordinate: a}}
  two: {{type: revolute, parent: one, at: [l_1, 0, 0], axis: z, coordinate: b}}
  three: {{type: revolute, parent: two, at: [l_2, 0, 0], axis: z, coordinate: c}}
bodies:
  one: {{mass: 2, com: [l_1/2, 0, 0], inertia: {{zz: 0.02}}}}
  two: {{mass: 1, com: [l_2/2, 0, 0], inertia: {{zz: 0.01}}}}
  three: {{mass: 1, com: [l_3/2, 0, 0], inertia: {{zz: 0.01}}}}
points: {{tip: {{frame: three, at: [l_3, 0, 0]}}}}
inputs: {{u_a: {{joint: a}}, u_b: {{joint: b}}, u_c: {{joint: c}}}}
task: {{x: tip.x, y: tip.y}}
configuration: {{a: 0.4, b: 0.9, c: -0.6}}
{ALL}
"""
# The tip of two links in coordinates of its own, and how far it is along a ruler that turns.
RULER = f"""
model: ruler
coordinates: {{x: {{unit: m}}, y: {{unit: m}}, a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}}}
parameters: {{l: {{value: 0.5, unit: m}}, h: {{value: 0.3, unit: m}}}}
kinetic_energy: (x_dot**2 + y_dot**2 + l**2*a_dot**2 + l**2*b_dot**2 + h**2*c_dot**2)/2
constraints: {{geometric: {{across: x - l*cos(a) - h*cos(a + b), up: y - l*sin(a) - h*sin(a + b)}}}}
inputs: {{u: {{acts_on: {{a: 1}}}}}}
task: {{reach: x*cos(c) + y*sin(c)}}
configuration: {{x: 0.5691, y: 0.4743, a: 0.4, b: 0.8, c: 0.5}}
{ALL.replace("outputs: [", "outputs: [constraint_jacobian, constraint_residual, ")}
"""
# The same with a row that follows from both.
BOTH = "h*sin(a + b), both: 2*x + y - 2*l*cos(a) - 2*h*cos(a + b) - l*sin(a) - h*sin(a + b)}"
DEPENDENT = RULER.replace("h*sin(a + b)}", BOTH)
CAR = f"""
model: car
coordinates: {{x: {{}}, y: {{}}, theta: {{unit: rad}}}}
kinetic_energy: (x_dot**2 + y_dot**2 + theta_dot**2)/2
constraints: {{nonholonomic: {{rear: sin(theta)*x_dot - cos(theta)*y_dot}}}}
inputs: {{force: {{acts_on: {{x: cos(theta), y: sin(theta)}}}}}}
task: {{nose: x + 0.8*cos(theta)}}
{ALL}
"""


def ruler(angles: Array) -> Array:
    """Configurations of the ruler from its three angles."""
    a, b, c = angles.T
    return np.stack((0.5 * np.cos(a) + 0.3 * np.cos(a + b), 0.5 * np.sin(a) + 0.3 * np.sin(a + b), a, b, c), axis=1)


def states_of(text: str, random: np.random.Generator) -> Array:
    """Configurations on V away from singularities, of the arm or of a ruler."""
    a, b, c = random.uniform(-3, 3, 200), random.uniform(0.3, 2.8, 200), random.uniform(-2.5, 2.5, 200)
    angles = np.stack((a, b, c), axis=1)
    return angles if text == ARM else ruler(angles)


def stacked(module: ModuleType, q: Array) -> Array:
    """Rows and the derivatives of the task, one below the other."""
    slopes: Array = module.task_jacobian(q)
    return np.concatenate((module.constraint_jacobian(q), slopes), axis=-2) if q.shape[-1] == 5 else slopes


@pytest.mark.campaign
@pytest.mark.parametrize(
    "text",
    [ARM, pytest.param(RULER, marks=pytest.mark.slow), pytest.param(DEPENDENT, marks=pytest.mark.slow)],
    ids=["arm", "ruler", "dependent rows"],
)
def test_rates_are_the_least_and_null_motions_leave_the_task_still(text: str, tmp_path: Path) -> None:
    module, random = kernels(text, tmp_path), np.random.default_rng(1)
    q = states_of(text, random)
    A = stacked(module, q)
    k = module.task_jacobian(q).shape[-2]
    rates = random.normal(size=(len(q), k))
    right = np.concatenate((np.zeros((len(q), A.shape[-2] - k)), rates), axis=1)
    inverse = np.linalg.pinv(A, rcond=1e-12)
    velocity = module.velocity_from_task(q, rates)
    size = 1 + np.abs(inverse).max(axis=(1, 2))[:, None]
    assert np.abs((velocity - np.einsum("tij,tj->ti", inverse, right)) / size).max() < 1e-13
    projector = module.task_nullspace_projector(q)
    assert np.abs(projector - (np.eye(q.shape[1]) - inverse @ A)).max() < 1e-12
    assert np.abs(A @ projector).max() < 1e-13
    assert np.abs(np.einsum("tij,tj->ti", projector, velocity) / size).max() < 1e-13
    open_ = q.shape[1] - (3 if q.shape[1] == 5 else 2)
    assert np.allclose(np.trace(projector, axis1=1, axis2=2), open_, atol=1e-12, rtol=0)


@pytest.mark.campaign
@pytest.mark.parametrize(
    "text",
    [ARM, pytest.param(RULER, marks=pytest.mark.slow), pytest.param(DEPENDENT, marks=pytest.mark.slow)],
    ids=["arm", "ruler", "dependent rows"],
)
def test_accelerations_are_those_of_the_motion_that_has_the_least_rates(text: str, tmp_path: Path) -> None:
    module, step = kernels(text, tmp_path), 2e-3
    q = states_of(text, np.random.default_rng(2))[3]
    k = module.task_jacobian(q).shape[0]
    v, w = np.array([0.1, -0.3])[:k], np.array([0.7, 0.2])[:k]

    def rates(t: float, at: Array) -> Array:
        return np.asarray(module.velocity_from_task(at, v + w * t))

    def after(t: float) -> Array:
        """The motion with these rates, by eight steps of Runge and Kutta's method."""
        at, h = q, t / 8
        for i in range(8):
            one = rates(i * h, at)
            two = rates((i + 0.5) * h, at + h / 2 * one)
            three = rates((i + 0.5) * h, at + h / 2 * two)
            at = at + h / 6 * (one + 2 * two + 2 * three + rates((i + 1) * h, at + h * three))
        return at

    slope, _ = differences(tuple(rates(i * step, after(i * step)) for i in range(-2, 3)), step)
    acceleration = module.acceleration_from_task(q, v, w)
    assert np.allclose(acceleration, slope, atol=1e-8, rtol=0)
    # without its part along null motions it is the least acceleration
    A, velocity = stacked(module, q), rates(0, q)
    turning, _ = differences(tuple(stacked(module, q + i * step * velocity) for i in range(-2, 3)), step)
    right = np.concatenate((np.zeros(len(A) - k), w)) - turning @ velocity
    least = acceleration - module.task_nullspace_projector(q) @ acceleration
    assert np.allclose(least, np.linalg.pinv(A, rcond=1e-12) @ right, atol=1e-7, rtol=0)
    assert np.linalg.norm(acceleration - least) > 1e-3


@pytest.mark.parametrize("text", [ARM, RULER], ids=["arm", "ruler"])
def test_a_configuration_meets_the_task_and_is_nearest_to_the_second_order(text: str, tmp_path: Path) -> None:
    module, random = kernels(text, tmp_path), np.random.default_rng(3)
    q = states_of(text, random)
    beside: list[float] = []
    for far in (1e-2, 1e-3):
        aim = module.task_position(q) + far * random.normal(size=module.task_position(q).shape)
        configurations = module.configuration_from_task(aim, q)
        kept = np.isfinite(configurations).all(axis=1)
        assert kept.mean() > 0.9
        here, moved = configurations[kept], (configurations - q)[kept]
        assert np.abs(module.task_position(here) - aim[kept]).max() < 1e-15
        if text == RULER:
            assert np.abs(module.constraint_residual(here)).max() < 1e-15
        # of the nearest nothing is left along null motions
        along = np.einsum("tij,tj->ti", module.task_nullspace_projector(here), moved)
        beside.append(float(np.median(np.linalg.norm(along, axis=1) / np.linalg.norm(moved, axis=1) ** 2)))
    assert 0.2 < beside[0] / beside[1] < 5
    assert max(beside) < 10


def test_a_coordinate_that_is_given_is_met_exactly(tmp_path: Path) -> None:
    """A hand whose angle is one of the task, and whose place is open by one direction."""
    text = ARM.replace("task: {x: tip.x, y: tip.y}", "task: {x: tip.x, elbow: b}")
    module, q = kernels(text, tmp_path), np.array([0.4, 0.9, -0.6])
    aim = [float(module.task_position(q)[0]) + 0.02, 0.93]
    configuration = module.configuration_from_task(aim, q)
    assert configuration[1] == 0.93
    assert abs(module.task_position(configuration)[0] - aim[0]) < 1e-15


@pytest.mark.parametrize(
    ("q", "statuses"),
    [([0.3, 0.0, 0.0], {Status.TASK_RANK}), ([0.3, 0.0, np.pi], {Status.TASK_RANK})],
    ids=["stretched", "folded"],
)
def test_where_the_task_loses_rank_there_is_a_status(q: list[float], statuses: set[Status], tmp_path: Path) -> None:
    module = kernels(ARM, tmp_path)
    calls = (
        lambda: module.velocity_from_task(q, [0.1, 0.2]),
        lambda: module.acceleration_from_task(q, [0.1, 0.2], [0.3, 0.4]),
        lambda: module.task_nullspace_projector(q),
        lambda: module.configuration_from_task([0.5, 0.1], q),
    )
    for call in calls:
        with pytest.raises(module.StateError) as caught:
            call()
        assert caught.value.status.name in {status.name for status in statuses}


def test_a_single_function_that_nothing_moves_has_a_status(tmp_path: Path) -> None:
    """All links along the axis of what is measured: its derivatives are rounding, and so would be their quotients."""
    module = kernels(ARM.replace("task: {x: tip.x, y: tip.y}", "task: {x: tip.x}"), tmp_path)
    for q in ([0.0, 0.0, 0.0], [np.pi, 0.0, 0.0], [0.0, np.pi, np.pi]):
        with pytest.raises(module.StateError) as caught:
            module.velocity_from_task(q, [0.1])
        assert caught.value.status.name == Status.TASK_RANK.name
    assert np.isfinite(module.velocity_from_task([0.0, 1e-6, 0.0], [0.1])).all()


def test_a_place_beyond_reach_has_a_status(tmp_path: Path) -> None:
    module, random = kernels(ARM, tmp_path), np.random.default_rng(4)
    q = states_of(ARM, random)
    turn = random.uniform(-np.pi, np.pi, len(q))
    far = (LENGTHS.sum() + 0.02) * np.stack((np.cos(turn), np.sin(turn)), axis=1)
    assert not np.isfinite(module.configuration_from_task(far, q)).any()


def test_a_circle_is_followed_in_small_steps_along_the_least_rates(tmp_path: Path) -> None:
    """Configurations of small steps are those of the motion with the least rates; the arm does not come back."""
    module, q = kernels(ARM, tmp_path), np.array([0.4, 0.9, -0.6])
    start, count = module.task_position(q), 400
    along, by_rates = q, q
    for i in range(count):
        turn = np.array([i, i + 0.5, i + 1]) * 2 * np.pi / count
        aims = start + 0.08 * np.stack((np.cos(turn) - 1, np.sin(turn)), axis=1)
        speeds = 0.08 * np.stack((-np.sin(turn), np.cos(turn)), axis=1) * 2 * np.pi / count
        along = module.configuration_from_task(aims[2], along)
        middle = by_rates + module.velocity_from_task(by_rates, speeds[0]) / 2
        by_rates = by_rates + module.velocity_from_task(middle, speeds[1])
    assert np.allclose(module.task_position(along), start, atol=1e-15, rtol=0)
    assert np.allclose(along, by_rates, atol=2e-3, rtol=0)
    assert np.linalg.norm(along - q) > 5 * np.linalg.norm(along - by_rates)


@pytest.mark.parametrize(
    ("text", "names", "why"),
    [
        (ARM.replace("y: tip.y", "y: tip.y, z: 2*tip.x"), OF_TASK, "one of its functions follows from the others"),
        (CAR, "configuration_from_task", "the task leaves 2 directions open"),
    ],
    ids=["a function twice", "wheels"],
)
def test_what_has_no_least_motion_is_said(
    text: str, names: str, why: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--only", "python", "--no-verify", "--out", str(tmp_path)]) == 0
    printed = " ".join(capsys.readouterr().err.split())
    for name in names.split(", "):
        assert f"{name} is not generated" in printed
    assert why in printed


@pytest.mark.parametrize("text", [ARM, DEPENDENT], ids=["arm", "dependent rows"])
@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.toolchain
def test_least_motions_are_verified(text: str, tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--quiet", "--out", str(tmp_path), "--outputs", OF_TASK.replace(" ", "")]) == 0
