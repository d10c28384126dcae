"""Machines side by side are worked out one by one, and every quantity is what it is of all of them as a whole."""

from __future__ import annotations

from dataclasses import replace

import pytest

from symgen.model.load import load_text
from symgen.verify.reference.arithmetic.linear import norm
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.parts import Part, parts
from symgen.verify.reference.measures import measures_of_parts
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import sample_states

MODEL = """model: side_by_side
coordinates:
  a: {unit: rad}
  s: {range: [-2, 2]}
  x: {range: [-2, 2]}
  y: {range: [-2, 2]}
  c: {unit: rad}
  d: {unit: rad}
  e: {unit: rad}
parameters: {l: 0.5, m: 2, k: 0.3}
kinetic_energy: >-
  m*s_dot**2/2 + m*l**2*a_dot**2/6 + m*(x_dot**2 + y_dot**2)/2 + l*m*x_dot*c_dot*cos(c) + m*c_dot**2
  + k*d_dot**2*(2 + sin(e)) + k*d_dot*e_dot*cos(d)/5 + k*e_dot**2
constraints:
  geometric:
    slide: s - l*cos(a) - 1
    circle: x**2 + y**2 - 1
DEPENDENT    again: 3*x**2 + 3*y**2 - 3
  nonholonomic:
    mesh: d_dot - 2*e_dot
inputs:
  push: {acts_on: {s: 1}}
  turn: {acts_on: {x: y, y: -x}}
  pull: {acts_on: {x: 1}}
  swing: {acts_on: {c: cos(c)}}
REACHED  gear: {acts_on: {d: k}}
outputs: all
configuration: {a: 0.4, s: 1.46, x: 0.6, y: 0.8}
"""


def model(dependent: bool, reached: bool) -> str:
    text = MODEL.replace("DEPENDENT    ", "    " if dependent else "#").replace("REACHED  ", "  " if reached else "#")
    return "\n".join(line for line in text.splitlines() if not line.startswith("#"))


@pytest.mark.parametrize("dependent", [False, True])
@pytest.mark.parametrize("reached", [False, True])
def test_every_quantity_is_that_of_the_whole(dependent: bool, reached: bool) -> None:
    reference = Reference(load_text(model(dependent, reached), "side.yaml"))
    system = reference.system
    assert [part.coordinates for part in system.parts] == [(0, 1), (2, 3), (4,), (5, 6)]
    assert [part.coordinates for part in system.heavy] == [(0, 1), (2, 3, 4), (5, 6)]
    assert [part.coordinates for part in system.loops] == [(0, 1), (2, 3)]
    assert reference.ranks.of_parts == ((1, 1), (1, 1), (0, 1), (1, int(reached)))
    names = [name for name in reference.quantities() if not name.startswith("minimal_")]
    states = [sample.state for sample in sample_states(reference, ["singularity"], 8)]
    evaluations = [reference.precise(state, names) for state in states]
    measures = []
    with precision(256):
        for state in states:
            measures.append([float(x) for x in measures_of_parts(reference.evaluation(state))])
    everything = Part(*(tuple(range(count)) for count in (system.n, system.r, system.m, 0)))
    system.parts = (everything,)
    system.heavy = (replace(everything, bodies=()),)
    for state, apart, measured in zip(states, evaluations, measures, strict=True):
        whole = reference.precise(state, names)
        with precision(256):
            for name in names:
                assert norm(apart[name] - whole[name]) <= 1e-45 * max(norm(whole[name]), 1e-10), name
        assert all(0 < x <= 1 + 1e-12 for x in measured)


def test_what_is_coupled_by_way_of_others_belongs_together() -> None:
    groups = parts(6, [[0, 3], [4]], [[3, 5], []], pairs=[(1, 1), (2, 4)])
    assert groups == (Part((0, 3, 5), (0,), (0, 1)), Part((1,)), Part((2, 4), (1,)))
