"""What a planned task determines: against formulas by hand, laws, and moves that are followed by other means."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from symgen.backends.about import statuses_of
from symgen.cli.main import main
from symgen.diagnostics import ModelError
from symgen.ir.kernel import Status
from symgen.model.load import load_text
from tests.methods.test_measured import kernels, turned_to

Array = NDArray[np.float64]
ALL = "outputs: [task_position, task_velocity, task_jacobian, configuration_from_task, velocity_from_task,"
ALL += " acceleration_from_task]"
L1, L2 = 0.7, 0.4
ARM = f"""
model: arm
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}}}
parameters: {{l_1: {{value: {L1}}}, l_2: {{value: {L2}}}}}
kinetic_energy: (a_dot**2 + b_dot**2)/2
inputs: {{u: {{acts_on: {{a: 1}}}}, v: {{acts_on: {{b: 1}}}}}}
task: {{x: l_1*cos(a) + l_2*cos(a + b), y: l_1*sin(a) + l_2*sin(a + b)}}
configuration: {{a: 0.3, b: 0.8}}
{ALL}
"""
WIDTH, NEAR, FAR = 0.3, 0.2, 0.3
FIVE_BAR = f"""
model: five_bar
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}, e: {{unit: rad}}}}
kinetic_energy: (a_dot**2 + 2*b_dot**2 + c_dot**2 + 2*e_dot**2)/2
constraints:
  geometric:
    close_x: {NEAR}*cos(a) + {FAR}*cos(b) - {WIDTH} - {NEAR}*cos(c) - {FAR}*cos(e)
    close_y: {NEAR}*sin(a) + {FAR}*sin(b) - {NEAR}*sin(c) - {FAR}*sin(e)
inputs: {{u: {{acts_on: {{a: 1}}}}, v: {{acts_on: {{c: 1}}}}}}
task: {{x: {NEAR}*cos(a) + {FAR}*cos(b), y: {NEAR}*sin(a) + {FAR}*sin(b)}}
configuration: {{a: 2.2, b: 0.9, c: 1, e: 2.2}}
{ALL}
"""


def place(q: Array) -> Array:
    """The tip of the arm."""
    a, b = q[..., 0], q[..., 0] + q[..., 1]
    return np.stack((L1 * np.cos(a) + L2 * np.cos(b), L1 * np.sin(a) + L2 * np.sin(b)), axis=-1)


def bent(x: Array, first: float, second: float, side: float) -> tuple[Array, Array]:
    """The angles of two links, from the x axis, that reach a place."""
    length = np.linalg.norm(x, axis=-1)
    with np.errstate(invalid="ignore"):
        turn = np.arccos((length**2 + first**2 - second**2) / (2 * length * first))
    a = np.arctan2(x[..., 1], x[..., 0]) - side * turn
    rest = x - first * np.stack((np.cos(a), np.sin(a)), axis=-1)
    return a, np.arctan2(rest[..., 1], rest[..., 0])


def legs(x: Array) -> Array:
    """The angles of the five-bar with its tip at a place, elbows outwards."""
    a, b = bent(x, NEAR, FAR, -1.0)
    c, e = bent(x - np.array([WIDTH, 0.0]), NEAR, FAR, 1.0)
    return np.stack((a, b, c, e), axis=-1)


def differences(at: tuple[Array, ...], step: float) -> tuple[Array, Array]:
    """First and second derivatives of fourth order, of five values a step apart."""
    two_back, back, here, on, two_on = at
    slope = (8 * (on - back) - (two_on - two_back)) / (12 * step)
    bend = (16 * (on + back) - (two_on + two_back) - 30 * here) / (12 * step**2)
    return slope, bend


def test_an_arm_reaches_a_place_as_by_hand_or_refuses_with_the_output_untouched(tmp_path: Path) -> None:
    module, random = kernels(ARM, tmp_path), np.random.default_rng(1)
    before = np.stack((random.uniform(-3, 3, 4000), random.choice((-1, 1), 4000) * random.uniform(0.3, 2.8, 4000)), 1)
    moved = place(before) + 10.0 ** random.uniform(-4, 0, (4000, 1)) * random.normal(size=(4000, 2))
    configurations = module.configuration_from_task(moved, before)
    kept = np.isfinite(configurations).all(axis=1)
    reach = np.linalg.norm(moved, axis=1)
    assert not kept[(reach > L1 + L2) | (reach < L1 - L2)].any()
    for side in (1.0, -1.0):
        these = kept & (before[:, 1] * side > 0)
        a, end = bent(moved[these], L1, L2, side)
        exact = turned_to(np.stack((a, end - a), axis=1), configurations[these])
        # beside a stretched pose a place leaves angles open by the root of what it is rounded by
        assert np.abs(exact - configurations[these]).max() < 1e-12
    assert kept[np.linalg.norm(moved - place(before), axis=1) < 0.01].all()
    assert 0.3 < kept.mean() < 0.95


def test_position_velocity_and_jacobian_are_those_of_the_arm(tmp_path: Path) -> None:
    module = kernels(ARM, tmp_path)
    q, rate, step = np.array([0.4, -1.1]), np.array([0.7, 0.3]), 1e-3
    slope, _ = differences(tuple(place(q + k * step * rate) for k in range(-2, 3)), step)
    assert np.allclose(module.task_position(q), place(q), atol=1e-16, rtol=0)
    assert np.allclose(module.task_velocity(q, rate), slope, atol=1e-11, rtol=0)
    assert np.allclose(module.task_jacobian(q) @ rate, slope, atol=1e-11, rtol=0)


@pytest.mark.campaign
@pytest.mark.parametrize("text", [ARM, FIVE_BAR], ids=["arm", "five-bar"])
def test_rates_and_accelerations_are_those_of_the_motion(text: str, tmp_path: Path) -> None:
    module = kernels(text, tmp_path)
    x, v, w, step = np.array([0.2, 0.38]), np.array([0.1, -0.3]), np.array([0.7, 0.2]), 1e-3

    def at(t: float) -> Array:
        aim = x + v * t + w * t**2 / 2
        if text is FIVE_BAR:
            return legs(aim)
        a, end = bent(aim, L1, L2, 1.0)
        return np.stack((a, end - a))

    slope, bend = differences(tuple(at(k * step) for k in range(-2, 3)), step)
    assert np.allclose(module.velocity_from_task(at(0.0), v), slope, atol=1e-10, rtol=0)
    assert np.allclose(module.acceleration_from_task(at(0.0), v, w), bend, atol=1e-7, rtol=0)


@pytest.mark.parametrize("hand", ["c", "a + b + c"], ids=["absolute", "relative"])
def test_rates_that_are_given_themselves_turn_the_others(hand: str, tmp_path: Path) -> None:
    """A hand whose angle is given, as a coordinate or as a sum of three: what it moves the tip by is taken off."""
    links = ("a", "b", "c") if hand == "c" else ("a", "a + b", "a + b + c")
    x, y = (f"{L1}*{f}({links[0]}) + {L2}*{f}({links[1]}) + 0.2*{f}({links[2]})" for f in ("cos", "sin"))
    text = f"""
model: hand
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2)/2
inputs: {{u: {{acts_on: {{a: 1}}}}}}
task: {{x: {x}, y: {y}, turn: {hand}}}
configuration: {{a: 0.3, b: 0.8, c: 0.5}}
{ALL}
"""
    module = kernels(text, tmp_path)
    aim, v, w = np.array([0.3, 0.5, 0.7]), np.array([0.1, -0.3, 1.2]), np.array([0.7, 0.2, -0.8])

    def at(t: float) -> Array:
        now = aim + v * t + w * t**2 / 2
        wrist = now[:2] - 0.2 * np.array([np.cos(now[2]), np.sin(now[2])])
        a, b = bent(wrist, L1, L2, 1.0)
        return np.array([a, b, now[2]]) if hand == "c" else np.array([a, b - a, now[2] - b])

    step = 1e-3
    slope, bend = differences(tuple(at(k * step) for k in range(-2, 3)), step)
    assert np.allclose(module.velocity_from_task(at(0.0), v), slope, atol=1e-10, rtol=0)
    assert np.allclose(module.acceleration_from_task(at(0.0), v, w), bend, atol=1e-7, rtol=0)
    assert np.allclose(module.configuration_from_task(aim, at(-0.05)), at(0.0), atol=1e-14, rtol=0)


def test_unknowns_that_others_wait_for_are_solved_before_them(tmp_path: Path) -> None:
    """A third joint that is told together with both of the others."""
    text = ARM.replace("rad}}", "rad}, c: {unit: rad}}").replace("b_dot**2)", "b_dot**2 + c_dot**2)")
    text = text.replace("l_2*sin(a + b)}", "l_2*sin(a + b), z: sin(a)*sin(b) + 2*sin(c)}")
    text = text.replace("b: 0.8}", "b: 0.8, c: 0}")
    module, near = kernels(text, tmp_path), np.array([0.4, -1.1, 0.3])
    q = near + np.array([0.2, 0.15, -0.1])
    assert "sqrt" in (tmp_path / "arm" / "python" / "arm.py").read_text(encoding="utf-8")
    assert np.allclose(module.configuration_from_task(module.task_position(q), near), q, atol=1e-14, rtol=0)


def test_rows_that_become_numbers_keep_what_they_change_by(tmp_path: Path) -> None:
    """The end of a crank in coordinates of its own: with the angle given, its rows hold nothing but numbers."""
    text = f"""
model: crank
coordinates: {{x: {{}}, y: {{}}, a: {{unit: rad}}}}
kinetic_energy: (x_dot**2 + y_dot**2 + a_dot**2)/2
constraints: {{geometric: {{across: x - {L1}*cos(a), up: y - {L1}*sin(a)}}}}
inputs: {{u: {{acts_on: {{a: 1}}}}}}
task: {{turn: a}}
configuration: {{x: {L1}, y: 0, a: 0}}
{ALL}
"""
    module, q = kernels(text, tmp_path), np.array([L1 * np.cos(0.7), L1 * np.sin(0.7), 0.7])
    out, across = np.array([np.cos(0.7), np.sin(0.7)]), np.array([-np.sin(0.7), np.cos(0.7)])
    accelerations = module.acceleration_from_task(q, [1.3], [-0.4])
    assert np.allclose(accelerations[:2], L1 * (-0.4 * across - 1.3**2 * out), atol=1e-15, rtol=0)
    assert np.allclose(module.velocity_from_task(q, [1.3]), [*(1.3 * L1 * across), 1.3], atol=1e-15, rtol=0)


def test_a_five_bar_is_where_two_circles_meet(tmp_path: Path) -> None:
    module, random = kernels(FIVE_BAR, tmp_path), np.random.default_rng(2)
    x = np.stack((random.uniform(0.0, 0.3, 500), random.uniform(0.3, 0.42, 500)), axis=1)
    x = x[np.isfinite(legs(x)).all(axis=1)]
    moved = x + 1e-3 * random.normal(size=x.shape)
    wanted = legs(moved)
    configurations = module.configuration_from_task(moved, legs(x))
    kept = np.isfinite(configurations).all(axis=1)
    assert kept.mean() > 0.97
    assert np.abs(turned_to(wanted, configurations) - configurations)[kept].max() < 1e-12


@pytest.mark.parametrize("over", [1.0, -1.0])
def test_an_arm_on_a_column_keeps_its_sides(over: float, tmp_path: Path) -> None:
    """A hand kept level by a row of numbers; reaching out before the column and over its back, elbow up and down."""
    text = f"""
model: column
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}, d: {{unit: rad}}}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2)/2
constraints: {{geometric: {{level: b + c + d}}}}
definitions: {{reach: {L1}*cos(b) + {L2}*cos(b + c) + 0.1*cos(b + c + d)}}
inputs: {{u: {{acts_on: {{a: 1}}}}}}
task: {{x: reach*cos(a), y: reach*sin(a), z: {L1}*sin(b) + {L2}*sin(b + c) + 0.1*sin(b + c + d)}}
configuration: {{a: 0.3, b: 0.8, c: 0.5, d: -1.3}}
{ALL}
"""
    module, random = kernels(text, tmp_path), np.random.default_rng(4)
    a, b = random.uniform(-3, 3, 3000), random.uniform(0.2, 1.2, 3000)
    c = random.choice((-1, 1), 3000) * random.uniform(0.3, 1.0, 3000)
    if over < 0:
        b = np.pi - b
    before = np.stack((a, b, c, -b - c), axis=1)
    moved = before.copy()
    moved[:, :3] += 10.0 ** random.uniform(-4, -1, (3000, 1)) * random.normal(size=(3000, 3))
    moved[:, 3] = -moved[:, 1] - moved[:, 2]
    aim = module.task_position(moved)
    configurations = module.configuration_from_task(aim, before)
    kept = np.isfinite(configurations).all(axis=1)
    same = (np.sin(moved[:, 2]) * np.sin(c) > 0) & (np.abs(moved - before).max(axis=1) < 0.5)
    reach = [L1 * np.cos(q[:, 1]) + L2 * np.cos(q[:, 1] + q[:, 2]) + 0.1 for q in (before, moved)]
    same &= (reach[0] * reach[1] > 0) & (np.abs(reach).min(axis=0) > 1e-3)
    assert same.mean() > 0.9
    assert kept[same].mean() > 0.99
    assert np.abs(configurations - moved)[kept & same].max() < 1e-9
    assert np.median(np.abs(configurations - moved)[kept & same].max(axis=1)) < 1e-15


def test_of_too_many_coordinates_the_nearest_configuration_is_taken(tmp_path: Path) -> None:
    text = ARM.replace("l_1*sin(a) + l_2*sin(a + b)}", "l_1*sin(a) + l_2*sin(a + b), turn: a + b/2}")
    module, q = kernels(text, tmp_path), np.array([0.5, 0.9])
    consistent = np.array([*place(q + 0.01), q[0] + 0.01 + (q[1] + 0.01) / 2])
    assert np.allclose(module.configuration_from_task(consistent, q), q + 0.01, atol=1e-14, rtol=0)
    aim = consistent + np.array([0.02, -0.01, 0.03])
    configuration = module.configuration_from_task(aim, q)
    left = module.task_position(configuration) - aim
    slopes = module.task_jacobian(configuration)
    assert np.linalg.norm(left) > 1e-3
    assert np.abs(slopes.T @ left).max() < 1e-15
    rates = np.array([0.3, -0.2, 0.5])
    least = np.linalg.lstsq(slopes, rates, rcond=None)[0]
    assert np.allclose(module.velocity_from_task(configuration, rates), least, atol=1e-14, rtol=0)


def test_what_a_task_leaves_open_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = ARM.replace("rad}}", "rad}, c: {unit: rad}}").replace("b_dot**2)", "b_dot**2 + c_dot**2)")
    path = tmp_path / "arm.yaml"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--only", "python", "--no-verify", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().err
    for name in ("configuration_from_task", "velocity_from_task", "acceleration_from_task"):
        assert name in printed
    open_ = "the task leaves 1 direction open"
    norm = "in the Euclidean norm of the coordinates as they stand"
    assert f"{open_}; of all motions the least is taken, {norm}" in " ".join(printed.split())
    made = " ".join((tmp_path / "arm" / "python" / "arm.py").read_text(encoding="utf-8").split())
    assert "TASK_RANK = 10 # the task loses rank at this configuration" in made
    assert f"{open_}: of all such rates the least, {norm}" in made
    assert f"{open_}: those of the motion that has the least rates, {norm}; not the least themselves" in made
    assert f"{open_}: reached from q by steps that are the least each, {norm}" in made


@pytest.mark.parametrize(("least", "code"), [("1", 1), ("0.01", 0)])
def test_a_task_has_values_where_its_function_has(
    least: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A root of what is never positive where the rows hold is a mistake; one of what is now and then is not."""
    text = f"""
model: bars
coordinates: {{a: {{unit: rad, range: [-0.4, 0.4]}}, b: {{unit: rad, range: [-0.4, 0.4]}}}}
kinetic_energy: (a_dot**2 + b_dot**2)/2
constraints: {{geometric: {{alike: a - b}}}}
inputs: {{u: {{acts_on: {{a: 1}}}}}}
task: {{x: sqrt(a - b + 0.2*a - {least})}}
outputs: [velocity_from_task]
"""
    path = tmp_path / "bars.yaml"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--only", "python", "--no-verify", "--out", str(tmp_path)]) == code
    assert ("`x` of the task has no finite value" in capsys.readouterr().err) is bool(code)


def test_a_coordinate_of_the_task_that_is_one_of_the_model_is_taken_as_it_is(tmp_path: Path) -> None:
    """The third link of an arm is told its angle, the others a place; the names clash with those of the model."""
    text = ARM.replace("rad}}", "rad}, x: {unit: rad}}").replace("b_dot**2)", "b_dot**2 + x_dot**2)")
    text = text.replace("task: {x: ", "task: {l_1: x, x: ").replace("b: 0.8}", "b: 0.8, x: 0.2}")
    module, q = kernels(text, tmp_path), np.array([0.5, 0.9, -0.3])
    configuration = module.configuration_from_task([0.11, *place(q[:2] + 0.02)], q)
    assert configuration[2] == 0.11
    assert np.allclose(configuration[:2], q[:2] + 0.02, atol=1e-14, rtol=0)


def test_a_car_is_led_by_a_point_ahead_and_its_place_is_not_found(tmp_path: Path) -> None:
    text = """
model: car
coordinates: {x: {}, y: {}, theta: {unit: rad}}
parameters: {ahead: {value: 0.8}}
kinetic_energy: (x_dot**2 + y_dot**2 + theta_dot**2)/2
constraints: {nonholonomic: {rear: sin(theta)*x_dot - cos(theta)*y_dot}}
inputs: {force: {acts_on: {x: cos(theta), y: sin(theta)}}, turn: {acts_on: {theta: 1}}}
task: {nose_x: x + ahead*cos(theta), nose_y: y + ahead*sin(theta)}
"""
    module = kernels(text + ALL, tmp_path)
    v, theta = np.array([0.3, 0.7]), 0.4
    along = np.array([np.cos(theta), np.sin(theta)])
    expected = [*(v @ along * along), (along[0] * v[1] - along[1] * v[0]) / 0.8]
    assert np.allclose(module.velocity_from_task([1.0, 2.0, theta], v), expected, atol=1e-15, rtol=0)
    assert not hasattr(module, "configuration_from_task")


def test_ranks_that_drop_have_a_status_of_their_own(tmp_path: Path) -> None:
    module = kernels(ARM, tmp_path)
    stretched = np.array([0.3, 0.0])
    for call in (
        lambda: module.velocity_from_task(stretched, [0.1, 0.2]),
        lambda: module.configuration_from_task(place(stretched) * 0.99, stretched),
    ):
        with pytest.raises(module.StateError) as caught:
            call()
        assert caught.value.status.name == Status.TASK_RANK.name


def test_statuses_of_a_task_stand_in_models_that_have_one_alone() -> None:
    of_task = {Status.TASK_RANK, Status.NOT_CLOSED, Status.BRANCH}
    assert of_task <= set(statuses_of(load_text(ARM, "arm.yaml")))
    plain = load_text("\n".join(line for line in ARM.splitlines() if "task" not in line), "arm.yaml")
    assert not of_task & set(statuses_of(plain))


@pytest.mark.parametrize(
    ("task", "message"),
    [
        ("{x: l_1 + 2}", "`x` of the task does not move"),
        ("{x: a_dot}", "`a_dot` is a rate"),
        ("{x: a + d}", "unknown name `d`"),
        ("{x y: a}", "`x y` is no name for a coordinate of the task"),
        ("[a, b]", "task"),
    ],
)
def test_mistakes_are_told(task: str, message: str) -> None:
    text = "\n".join(f"task: {task}" if line.startswith("task:") else line for line in ARM.splitlines())
    with pytest.raises(ModelError) as caught:
        load_text(text, "arm.yaml")
    assert message in str(caught.value)
