"""`symgen simulate` and `symgen new`: energy, constraints, starts, names, pages that cannot be broken out of."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from linkages import row_of_four_bars
from shipped import ROOT

from symgen.backends.backend import Variant
from symgen.backends.c import backend
from symgen.backends.c.plain import emit_c
from symgen.cli.main import main
from symgen.drawing.scene import Scene, Stand
from symgen.generation.results import Options
from symgen.ir.kernel import Program
from symgen.model.model import Model
from symgen.simulate import simulation
from symgen.simulate.animation import animation
from symgen.verify.running import compile as compiling

MODELS = ROOT / "models"


def run(*arguments: str) -> int:
    return main(["simulate", *arguments, "--quiet"])


def rows(folder: Path, name: str) -> list[dict[str, float]]:
    with (folder / name / "simulation.csv").open(encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


@pytest.fixture
def out(tmp_path: Path, tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder; what is simulated is verified at few states, compiled as it stands: the bits are the same."""
    tool("gcc")
    monkeypatch.setattr(compiling, "FLAGS", (*compiling.FLAGS, *compiling.PLAIN))
    monkeypatch.setattr(simulation, "Options", partial(Options, states=8))
    return tmp_path


@pytest.mark.campaign
def test_a_free_motion_keeps_its_energy(out: Path) -> None:
    text = (MODELS / "double_pendulum.yaml").read_text(encoding="utf-8")
    (out / "free.yaml").write_text(re.sub(r"applied_forces:\n(  .*\n)+", "", text), encoding="utf-8")
    options = ("--duration", "2", "--start", "q_1=1,q_2=0.4,q_1_dot=0.5", "--out", str(out))
    assert run(str(out / "free.yaml"), *options) == 0
    motion = rows(out, "double_pendulum")
    assert len(motion) == 101
    assert math.isclose(motion[-1]["t"], 2)
    assert (motion[0]["q_1"], motion[0]["q_2"], motion[0]["q_1_dot"]) == (1, 0.4, 0.5)
    totals = [row["kinetic_energy"] + row["potential_energy"] for row in motion]
    assert max(totals) - min(totals) < 1e-8 * max(map(abs, totals))
    assert abs(motion[-1]["q_1"] - 1) > 0.05


@pytest.mark.campaign
def test_constraints_hold_and_rates_are_projected(out: Path) -> None:
    options = ("--duration", "0.5", "--start", "a_1_dot=1", "--out", str(out))
    assert run(str(MODELS / "rapkm_2rrr_rr.yaml"), *options) == 0
    motion = rows(out, "rapkm_2rrr_rr")
    assert max(row["constraint_violation"] for row in motion) < 1e-12
    # one rate alone does not close the loops: the projection moves the other arms too
    assert motion[0]["a_1_dot"] != 1
    assert abs(motion[0]["a_2_dot"]) > 1e-3
    energy = [row["kinetic_energy"] for row in motion]
    assert max(energy) - min(energy) < 1e-9 * max(energy)


@pytest.mark.campaign
def test_rows_in_other_units_hold_as_well(out: Path, tmp_path: Path) -> None:
    start = "configuration: {a0: 0.9, a1: 0.7, b1: 0.1}"
    moved = []
    for name, scales in (("plain", ("1", "1")), ("scaled", ("1/131072", "1048576"))):
        file = tmp_path / f"{name}.yaml"
        text = row_of_four_bars(1, ground="0.7", scales=scales, tail=start)
        file.write_text(text.replace("model: row_of_four_bars", f"model: {name}"), encoding="utf-8")
        assert run(str(file), "--duration", "0.2", "--out", str(out)) == 0
        moved.append(rows(out, name))
    # a crank and its follower stay parallel: the start is closed before it moves, whatever the units of the rows
    for plain, scaled in zip(*moved, strict=True):
        assert scaled["constraint_violation"] < 1e-11
        angles = ("a0", "a1", "b1")
        assert [scaled[name] for name in angles] == pytest.approx([plain[name] for name in angles], abs=1e-8)


@pytest.mark.campaign
def test_a_start_at_a_singularity_is_refused(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (MODELS / "slider_crank.yaml").read_text(encoding="utf-8")
    (out / "locked.yaml").write_text(text.replace("model: slider_crank", "model: locked"), encoding="utf-8")
    # a crank as long as its rod: the slider at the crank's centre is a singularity of the constraints
    changed = (out / "locked.yaml").read_text(encoding="utf-8")
    for name in "rl":
        length = f"\n  {name}: {{value: 0.3, unit: m, range: [0.2, 0.4]}}"
        changed = re.sub(rf"\n  {name}: +\{{value: .*\}}", length, changed)
    (out / "locked.yaml").write_text(changed, encoding="utf-8")
    start = "alpha=1.5707963267948966,beta=-1.5707963267948966,s=0"
    code = run(str(out / "locked.yaml"), "--start", start, "--out", str(out))
    assert code == 1
    assert "no consistent start" in capsys.readouterr().err
    assert not (out / "locked").exists()


@pytest.mark.campaign
def test_kernels_that_verification_rejects_are_not_integrated(
    out: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def wrong(model: Model, program: Program) -> dict[str, str]:
        return {path: text.replace(" - ", " + ") for path, text in emit_c(model, program).items()}

    variants = Variant(wrong), *backend.BACKEND.variants[1:]
    monkeypatch.setattr(backend, "BACKEND", replace(backend.BACKEND, variants=variants))
    assert run(str(MODELS / "skate.yaml"), "--duration", "0.1", "--out", str(out)) == 1
    errors = capsys.readouterr().err
    assert "skate.yaml: not simulated: verification rejects what would be integrated" in errors
    assert "forward_dynamics" in errors
    assert not list(out.iterdir())


@pytest.mark.campaign
def test_what_was_verified_is_told(
    tool: Callable[[str], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tool("gcc")
    options = ("--duration", "0.1", "--start", "x_dot=1", "--out", str(tmp_path))
    assert main(["simulate", str(MODELS / "skate.yaml"), *options]) == 0
    assert re.search(r"verified at 64 states, off by [0-9.]+ units of 16", capsys.readouterr().out)


@pytest.mark.campaign
def test_without_a_compiler_the_interpreter_runs_what_python_verified(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out: Path
) -> None:
    options = ("--duration", "0.2", "--start", "x_dot=1,phi_dot=1")
    assert run(str(MODELS / "skate.yaml"), *options, "--out", str(out / "c")) == 0
    monkeypatch.setenv("CC", "")
    monkeypatch.setenv("PATH", "")
    assert run(str(MODELS / "skate.yaml"), *options, "--out", str(tmp_path / "interpreted")) == 0
    assert rows(out / "c", "skate") == rows(tmp_path / "interpreted", "skate")


def test_unknown_names_have_a_remedy(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(str(MODELS / "double_pendulum.yaml"), "--start", "q1=1", "--out", str(out)) == 2
    assert "unknown name 'q1'; did you mean `q_1`?" in capsys.readouterr().err
    assert run(str(MODELS / "double_pendulum.yaml"), "--inputs", "motor=1", "--out", str(out)) == 2
    assert "double_pendulum: inputs: unknown name 'motor'" in capsys.readouterr().err
    assert list(out.iterdir()) == []


def test_a_new_model_works_and_is_animated(out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(out)
    assert main(["new", "my_cart"]) == 0
    description = (out / "my_cart.yaml").read_text(encoding="utf-8")
    changed = description.replace("Cart on a rail with", "</script><b>Cart with")
    (out / "my_cart.yaml").write_text(changed, encoding="utf-8")
    assert run("my_cart.yaml", "--duration", "1", "--inputs", "drive=2", "--out", str(out)) == 0
    page = (out / "my_cart" / "simulation.html").read_text(encoding="utf-8")
    assert "<b>" not in page
    match = re.search(r'<script type="application/json" id="motion">(.*?)</script>', page)
    assert match is not None
    data = json.loads(match.group(1))
    assert data["names"] == ["cart", "rod", "tip"]
    assert data["stand"]["planar"]
    # the tip hangs on the rod at its length, and the cart has moved
    cart, _, tip = data["places"][-1]
    assert math.isclose(math.dist(cart, tip), 0.6, abs_tol=1e-4)
    assert cart[0] > 0.1
    assert main(["my_cart.yaml", "--out", str(out / "made"), "--only", "c", "--no-verify", "--quiet"]) == 0


@pytest.mark.campaign
def test_wheels_rods_and_bodies_are_drawn(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (out / "cart.yaml").write_text(
        """\
model: cart
joints:
  body: {type: planar, coordinates: [x, y, theta]}
  wheel: {type: revolute, parent: body, at: [0, 0.2, 0], axis: y, coordinate: a}
parameters: {R: 0.1}
gravity: [0, 0, 0]
bodies: {body: {mass: 8, inertia: {zz: 1}}, wheel: {mass: 1, com: [0.01, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}}
points: {post: {at: [3, 0, 0]}}
rolling: {tyre: {frame: wheel, radius: 2*R}}
springs: {pull: {between: [post, body], stiffness: 10, length: 3}}
""",
        encoding="utf-8",
    )
    assert main(["simulate", str(out / "cart.yaml"), "--duration", "0.1", "--out", str(out)]) == 0
    assert "nothing moves: give rates" in capsys.readouterr().out
    assert run(str(out / "cart.yaml"), "--duration", "0.1", "--start", "a_dot=1", "--out", str(out)) == 0
    page = (out / "cart" / "simulation.html").read_text(encoding="utf-8")
    data = json.loads(page.split('id="motion">')[1].split("</script>")[0])
    assert data["names"] == ["body", "wheel", "post"]
    assert data["hoops"] == [{"frame": 1, "radius": 0.2, "axle": 1}]
    assert data["ties"] == [{"kind": "spring", "ends": [2, 0]}]
    # the post stands in the world; the body is a bar from its origin to the wheel
    assert data["links"] == [
        {"frame": 0, "places": [[0, 0.2, 0], [0, 0, 0]], "shown": True},
        {"frame": 1, "places": [[0, 0, 0], [0.01, 0, 0]], "shown": True},
        {"frame": -1, "places": [[3, 0, 0]], "shown": True},
    ]
    assert [ball["share"] for ball in data["balls"]] == [1.0, 0.125]
    assert data["turned"] == [0, 1]
    # the wheel has turned about its own y axis by the way of its centre over its radius
    first, last = (rows[1] for rows in (data["axes"][0], data["axes"][-1]))
    assert first == [1, 0, 0, 0, 1, 0, 0, 0, 1]
    way = math.dist(data["places"][0][1], data["places"][-1][1])
    assert math.isclose(math.atan2(last[2], last[8]), way / 0.2, abs_tol=2e-4)
    assert way > 0.01


STAND = Stand((1, 0, 0), (0, 0, 1), (0, -1, 0), 0.4, planar=False)


def drawn(places: tuple[tuple[tuple[float, float, float], ...], ...]) -> tuple[list[list[float]], float]:
    """The centres and the size of the picture of a rod that goes through those places."""
    shown = Scene(("a", "b"), 0, ((0, 1),), (), (), (), (), (), (), (), STAND, places, tuple(() for _ in places))
    page = animation("rod", tuple(map(float, range(len(places)))), shown)
    data = json.loads(page.split('id="motion">')[1].split("</script>")[0])
    return data["centres"], data["radius"]


def test_a_machine_that_goes_far_stays_visible() -> None:
    start = ((0.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    near = drawn((start, ((3.0, 0.0, 0.0), (5.0, 0.0, 0.0))))
    assert near == ([[2.5, 0, 0]] * 2, 2.5)
    followed = drawn((start, ((100.0, 0.0, 0.0), (102.0, 0.0, 0.0))))
    assert followed == ([[1, 0, 0], [101, 0, 0]], 3)
    falling_apart = drawn((start, ((0.0, 0.0, 0.0), (0.0, 0.0, -100.0))))
    assert falling_apart == ([[1, 0, 0]] * 2, 3)


@pytest.mark.parametrize("name", ["../x", "1a", "for", "x_dot", ""])
def test_names_that_are_no_models(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", name]) == 2
    assert list(tmp_path.iterdir()) == []


def test_new_leaves_a_file_as_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "kept.yaml").write_text("mine", encoding="utf-8")
    assert main(["new", "kept"]) == 2
    assert (tmp_path / "kept.yaml").read_text(encoding="utf-8") == "mine"


@pytest.mark.campaign
def test_a_motion_of_endless_steps_stops(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A spring that swings ten thousand times in a frame: each frame would take minutes."""
    text = """model: stiff
coordinates: {x: {unit: m}}
kinetic_energy: x_dot**2/2
potential_energy: 1e13*x**2/2
outputs: [forward_dynamics]
"""
    (out / "stiff.yaml").write_text(text, encoding="utf-8")
    assert run(str(out / "stiff.yaml"), "--start", "x=1", "--duration", "0.1", "--out", str(out)) == 1
    assert "50000 steps lead no further than t = " in capsys.readouterr().err
    assert len((out / "stiff/simulation.csv").read_text().splitlines()) == 2


def test_planned_ways_of_the_ends_of_chains_are_drawn() -> None:
    """Of a tool on an arm that moves; not of the arm that it hangs on, nor of a post that stands."""
    places = (((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (5.0, 0.0, 0.0)), ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (5.0, 0.0, 0.0)))
    arm = Scene(("arm", "tool", "post"), 2, ((0, 1),), (), (), (), (), (), (), (), STAND, places, ((), ()))
    data = re.search('id="motion">(.*?)</script>', animation("arm", (0.0, 1.0), arm, arm))
    assert data is not None
    assert json.loads(data[1])["trails"] == [[[1, 0, 0], [0, 1, 0]]]
    data = re.search('id="motion">(.*?)</script>', animation("arm", (0.0, 1.0), arm))
    assert data is not None
    assert json.loads(data[1])["trails"] == []
