"""What encoders determine: against formulas by hand, laws, and moves that are followed by other means."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from numpy.typing import NDArray

from symgen.backends.about import statuses_of
from symgen.cli.main import main
from symgen.diagnostics import ModelError
from symgen.ir.kernel import Status
from symgen.model.load import load_text

Array = NDArray[np.float64]
MODELS = Path(__file__).resolve().parents[2] / "models"
L1, L2, L3, L0 = 0.3, 0.8, 0.6, 0.9
# A crank that turns all the way, a coupler and a rocker.
LINKAGE = f"""
model: linkage
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}}}
kinetic_energy: (a_dot**2 + 2*b_dot**2 + 3*c_dot**2)/2
constraints:
  geometric:
    close_x: {L1}*cos(a) + {L2}*cos(b) - {L0} - {L3}*cos(c)
    close_y: {L1}*sin(a) + {L2}*sin(b) - {L3}*sin(c)
inputs: {{u: {{acts_on: {{a: 1}}}}}}
measured: MEASURED
configuration: {{a: 0.5, b: 0.6, c: 1.6}}
outputs: [configuration_from_measured, velocity_from_measured, acceleration_from_measured]
"""
# A slide on an arm, a link on it, and a rod that all but crosses the arm; a screw that nothing moves is measured too.
CROSSED = """
model: crossed
coordinates: {a: {}, s: {}, c: {}, w: {}}
kinetic_energy: (a_dot**2 + s_dot**2 + c_dot**2 + w_dot**2)/2
constraints:
  geometric:
    rod: (-0.7445 - (s + 0.18)*cos(a) - 0.6*cos(c))**2 + (-0.6614 - (s + 0.18)*sin(a) - 0.6*sin(c))**2 - 0.47836**2
    screw: w - 0.5
inputs: {u: {acts_on: {a: 1}}}
measured: [a, c, w]
configuration: {a: 2.65142, s: 0.58383, c: -1.35493, w: 0.5}
outputs: [configuration_from_measured]
"""
CAR = """
model: car
coordinates: {x: {}, y: {}, theta: {unit: rad}, phi: {unit: rad}}
kinetic_energy: (x_dot**2 + y_dot**2 + theta_dot**2 + phi_dot**2)/2
constraints:
  nonholonomic:
    rear: sin(theta)*x_dot - cos(theta)*y_dot
    front: sin(theta + phi)*x_dot - cos(theta + phi)*y_dot - 2*cos(phi)*theta_dot
inputs: {force: {acts_on: {x: cos(theta), y: sin(theta)}}, steering: {acts_on: {phi: 1}}}
measured: MEASURED
outputs: [velocity_from_measured, configuration_from_measured]
"""


def kernels(text: str, folder: Path) -> ModuleType:
    """The generated Python of a model."""
    path = folder / "model.yaml"
    path.write_text(text, encoding="utf-8")
    name = load_text(text, "model.yaml").name
    assert main([str(path), "--only", "python", "--no-verify", "--quiet", "--out", str(folder)]) == 0
    spec = importlib.util.spec_from_file_location(f"{name}_measured", folder / name / "python" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[module.__name__] = module
    spec.loader.exec_module(module)
    return module


def linkage(measured: str) -> str:
    return LINKAGE.replace("MEASURED", measured)


def shipped_with(name: str, measured: str, outputs: str) -> str:
    """A shipped model that measures, with other outputs."""
    text = (MODELS / f"{name}.yaml").read_text(encoding="utf-8")
    text = re.sub(r"^(outputs|measured):.*\n(  .*\n)*", "", text, flags=re.MULTILINE)
    return f"{text}\nmeasured: {measured}\noutputs: {outputs}\n"


def closed_by_hand(crank: Array, side: float = 1.0) -> Array:
    """Both angles of coupler and rocker: where two circles meet, on one side of the line between their centres."""
    reach = np.stack((L0 - L1 * np.cos(crank), -L1 * np.sin(crank)), axis=-1)
    length = np.linalg.norm(reach, axis=-1)
    bend = np.arccos((length**2 + L2**2 - L3**2) / (2 * length * L2))
    b = np.arctan2(reach[..., 1], reach[..., 0]) + side * bend
    tip = np.stack((L1 * np.cos(crank) + L2 * np.cos(b) - L0, L1 * np.sin(crank) + L2 * np.sin(b)), axis=-1)
    return np.stack((crank, b, np.arctan2(tip[..., 1], tip[..., 0])), axis=-1)


def turned_to(q: Array, near: Array) -> Array:
    """The same angles, less than half a turn from others."""
    return near + (q - near + np.pi) % (2 * np.pi) - np.pi


def test_a_linkage_is_where_it_is_by_hand_or_refused_with_the_output_untouched(tmp_path: Path) -> None:
    module, random = kernels(linkage("[a]"), tmp_path), np.random.default_rng(1)
    before = random.uniform(-np.pi, np.pi, 4000)
    moved = before + 10.0 ** random.uniform(-4, 0.5, 4000) * random.choice((-1, 1), 4000)
    for side in (1.0, -1.0):
        near = closed_by_hand(before, side)
        configurations = module.configuration_from_measured(moved[:, None], near)
        kept = np.isfinite(configurations).all(axis=1)
        off = np.abs(turned_to(closed_by_hand(moved, side), configurations) - configurations)
        assert off[kept].max() < 1e-13
        # the crank turns all the way: no move is too far
        assert kept.all()
    # the rocker does not: beyond its dead centres there is nothing
    rocker = closed_by_hand(before)[:, 2:] + (moved - before)[random.permutation(4000), None]
    (tmp_path / "rocker").mkdir()
    other = kernels(linkage("[c]"), tmp_path / "rocker")
    configurations = other.configuration_from_measured(rocker, closed_by_hand(before))
    kept = np.isfinite(configurations).all(axis=1)
    tip = L0 + L3 * np.exp(1j * rocker[:, 0])
    reach = (np.abs(tip) <= L1 + L2) & (np.abs(tip) >= L2 - L1)
    assert not kept[~reach].any()
    assert np.isin(True, kept)
    assert kept[np.abs(rocker[:, 0] - closed_by_hand(before)[:, 2]) < 1e-3].mean() > 0.9
    closes = configurations[kept]
    gap = L1 * np.exp(1j * closes[:, 0]) + L2 * np.exp(1j * closes[:, 1]) - L0 - L3 * np.exp(1j * closes[:, 2])
    assert np.abs(gap).max() < 2e-15
    # on the side of the start: crank and coupler bend the same way
    assert (np.sin(closes[:, 1] - closes[:, 0]) * np.sin(np.diff(closed_by_hand(before)[kept, :2])[:, 0]) > 0).all()


def test_rates_and_accelerations_are_those_of_the_motion(tmp_path: Path) -> None:
    module, crank, rate, push = kernels(linkage("[a]"), tmp_path), 0.7, 1.3, -0.4

    def at(t: float) -> Array:
        return closed_by_hand(np.array(crank + rate * t + push * t**2 / 2))

    step = 1e-3
    # differences of fourth order
    slopes = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step)
    bends = (16 * (at(step) + at(-step)) - (at(2 * step) + at(-2 * step)) - 30 * at(0)) / (12 * step**2)
    velocity = module.velocity_from_measured(at(0), [rate])
    assert np.allclose(velocity, slopes, atol=1e-11, rtol=0)
    acceleration = module.acceleration_from_measured(at(0), [rate], [push])
    assert np.allclose(acceleration, bends, atol=1e-8, rtol=0)


@pytest.mark.parametrize(
    ("measured", "share"), [("[c, a]", 1), ("{c: 2e-4, a: 5e-4}", 2.5), ("{c: 3e-3, a: 1e-4}", 1 / 30)]
)
def test_of_too_many_encoders_the_nearest_configuration_is_taken(measured: str, share: float, tmp_path: Path) -> None:
    """An encoder that is off by a `share` of the other's error counts as many times more, squared."""
    module = kernels(linkage(measured), tmp_path)
    near = closed_by_hand(np.array(0.6))
    readings = near[[2, 0]] + [0.02, -0.03]
    configuration = module.configuration_from_measured(readings, near)
    assert np.abs(configuration - closed_by_hand(configuration[0])).max() < 1e-14

    def away(crank: Any) -> Any:
        """What `closed_by_hand` has, at fifty digits."""
        x, y = L0 - L1 * mp.cos(crank), -L1 * mp.sin(crank)
        length = mp.hypot(x, y)
        b = mp.atan2(y, x) + mp.acos((length**2 + L2**2 - L3**2) / (2 * length * L2))
        c = mp.atan2(L1 * mp.sin(crank) + L2 * mp.sin(b), L1 * mp.cos(crank) + L2 * mp.cos(b) - L0)
        return (share * (c - readings[0])) ** 2 + (crank - readings[1]) ** 2

    # the slope of the distance along the motion vanishes
    with mp.workdps(50):
        slope, bend = mp.diff(away, configuration[0]), mp.diff(away, configuration[0], 2)
    assert bend > 0
    assert abs(slope / bend) < 1e-14
    assert away(configuration[0]) < away(near[0])


@pytest.mark.parametrize(
    ("measured", "message"),
    [
        ("{c: 0, a: 1}", "the standard deviation of `c` is not positive"),
        ("{c: 1e-4, d: 1e-4}", "`d` in `measured` is no coordinate"),
        ("{c: 1e-4, a: b}", "the standard deviation of `a`"),
    ],
)
def test_mistakes_of_standard_deviations_are_told(measured: str, message: str) -> None:
    with pytest.raises(ModelError, match=re.escape(message)):
        load_text(linkage(measured), "linkage.yaml")


@pytest.mark.campaign
@pytest.mark.toolchain
def test_weighed_kernels_pass_verification(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("gcc")
    path = tmp_path / "model.yaml"
    path.write_text(linkage("{c: 2e-4, a: 5e-4}"), encoding="utf-8")
    assert main([str(path), "--only", "c,python", "--states", "8", "--quiet", "--out", str(tmp_path)]) == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "measured"),
    [("delta", "[a_1, a_2, a_3]"), pytest.param("rapkm_2rrr_rr", "[a_1, a_2]", marks=pytest.mark.campaign)],
)
def test_no_move_ends_on_another_branch(name: str, measured: str, tmp_path: Path) -> None:
    outputs = "[configuration_from_measured, constraint_residual, constraint_jacobian]"
    text = shipped_with(name, measured, outputs)
    module, model, random = kernels(text, tmp_path), load_text(text, "model.yaml"), np.random.default_rng(2)
    held = list(model.measured_places)
    free = [k for k in range(model.n) if k not in held]
    assert model.assembly is not None
    places = np.array([place.q for place in model.assembly.places])
    start = places[random.integers(len(places), size=2000)]
    direction = random.normal(size=(len(start), len(held)))
    direction *= (10.0 ** random.uniform(-3, 0.3, len(start)) / np.linalg.norm(direction, axis=1))[:, None]

    # followed in small steps, each well inside of where Newton's method leads back
    place, lost, steps = start.copy(), np.zeros(len(start), dtype=bool), 200
    side = None
    for _ in range(steps):
        place[:, held] += direction / steps
        for _ in range(3):
            rows = module.constraint_jacobian(place)[:, :, free]
            sign = np.sign(np.linalg.det(rows))
            side = sign if side is None else side
            step = np.linalg.solve(rows, module.constraint_residual(place)[..., None])[..., 0]
            lost |= (sign != side) | (np.abs(step).max(axis=1) > 0.2)
            place[:, free] -= np.where(lost[:, None], 0.0, step)
    for _ in range(3):  # beside a singularity it takes more of them to reach the last digits
        rows, left = module.constraint_jacobian(place)[:, :, free], module.constraint_residual(place)
        place[:, free] -= np.where(lost[:, None], 0.0, np.linalg.solve(rows, left[..., None])[..., 0])
    configurations = module.configuration_from_measured(place[:, held], start)
    kept = np.isfinite(configurations).all(axis=1)
    followed = ~lost & kept
    assert np.abs(configurations - place)[followed].max() < 1e-9
    assert followed.sum() > 0.6 * len(start)
    back = kept & lost
    if name == "delta":
        # by Newton's method: what leads through a singularity is refused
        assert back.sum() == 0
    # in closed form: what comes back from beyond one is in the mode of the start, told by each loop's own determinant
    for k in (1, 2):
        loop = np.ix_(np.flatnonzero(back), range(2 * k - 2, 2 * k), [free.index(3), free.index(3 + k)])
        pairs = (module.constraint_jacobian(q)[:, :, free] for q in (start, configurations))
        first, second = (np.linalg.det(rows[loop]) for rows in pairs)
        assert (first * second > 0).all()


def test_a_move_towards_a_singularity_is_followed_as_far_with_one_encoder_more(tmp_path: Path) -> None:
    # what is still to be moved at the start must not bend the first step: it says nothing of what is left at the end
    module = kernels(CROSSED, tmp_path)
    text = CROSSED.replace("[a, c, w]", "[a, c]").replace("crossed", "enough")
    (tmp_path / "enough").mkdir()
    enough = kernels(text, tmp_path / "enough")
    start = module.configuration_from_measured([2.65142, -1.35493, 0.5], [2.65142, 0.58383, -1.35493, 0.5])
    for share in np.linspace(0.2, 1, 5):
        a, c = start[[0, 2]] + 0.007 * share
        place = module.configuration_from_measured([a, c, 0.5003], start)
        assert place[:3] == pytest.approx(enough.configuration_from_measured([a, c], start)[:3], abs=1e-9)


def test_a_rank_that_drops_has_its_own_status(tmp_path: Path) -> None:
    module = kernels(linkage("[c]"), tmp_path)
    # crank and coupler in line: the rocker turns back there
    q = np.array([0.0, 0.0, 0.0])
    q[2] = np.arccos((L0**2 + L3**2 - (L1 + L2) ** 2) / (2 * L0 * L3))
    q[2] = np.pi - q[2]
    tip = L0 + L3 * np.exp(1j * q[2])
    q[0] = q[1] = np.angle(tip)
    with pytest.raises(module.StateError) as caught:
        module.velocity_from_measured(q, [1.0])
    assert caught.value.status.name == Status.MEASURED_RANK.name


def test_a_car_is_led_by_rates_and_its_place_is_not_found(tmp_path: Path) -> None:
    module = kernels(CAR.replace("MEASURED", "[x, phi]"), tmp_path)
    theta, phi, speed = 0.4, 0.3, 2.0
    q = [1.0, 2.0, theta, phi]
    rates = module.velocity_from_measured(q, [speed * np.cos(theta), 0.1])
    assert np.allclose(rates, [speed * np.cos(theta), speed * np.sin(theta), speed * np.tan(phi) / 2, 0.1])
    assert not hasattr(module, "configuration_from_measured")


def test_statuses_of_measuring_stand_in_models_that_measure_alone() -> None:
    assert Status.BRANCH in statuses_of(load_text(linkage("[a]"), "linkage.yaml"))
    without = linkage("[a]").replace("measured: [a]\n", "").replace("[configuration_from", "[inverse_dynamics] # ")
    assert statuses_of(load_text(without, "linkage.yaml"))[-1] is Status.PARAMETER_RANGE


def test_a_name_of_the_model_is_none_of_a_measured_value(tmp_path: Path) -> None:
    taken = "parameters: {a_measured: {value: 2}}\nkinetic_energy: a_measured*("
    text = linkage("[a]").replace("kinetic_energy: (", taken)
    module = kernels(text, tmp_path)
    near = closed_by_hand(np.array(0.6))
    assert np.allclose(module.configuration_from_measured([0.61], near), closed_by_hand(np.array(0.61)), atol=1e-14)
