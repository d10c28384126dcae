"""Constraints that depend on each other, frames without mass: u and accelerations are those of the plain machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
import pytest
from linkages import on_two_bases
from shipped import ROOT

from symgen.backends.c.plain import emit_c
from symgen.diagnostics import ModelError
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity
from symgen.mechanics.structure import analyse
from symgen.mechanics.system import System
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.package.files import emit_package
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states

FOUR_BAR = on_two_bases((ROOT / "models" / "tilted_four_bar.yaml").read_text(encoding="utf-8"))
ARM = """\
model: arm
joints:
  upper: {type: revolute, axis: z, coordinate: a}
  lower: {type: revolute, parent: upper, at: [0.5, 0, 0], axis: z, coordinate: b}
bodies:
  upper: {mass: 2, com: [0.25, 0, 0], inertia: {zz: 0.05}}
  lower: {mass: 1.5, com: [0.2, 0.01, 0], inertia: {zz: 0.03}}
gravity: [0, -9.81, 0]
points: {tip: {frame: lower, at: [0.4, 0, 0]}}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
"""
PLAIN = ARM + "inputs: {motor: {unit: N*m, joint: a}, push: {unit: N, point: tip, direction: [1, 0, 0]}}\n"
# the same force on a sleeve without mass that the tip carries along
SLEEVE = (
    ARM.replace("joints:\n", "joints:\n  sleeve: {type: planar, coordinates: [x, y, turn]}\n")
    + "loops: {carried: {type: fixed, between: [sleeve, hand]}}\n"
    + "frames: {hand: {parent: lower, translation: [0.4, 0, 0]}}\n"
    + "configuration: {a: 0.3, b: 0.8, turn: 1.1, x: 0.659, y: 0.504}\n"
    + "inputs: {motor: {unit: N*m, joint: a}, push: {unit: N, point: sleeve, direction: [1, 0, 0]}}\n"
)


def kernels(model: Model, values: Mapping[str, float]) -> dict[str, np.ndarray]:
    """The derived outputs of a model at a state given by the names of its symbols."""
    derived = derive_quantities(model, model.outputs)
    everything = default_values(model.parameters) | values
    return {one.name: np.array(Evaluator(one.outputs)(everything)) for one in derived.quantities}


def rotation(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


@cache
def four_bars() -> tuple[Model, Model]:
    """The linkage in its tilted plane under three dependent rows, and in the plane z = 0 under two; same weight."""
    weight = (rotation(0, 0.5) @ rotation(1, 0.3)).T @ [0, -9.81, 0]
    tilt = "{rotation: [[x, 0.5], [y, 0.3]]}"
    assert FOUR_BAR.count(tilt) == 2
    flat = FOUR_BAR.replace(tilt, "{}").replace("[0, -g, 0]", str(weight.tolist()))
    return load_text(FOUR_BAR, "tilted.yaml"), load_text(flat, "flat.yaml")


def closed(model: Model, crank: float) -> np.ndarray:
    """Angles a, b, c of the four-bar with both ends of coupler and rocker together."""
    p = default_values(model.parameters)
    b, c = -0.8, 1.5
    for _ in range(30):
        end = np.array(
            [
                p["l_1"] * np.cos(crank) + p["l_2"] * np.cos(crank + b) - p["d"] - p["l_3"] * np.cos(c),
                p["l_1"] * np.sin(crank) + p["l_2"] * np.sin(crank + b) - p["l_3"] * np.sin(c),
            ]
        )
        slope = [
            [-p["l_2"] * np.sin(crank + b), p["l_3"] * np.sin(c)],
            [p["l_2"] * np.cos(crank + b), -p["l_3"] * np.cos(c)],
        ]
        step = np.linalg.solve(slope, -end)
        b, c = b + step[0], c + step[1]
    return np.array([crank, b, c])


def state(
    model: Model, q: Sequence[float], qd: Sequence[float], qdd: Sequence[float], u: Sequence[float]
) -> dict[str, float]:
    """The numbers of a state by the names of the symbols."""
    values = {c.name: x for c, x in zip(model.coordinates, q, strict=True)}
    values |= {c.rate: x for c, x in zip(model.coordinates, qd, strict=True)}
    values |= {c.acceleration: x for c, x in zip(model.coordinates, qdd, strict=True)}
    return values | {i.name: x for i, x in zip(model.inputs, u, strict=True)}


def jacobian(model: Model, values: Mapping[str, float]) -> np.ndarray:
    rows = System(model).constraint_jacobian
    flat = Evaluator([x for row in rows for x in row])(default_values(model.parameters) | values)
    return np.array(flat).reshape(len(rows), model.n)


def test_surplus_rows_change_neither_u_nor_the_accelerations() -> None:
    tilted, flat = four_bars()
    assert [len(model.constraints) for model in (tilted, flat)] == [3, 2]
    assert [Reference(model).ranks.constraints for model in (tilted, flat)] == [2, 2]
    q = closed(flat, 1.2)
    here = state(flat, q, (0, 0, 0), (0, 0, 0), (0,))
    direction = np.linalg.svd(jacobian(flat, here))[2][-1]
    values = state(flat, q, 3 * direction, (0.4, -1, 2), (0.7,))
    one, other = kernels(tilted, values), kernels(flat, values)
    assert one["inverse_dynamics"] == pytest.approx(other["inverse_dynamics"], rel=1e-11)
    assert one["forward_dynamics"] == pytest.approx(other["forward_dynamics"], rel=1e-11)
    # the multipliers differ, three of them are not unique, but the reactions do not
    reactions = [jacobian(model, values).T @ output["multipliers"] for model, output in ((tilted, one), (flat, other))]
    assert reactions[0] == pytest.approx(reactions[1], rel=1e-10)
    # of all multipliers these are the smallest: none of them lies in the kernel of B^T
    surplus = np.linalg.svd(jacobian(tilted, values).T)[2][-1]
    assert abs(surplus @ one["multipliers"]) < 1e-10 * np.linalg.norm(one["multipliers"])


def test_multipliers_that_are_not_unique_are_told() -> None:
    mechanics = System(four_bars()[0])
    reasons = {one.what: one.why for one in analyse(mechanics, genericity(mechanics)).decisions}
    assert "rank 2 of 3; none is dropped" in reasons["a unique set of multipliers"]


def test_headers_and_packages_say_that_multipliers_are_not_unique() -> None:
    for model, times in zip(four_bars(), (1, 0), strict=True):
        derived = derive_quantities(model, ("multipliers",))
        program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
        files = emit_c(model, program)
        package = emit_package(model, [program], files)
        for text in (files[f"c/{model.name}.h"], package["package/README.md"]):
            words = " ".join(str(text).split())
            assert words.count("not unique, as the constraints depend on each other (rank 2 of 3)") == times


def test_a_sleeve_without_mass_passes_its_force_on() -> None:
    plain, sleeve = load_text(PLAIN, "plain.yaml"), load_text(SLEEVE, "sleeve.yaml")
    names = [c.name for c in sleeve.coordinates]
    assert names == ["x", "y", "turn", "a", "b"]
    q, qd, u = np.array([0.3, 0.8]), np.array([0.5, -1.2]), (0.4, 7.0)
    angles = np.array([q[0], q.sum()])
    place = [0.5 * np.cos(angles[0]) + 0.4 * np.cos(angles[1]), 0.5 * np.sin(angles[0]) + 0.4 * np.sin(angles[1])]
    rates = np.array([qd[0], qd.sum()])
    speed = [
        -0.5 * np.sin(angles[0]) * rates[0] - 0.4 * np.sin(angles[1]) * rates[1],
        0.5 * np.cos(angles[0]) * rates[0] + 0.4 * np.cos(angles[1]) * rates[1],
    ]
    outputs = kernels(sleeve, state(sleeve, [*place, angles[1], *q], [*speed, rates[1], *qd], (0,) * 5, u))
    wanted = kernels(plain, state(plain, q, qd, (0, 0), u))
    assert outputs["forward_dynamics"][3:] == pytest.approx(wanted["forward_dynamics"], rel=1e-11)
    # the loop passes the push on: all of it, and no torque
    values = state(sleeve, [*place, angles[1], *q], (0,) * 5, (0,) * 5, u)
    reaction = jacobian(sleeve, values).T @ outputs["multipliers"]
    assert reaction[:3] == pytest.approx([7.0, 0, 0], abs=1e-11)
    qdd = outputs["forward_dynamics"]
    back = kernels(sleeve, state(sleeve, [*place, angles[1], *q], [*speed, rates[1], *qd], qdd, u))
    assert back["inverse_dynamics"] == pytest.approx(u, rel=1e-11)


def test_masses_that_vanish_beside_others_are_told() -> None:
    text = """
model: star_and_grains
coordinates: {a: {unit: m}, b: {unit: m}, c: {unit: m}}
kinetic_energy: 1e70*b_dot**2 + cos(a)*a_dot*b_dot/2 + 2*a_dot**2 + c_dot**2 + cos(a)*c_dot*b_dot/2
constraints: {geometric: {held: b + c - sin(a)}}
"""
    with pytest.raises(ModelError, match="accelerations cannot be told: some of the masses vanish"):
        load_text(text, "star_and_grains.yaml")


def test_states_are_found_under_both_wheels_of_an_axle() -> None:
    """Each wheel holds the axle across; many rows leave the measures of singularity small at every state."""
    text = (ROOT / "models" / "differential_drive.yaml").read_text(encoding="utf-8")
    head, _, rest = text.partition("points:")
    wheels, _, inputs = rest.partition("rolling:")[2].partition("constraints:")
    right = "  right_tyre: {frame: right_wheel, radius: R}\n"
    both = f"{head}rolling:{wheels}{right}inputs:{inputs.partition('inputs:')[2]}"
    reference = Reference(load_text(both, "both.yaml"))
    assert (reference.model.r, reference.ranks.constraints) == (6, 5)
    samples = sample_states(reference, ["inverse_dynamics"], 8)
    assert max(sample.measures[0] for sample in samples) < 1e-3
