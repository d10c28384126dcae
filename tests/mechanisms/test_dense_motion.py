"""Where accelerations cannot go from body to body, a long kernel says why it is long and what would make it short."""

from __future__ import annotations

from pathlib import Path

import pytest

from symgen.generation import dense_motion
from symgen.generation.results import Options
from symgen.methods.forward_dynamics import articulated
from symgen.pipeline import generate

LINKS = 5
OPTIONS = Options(scalars=("float64",), parts=("c",), verify=False)


def notices(folder: Path, more: str = "", options: Options = OPTIONS, body: str = "") -> list[str]:
    lines = ["model: hanging", "joints:"]
    for k in range(LINKS):
        place = f"parent: j_{k - 1}, at: [0.3, 0, 0], " if k else ""
        lines.append(f"  j_{k}: {{type: revolute, {place}axis: {'yz'[k % 2]}, coordinate: a_{k}}}")
    lines += ["gravity: [0, 0, -9.81]", "bodies:"]
    inertia = "{xx: 0.01, yy: 0.02, zz: 0.02}"
    lines += [f"  j_{k}: {{mass: 1.2, com: [0.15, 0, 0], inertia: {inertia}}}" for k in range(LINKS)]
    lines += [body] if body else []
    lines += ["inputs:", "  M: {joint: a_0}", "outputs: [forward_dynamics]"]
    path = folder / "hanging.yaml"
    path.write_text("\n".join(lines) + "\n" + more)
    reported = generate(path, options, lambda _: None).notices
    return [notice.message for notice in reported if "mass matrix is factored" in notice.message]


@pytest.fixture(autouse=True)
def _short_is_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dense_motion, "LONG_MOTION", 100)


def test_bodies_alone_take_articulated_inertias_and_say_nothing(tmp_path: Path) -> None:
    assert notices(tmp_path) == []


def test_a_written_part_of_the_energy_is_named(tmp_path: Path) -> None:
    (message,) = notices(tmp_path, "kinetic_energy: 0.05*a_2_dot**2\n")
    assert message.startswith("forward_dynamics (")
    assert message.endswith("part of the kinetic energy is written out: describe it by bodies")


def test_what_is_short_says_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dense_motion, "LONG_MOTION", 3000)
    assert notices(tmp_path, "kinetic_energy: 0.05*a_2_dot**2\n") == []


def test_a_method_that_was_asked_for_says_nothing(tmp_path: Path) -> None:
    asked = Options(scalars=("float64",), parts=("c",), verify=False, methods={"forward_dynamics": "schur_qr"})
    assert notices(tmp_path, "kinetic_energy: 0.05*a_2_dot**2\n", asked) == []


def test_inertias_that_prove_nothing_ask_for_their_ranges(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(articulated, "definite_by_frames", lambda *_: False)
    monkeypatch.setattr(articulated, "definite_beside_rows", lambda *_: False)
    # without rows G is definite wherever the motion is determined
    assert notices(tmp_path) == []
    (message,) = notices(tmp_path, "constraints: {geometric: {gear: a_1 - 2*a_2}}\n")
    assert message.endswith("give masses and inertias a `range` above 0")


def test_coordinates_that_move_several_frames_are_told(tmp_path: Path) -> None:
    tip = "frames:\n  tip: {parent: j_4, rotation: [[x, a_0]]}\n"
    (message,) = notices(tmp_path, tip, body="  tip: {mass: 0.3, com: [0, 0.1, 0]}")
    assert message.endswith("give each joint a coordinate of its own")


def test_coordinates_without_mass_are_named(tmp_path: Path) -> None:
    """A lever and a link that drive the first link, and neither has a body."""
    linkage = "frames:\n  lever: {translation: [0.4, 0, 0], rotation: [[y, p]]}\n"
    linkage += "  link: {parent: lever, translation: [0, 0, 0.2], rotation: [[y, s]]}\n"
    linkage += "points:\n  end: {frame: link, at: [0.3, 0, 0.1]}\n  eye: {frame: j_0, at: [0.3, 0, 0.2]}\n"
    linkage += "loops:\n  pin: {type: point, between: [end, eye]}\n"
    linkage += "coordinates:\n  p: {unit: rad}\n  s: {unit: rad}\n"
    (message,) = notices(tmp_path, linkage)
    assert message.endswith("nothing that p and s alone would move has mass or inertia: give its frame a body")
