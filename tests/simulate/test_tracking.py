"""`symgen simulate --track`: errors that closed loops have by theory, encoders, limits, delays, names."""

from __future__ import annotations

import csv
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from linkages import CART

from symgen.cli.main import main
from symgen.generation.results import Options
from symgen.simulate import simulation
from symgen.verify.running import compile as compiling

# A mass on a slide that is to be accelerated evenly: with another mass than the controller knows, it lags behind by
# (m' / m - 1) a / w^2 once the transient is over, less a T / w as rates are known from half a sample before.
SLIDE = """
model: slide
coordinates: {x: {unit: m}}
parameters: {m: {value: 2, unit: kg, range: [1, 4]}}
kinetic_energy: m/2*x_dot**2
inputs: {f: {unit: N, acts_on: {x: 1}}}
paths:
  even: {duration: 1, conditions: {along: x - 3*t**2/2}}
  swing: {duration: 1, conditions: {along: "x - sin(8*t)/10"}}
"""
LATE = 3 * 1e-3
# A pendulum on a cart that is to stay where it is, above.
UPRIGHT = f"{CART}paths: {{upright: {{duration: 4, conditions: {{still: x, above: a}}}}}}\n"
# A rod whose ends slide along two walls, driven at one of them, measured there; a path that it can follow.
LADDER = """
model: ladder
coordinates: {a: {unit: rad, range: [0.3, 1.2]}, x: {unit: m, range: [0.1, 1]}, y: {unit: m, range: [0.1, 1]}}
parameters: {m: {value: 2}, J: {value: 0.1}, l: {value: 1}}
kinetic_energy: m/8*(x_dot**2 + y_dot**2) + J/2*a_dot**2
constraints: {geometric: {across: x - l*cos(a), up: y - l*sin(a)}}
inputs: {f: {unit: N, acts_on: {x: 1}}}
configuration: {a: 0.8, x: 0.7, y: 0.7}
measured: [x]
paths:
  slide: {duration: 1, conditions: {along: "x - 0.7 - 0.15*sin(pi*t)**2"}}
"""


@pytest.fixture
def run(tmp_path: Path, tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Tracks a path of a model in a file, verified at few states and compiled as it stands."""
    tool("gcc")
    monkeypatch.setattr(compiling, "FLAGS", (*compiling.FLAGS, *compiling.PLAIN))
    monkeypatch.setattr(simulation, "Options", partial(Options, states=8))

    def track(text: str, path: str, *options: str) -> int:
        (tmp_path / "model.yaml").write_text(text, encoding="utf-8")
        return main(["simulate", str(tmp_path / "model.yaml"), "--track", path, "--out", str(tmp_path), *options])

    return track


def rows(folder: Path, model: str) -> list[dict[str, float]]:
    with (folder / model / "tracking.csv").open(encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def error(folder: Path, model: str, name: str) -> float:
    return max(abs(row[f"{name}_planned"] - row[name]) for row in rows(folder, model))


@pytest.mark.campaign
def test_computed_torque_follows_and_another_mass_lags_by_what_theory_says(
    run: Callable[..., int], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(SLIDE, "even") == 0
    assert error(tmp_path, "slide", "x") == pytest.approx(LATE / 30, rel=0.01)
    assert "error in m " in capsys.readouterr().out
    assert run(SLIDE, "even", "--machine", "m=2.4", "--bandwidth", "40", "--quiet") == 0
    last = rows(tmp_path, "slide")[-1]
    assert last["x_planned"] - last["x"] == pytest.approx(0.2 * 3 / 40**2 - LATE / 40, rel=0.01)
    assert last["f"] == pytest.approx(2.4 * 3, rel=0.02)
    assert (tmp_path / "slide/tracking.svg").stat().st_size > 1000


@pytest.mark.campaign
def test_a_delay_and_coarse_encoders_make_it_worse(run: Callable[..., int], tmp_path: Path) -> None:
    assert run(SLIDE, "swing", "--quiet") == 0
    fine = error(tmp_path, "slide", "x")
    assert run(SLIDE, "swing", "--quiet", "--resolution", "1e-3", "--noise", "1e-4") == 0
    assert 1.5 * fine < error(tmp_path, "slide", "x") < 5e-3
    coarse = rows(tmp_path, "slide")
    assert run(SLIDE, "swing", "--quiet", "--resolution", "1e-3", "--noise", "1e-4") == 0
    assert rows(tmp_path, "slide") == coarse
    assert run(SLIDE, "swing", "--quiet", "--delay", "0.01") == 0
    assert error(tmp_path, "slide", "x") > 2.5 * fine


@pytest.mark.campaign
def test_drives_do_no_more_than_their_limits(
    run: Callable[..., int], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(f"{SLIDE}allocation: {{limits: {{f: [-5, 5]}}}}\n", "even") == 0
    assert "a drive at its limit at " in capsys.readouterr().out
    assert max(row["f"] for row in rows(tmp_path, "slide")) == 5
    # 6 N are needed: after 1 s half a metre is missing per newton and kilogramme
    assert error(tmp_path, "slide", "x") == pytest.approx((3 - 5 / 2) / 2, rel=0.01)


@pytest.mark.campaign
def test_what_encoders_do_not_say_is_found(run: Callable[..., int], tmp_path: Path) -> None:
    assert run(LADDER, "slide", "--quiet", "--resolution", "1e-5") == 0
    assert max(error(tmp_path, "ladder", name) for name in "axy") < 1e-3
    for row in rows(tmp_path, "ladder"):
        assert row["x"] ** 2 + row["y"] ** 2 == pytest.approx(1, abs=1e-11)


@pytest.mark.campaign
def test_pd_and_a_regulator(run: Callable[..., int], tmp_path: Path) -> None:
    assert run(SLIDE, "even", "--quiet", "--controller", "pd", "--bandwidth", "40") == 0
    last = rows(tmp_path, "slide")[-1]
    # it knows nothing of the acceleration
    assert last["x_planned"] - last["x"] == pytest.approx(3 / 40**2 - LATE / 40, rel=0.01)
    assert run(UPRIGHT, "upright", "--quiet", "--controller", "lqr", "--start", "a=0.2") == 0
    motion = rows(tmp_path, "cart")
    assert motion[0]["a"] == 0.2
    assert abs(motion[-1]["a"]) < 0.02
    assert run(UPRIGHT, "upright", "--quiet", "--controller", "pd", "--start", "a=0.2") == 0
    assert abs(rows(tmp_path, "cart")[-1]["a"]) > 1


@pytest.mark.parametrize(
    ("text", "options", "said"),
    [
        (SLIDE, ("evn",), "track: unknown name 'evn'; did you mean `even`?"),
        (SLIDE, ("even", "--machine", "mm=1"), "machine: unknown name 'mm'"),
        (SLIDE, ("even", "--start", "y=1"), "start: unknown name 'y'"),
        (SLIDE.partition("paths:")[0], ("even",), "slide has no `paths` to track"),
        (SLIDE.replace("inputs: {f: {unit: N, acts_on: {x: 1}}}\n", ""), ("even",), "slide has no inputs"),
    ],
)
def test_what_cannot_be_tracked_is_said(
    run: Callable[..., int], capsys: pytest.CaptureFixture[str], text: str, options: tuple[str, ...], said: str
) -> None:
    assert run(text, *options) == 2
    assert said in capsys.readouterr().err
