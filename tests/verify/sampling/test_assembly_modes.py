"""Assembly modes: configurations that no step from a known one leads to, found by starts all over."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.verify.lanes.loops_in_lanes import LoopsInLanes
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.modes import modes
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.states import sample_states

# Two arms of two links each hold a pin; the second arm stands d away.  Each elbow bends to either side.
PIN = """
model: pin
coordinates:
  a: {}
  b: {}
  c: {}
  e: {}
parameters:
  l: {value: 0.5, range: [0.45, 0.55]}
  d: {value: 0.4}
  J: {value: 0.02}
kinetic_energy: J/2*(a_dot**2 + b_dot**2 + c_dot**2 + 2*e_dot**2)
potential_energy: 3*sin(a) + sin(b)
constraints:
  geometric:
    x: l*cos(a) + 0.4*cos(b) - d - l*cos(c) - 0.4*cos(e)
    y: l*sin(a) + 0.4*sin(b) - l*sin(c) - 0.4*sin(e)
inputs:
  left: {acts_on: {a: 1}}
  right: {acts_on: {c: 1}}
outputs: [inverse_dynamics, forward_dynamics]
"""

# A link of length 1 from a slide z along a rail that turns by a, whose pivot is l away: z has no range.
RAIL = """
model: rail
coordinates:
  a: {}
  z: {}
parameters:
  l: {value: 2.2}
  J: {value: 0.3}
kinetic_energy: J/2*a_dot**2 + 2*z_dot**2
potential_energy: 20*z
constraints:
  geometric: {link: z**2 - 2*l*z*cos(a) + l**2 - 1}
inputs:
  push: {acts_on: {z: 1}}
configuration: {a: 0.2, z: 1.4}
"""


def built(text: str) -> Model:
    return load_text(text, "built.yaml")


def elbows(q: tuple[float, ...]) -> tuple[bool, bool]:
    a, b, c, e = q
    return sin(b - a) > 0, sin(e - c) > 0


def test_both_arms_bend_to_either_side() -> None:
    assembly_modes = modes(Reference(built(PIN)))
    assert {elbows(q) for q in assembly_modes} == {(left, right) for left in (True, False) for right in (True, False)}
    for a, b, c, e in assembly_modes:
        assert hypot(
            0.5 * cos(a) + 0.4 * cos(b) - 0.4 - 0.5 * cos(c) - 0.4 * cos(e),
            0.5 * sin(a) + 0.4 * sin(b) - 0.5 * sin(c) - 0.4 * sin(e),
        ) < 1e-9  # fmt: skip
        assert max(map(abs, (a, b, c, e))) <= pi
    assert assembly_modes == modes(Reference(built(PIN)))


def test_few_states_of_a_verification_meet_all_modes_in_turn() -> None:
    reference = Reference(built(PIN))
    places = [q for want in (True, False) for q in modes(reference) if elbows(q) == (want, not want)]
    start = "configuration: {a: 1.8, b: 0.3, c: 1.3, e: 2.9}\n"
    samples = sample_states(Reference(built(PIN + start)), ("inverse_dynamics",), 20, modes=[places[0], places[-1]])
    assert {(True, False), (False, True)} <= {elbows(sample.state.q) for sample in samples}


def test_the_parameters_of_the_file_are_met_often() -> None:
    reference = Reference(built(PIN))
    samples = sample_states(reference, ("inverse_dynamics",), 20, modes=modes(reference))
    lengths = [sample.state.parameters[0] for sample in samples]
    assert lengths.count(0.5) >= 6
    assert len(set(lengths)) > 6


def test_ranges_that_are_told_hold_and_others_reach_further() -> None:
    free = modes(Reference(built(RAIL)))
    assert max(z for _, z in free) > 2.5
    assert all(1.19 < abs(z) < 3.21 for _, z in free)
    assert {a > 0 for a, _ in free} == {True, False}
    limited = modes(Reference(built(RAIL + "ranges: {a: [0.1, 0.6], z: [1, 2]}\n")))
    assert limited
    assert all(0.095 <= a <= 0.605 and 0.99 <= z <= 2.01 for a, z in limited)


def test_trees_have_none() -> None:
    tree = PIN[: PIN.index("constraints:")] + PIN[PIN.index("inputs:") :]
    assert modes(Reference(built(tree))) == ()


def test_damped_steps_lead_onto_the_loops_from_anywhere() -> None:
    reference = Reference(built(PIN))
    loops = LoopsInLanes(reference.system, [float(x) for x in reference.literals()])
    starts = np.random.default_rng(5).uniform(-pi, pi, (200, 4))
    p = np.broadcast_to([float(x) for x in default_parameters(reference.model)], (200, 3))
    assert loops.shut(loops.damped(starts, p), p, 1e-9).mean() > 0.95
    # one that cannot close ends, and stays open
    far = np.array(p) * [1, 20, 1]
    assert not loops.shut(loops.damped(starts, far), far, 1e-9).any()


@pytest.mark.parametrize("count", [64, 200])
def test_states_in_modes_satisfy_the_rows_for_the_parameters_that_they_have(count: int) -> None:
    reference = Reference(built(PIN))
    samples = sample_states(reference, ("inverse_dynamics",), 8)
    around = Surroundings(reference, samples, modes(reference))
    states = around.in_modes(count)
    assert len(states) > count / 2
    assert {elbows(tuple(q)) for q in states.parts["q"]} == {(x, y) for x in (True, False) for y in (True, False)}
    length, d, _ = states.parts["p"].T
    a, b, c, e = states.parts["q"].T
    assert np.abs(length * (np.cos(a) - np.cos(c)) + 0.4 * (np.cos(b) - np.cos(e)) - d).max() < 1e-9
    assert (length == 0.5).mean() > 0.5
    assert len(Surroundings(reference, samples).in_modes(count)) == 0
