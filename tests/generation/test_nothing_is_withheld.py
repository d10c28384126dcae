"""Machines whose quantities rounding is hard on, by the whole command: every quantity is verified in both types."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from symgen.backends.c import backend
from symgen.cli import main as cli
from symgen.verify.running import compile as compiling
from symgen.verify.tolerance import FACTOR

TARGETS = ("C float64", "C float32")
MOTION = ("inverse_dynamics", "forward_dynamics", "multipliers")


@pytest.fixture(autouse=True)
def compiler(tool: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Bits are the same at every level (test_levels) and for many states (test_kernels_at_many_states)."""
    tool("cc")
    monkeypatch.setattr(compiling, "FLAGS", (*compiling.FLAGS, *compiling.PLAIN))
    monkeypatch.setattr(backend, "BACKEND", replace(backend.BACKEND, variants=backend.BACKEND.variants[:1]))


def verified(text: str, folder: Path, quantities: Sequence[str], *options: str) -> Any:
    """What derivation.json tells of a machine of which nothing is left out."""
    path = folder / "machine.yaml"
    path.write_text(f"{text}\noutputs: [{', '.join(quantities)}]\n", encoding="utf-8")
    assert cli.main([str(path), "--out", str(folder), "--only", "c", "--quiet", *options]) == 0
    (written,) = (one for one in folder.iterdir() if one.is_dir())
    certificate = json.loads((written / "certificate.json").read_bytes())
    derivation = json.loads((written / "derivation.json").read_bytes())
    assert certificate["passed"]
    assert certificate["left_out"] == []
    assert set(derivation["kernels"]) == set(quantities)
    largest = {(one["quantity"], one["target"]): one["largest"] for one in certificate["errors"]}
    for quantity in quantities:
        for target in TARGETS:
            assert largest[quantity, target] <= FACTOR, (quantity, target)
    return derivation


# A tug steered and driven by its front wheel, which is out of balance and has turned for hours.
TUG = """
model: tug
trig_range: wide
coordinates:
  x: {unit: m}
  y: {unit: m}
  h: {unit: rad, range: [-3e4, 3e4]}
  s: {unit: rad, range: [-0.9, 0.9]}
  w: {unit: rad, range: [-3e4, 3e4]}
parameters:
  m: {value: 40, unit: kg}
  J: {value: 3, unit: kg*m**2}
  J_s: {value: 0.05, unit: kg*m**2}
  J_w: {value: 0.04, unit: kg*m**2}
  b: {value: 0.6, unit: m}
  R: {value: 0.15, unit: m}
  e: {value: 0.01, unit: kg*m}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2) + m*b/3*h_dot*(y_dot*cos(h) - x_dot*sin(h)) + J/2*h_dot**2
  + J_s/2*(h_dot + s_dot)**2 + (J_w + e*R*cos(w))/2*w_dot**2
potential_energy: 9.81*e*sin(w)
constraints:
  nonholonomic:
    rear: y_dot*cos(h) - x_dot*sin(h)
    front: y_dot*cos(h + s) - x_dot*sin(h + s) + b*h_dot*cos(s)
    roll: x_dot*cos(h + s) + y_dot*sin(h + s) + b*h_dot*sin(s) - R*w_dot
inputs:
  drive: {unit: N*m, acts_on: {w: 1}}
  steer: {unit: N*m, acts_on: {s: 1}}
"""
# A four-bar on a carrier; carrier and crank have turned thousands of times.
MILL = """
model: mill
trig_range: wide
gravity: [0, -9.81, 0]
joints:
  carrier: {type: revolute, axis: z, coordinate: a}
  crank: {type: revolute, axis: z, parent: carrier, at: [0.2, 0, 0], coordinate: c}
  coupler: {type: revolute, axis: z, parent: crank, at: [0.2, 0, 0], coordinate: b}
  rocker: {type: revolute, axis: z, parent: carrier, at: [0.7, 0, 0], coordinate: r}
bodies:
  carrier: {mass: 4, com: [0.3, 0, 0], inertia: {zz: 0.3}}
  crank: {mass: 0.5, com: [0.1, 0, 0], inertia: {zz: 0.004}}
  coupler: {mass: 1.2, com: [0.3, 0.1, 0], inertia: {zz: 0.05}}
  rocker: {mass: 0.9, com: [0.25, 0, 0], inertia: {zz: 0.03}}
points:
  pin: {frame: coupler, at: [0.6, 0, 0]}
  tip: {frame: rocker, at: [0.5, 0, 0]}
loops: {closed: {type: point, between: [pin, tip]}}
inputs:
  stone: {unit: N*m, joint: a}
  shaft: {unit: N*m, joint: c}
ranges: {a: [-3e4, 3e4], c: [-3e4, 3e4]}
configuration: {a: 0.4, c: 1, b: -0.5, r: 1.5}
"""


@pytest.mark.slow
@pytest.mark.parametrize("text", [TUG, pytest.param(MILL, marks=pytest.mark.campaign)], ids=["tug", "mill"])
def test_wheels_and_cranks_that_turn_for_hours_are_verified_in_float32(text: str, tmp_path: Path) -> None:
    derivation = verified(text, tmp_path, MOTION)
    assert not any(kernel.get("twice_the_digits") for kernel in derivation["kernels"].values())


@pytest.mark.campaign
@pytest.mark.slow
def test_what_loses_digits_at_great_angles_alone_has_twice_as_many(tmp_path: Path) -> None:
    """Within a turn every method of N_B keeps its digits."""
    derivation = verified(MILL, tmp_path, ("constraint_jacobian", "nullspace_projector"))
    assert derivation["kernels"]["nullspace_projector"]["twice_the_digits"] == ["float64", "float32"]
    assert {one["quantity"] for one in derivation["rejected"]} == {"nullspace_projector"}


Vector = list[str]


def arm(count: int) -> str:
    """Links that turn about the z and the y axis of the one before by turns: positions, rates and energies in lines."""
    frame: list[Vector] = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]
    rate, speed, height = ["0"] * 3, ["0"] * 3, "0"
    lines, kinetic, potential = list[str](), list[str](), list[str]()

    def named(name: str, values: Sequence[str]) -> Vector:
        names = [f"{name}{axis}" for axis in "xyz"]
        lines.extend(f"  {one}: {value}" for one, value in zip(names, values, strict=True))
        return names

    def of(speed: Vector, rate: Vector, along: Vector, share: str) -> Vector:
        """The velocity of the place on a link that is a share of its length away from its joint."""
        turned = [
            f"({rate[k - 2]})*({along[k - 1]}) - ({rate[k - 1]})*({along[k - 2]})" for k in range(3)
        ]  # rate x along
        return [f"{v} + {share}*({across})" for v, across in zip(speed, turned, strict=True)]

    for k in range(1, count + 1):
        about = 2 if k % 2 else 1
        first, second = frame[about - 2], frame[about - 1]
        c, s = f"cos(q_{k})", f"sin(q_{k})"
        rate = named(f"w_{k}", [f"{w} + q_{k}_dot*({axis})" for w, axis in zip(rate, frame[about], strict=True)])
        frame[about - 2] = named(f"a_{k}", [f"{c}*({x}) + {s}*({y})" for x, y in zip(first, second, strict=True)])
        frame[about - 1] = named(f"b_{k}", [f"{c}*({y}) - {s}*({x})" for x, y in zip(first, second, strict=True)])
        middle = named(f"s_{k}", of(speed, rate, frame[2], f"l_{k}/2"))
        speed = named(f"e_{k}", of(speed, rate, frame[2], f"l_{k}"))
        squares = (" + ".join(f"{one}**2" for one in names) for names in (middle, rate))
        kinetic.extend(f"{mass}/2*({square})" for mass, square in zip((f"m_{k}", f"J_{k}"), squares, strict=True))
        potential.append(f"m_{k}*({height} + l_{k}/2*({frame[2][2]}))")
        height = f"{height} + l_{k}*({frame[2][2]})"
    links = range(1, count + 1)
    return "\n".join(
        [
            f"model: arm_{count}",
            "coordinates:",
            *(f"  q_{k}: {{unit: rad}}" for k in links),
            "parameters:",
            *(f"  m_{k}: {{value: {6 / k:.2f}, unit: kg}}" for k in links),
            *(f"  l_{k}: {{value: {0.45 - 0.04 * k:.2f}, unit: m}}" for k in links),
            *(f"  J_{k}: {{value: {0.05 / k**2:.4f}, unit: kg*m**2}}" for k in links),
            "definitions:",
            *lines,
            f"kinetic_energy: {' + '.join(kinetic)}",
            f"potential_energy: 9.81*({' + '.join(potential)})",
            "inputs:",
            *(f"  u_{k}: {{unit: N*m, acts_on: {{q_{k}: 1}}}}" for k in links),
        ]
    )


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.parametrize("count", [5, 7])
def test_an_arm_given_by_energies_has_its_accelerations_in_float32(count: int, tmp_path: Path) -> None:
    verified(arm(count), tmp_path, ("forward_dynamics",))


def ring(name: str, lengths: Sequence[str], twists: Sequence[str], start: Sequence[float]) -> str:
    """Six bars in a ring of revolute joints, the last of them the ground; each is turned, moved along and twisted."""
    joints, bodies, before = list[str](), list[str](), ""
    for k in range(5):
        joints.append(f"  r_{k}: {{type: revolute, axis: z{before}, coordinate: t_{k}}}")
        bodies.append(
            f"  r_{k}: {{mass: {1 + 0.3 * k:.1f}, com: [{lengths[k]}/2, 0, 0],"
            " inertia: {xx: 0.004, yy: 0.02, zz: 0.021}}"
        )
        before = f', parent: r_{k}, at: [{lengths[k]}, 0, 0], rotation: [[x, "{twists[k]}"]]'
    return "\n".join(
        [
            f"model: {name}",
            "gravity: [1, 0, -9.7]",
            "joints:",
            *joints,
            "bodies:",
            *bodies,
            "frames:",
            f'  end: {{parent: r_4, translation: [{lengths[4]}, 0, 0], rotation: [[x, "{twists[4]}"]]}}',
            f'  dock: {{translation: ["-{lengths[5]}", 0, 0], rotation: [[x, "-({twists[5]})"]]}}',
            "loops: {ring: {type: revolute, between: [end, dock]}}",
            "inputs: {motor: {unit: N*m, joint: t_0}}",
            f"configuration: {{{', '.join(f't_{k}: {angle}' for k, angle in enumerate(start))}}}",
        ]
    )


# Bricard's rings of one degree of freedom, by the conditions that he found for lengths and twists.
PLANE_SYMMETRIC = ring(
    "plane_symmetric",
    ("0.3", "0.5", "0.4", "0.4", "0.5", "0.3"),
    ("0.9", "1.3", "0.7", "pi - 0.7", "pi - 1.3", "pi - 0.9"),
    (2.336575, 1.535453, 1.284965, 2.3112, -1.284965),
)
# The squares of the first, third and fifth length have the sum of those of the others.
TRIHEDRAL = ring(
    "trihedral",
    ("0.3", "0.4", "0.5", "0.35", "0.4", repr(math.sqrt(0.3**2 + 0.5**2 - 0.35**2))),
    ("pi/2", "-pi/2") * 3,
    (1.674791, -1.277579, 1.744066, -1.412683, 1.839281),
)


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.parametrize("text", [PLANE_SYMMETRIC, TRIHEDRAL], ids=["plane_symmetric", "trihedral"])
def test_a_ring_of_six_bars_has_every_motion(text: str, tmp_path: Path) -> None:
    assert verified(text, tmp_path, MOTION)["sizes"]["rank"] == 4


@pytest.mark.slow
@pytest.mark.campaign
def test_the_input_of_a_ring_with_unequal_bars_is_verified(tmp_path: Path) -> None:
    assert verified(TRIHEDRAL, tmp_path, MOTION[:1], "--states", "8")["sizes"]["rank"] == 4
