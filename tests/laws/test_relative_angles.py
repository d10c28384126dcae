"""Closed chains in relative angles, whose causes of a failure are told apart in absolute ones."""

from __future__ import annotations

import pytest
from laws_harness import System, system

from symgen.symbolic.traverse import reached
from symgen.verify.sampling.states import sample_states

PRESS = """\
model: press_with_two_toggles
parameters:
  r: {value: 0.2, unit: m}
  k: {value: 0.7, unit: m, range: [0.65, 0.75]}
  h: {value: 0.5, unit: m}
  J: {value: 0.03, unit: kg*m**2}
  m: {value: 3, unit: kg}
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}, e: {unit: rad}}
definitions:
  rod_x: r*cos(a) + k*cos(a + b)
  rod_y: r*sin(a) + k*sin(a + b)
  bar_x: r*cos(a) + k*cos(a + d)
  bar_y: r*sin(a) + k*sin(a + d)
kinetic_energy: >-
  J/2*(a_dot**2 + c_dot**2 + e_dot**2 + (a_dot + b_dot)**2 + (a_dot + d_dot)**2)
  + m/2*(h*c_dot)**2 + m*(h*e_dot)**2
potential_energy: 9.81*m*(h*sin(c) + 2*h*sin(e))
constraints:
  geometric:
    left_x: rod_x - 0.6 - h*cos(c)
    left_y: rod_y - h*sin(c)
    right_x: bar_x + 0.6 - h*cos(e)
    right_y: bar_y - h*sin(e)
inputs:
  crank: {unit: N*m, joint: a}
  left: {unit: N*m, joint: c}
  right: {unit: N*m, joint: e}
configuration: {a: 0.8, b: -0.4, c: 1.6, d: 1.4, e: 1.2}
"""

# crank, coupler and rocker; two more dyads, the last on the arm of the first, all in relative angles
GRIPPER = """\
model: gripper_with_three_loops
parameters:
  l: {value: 0.2, unit: m}
  k: {value: 0.5, unit: m}
  m: {value: 0.4, unit: kg}
  J: {value: 0.01, unit: kg*m**2}
gravity: [0, -9.81, 0]
joints:
  crank: {type: revolute, axis: z, coordinate: a}
  coupler: {type: revolute, parent: crank, axis: z, at: [l, 0, 0], coordinate: b}
  rocker: {type: revolute, axis: z, at: [0.6, 0, 0], coordinate: c}
  link: {type: revolute, parent: coupler, axis: z, at: [0.3, 0.1, 0], coordinate: d}
  lever: {type: revolute, axis: z, at: [0.7, 0.5, 0], coordinate: e}
  strut: {type: revolute, parent: link, axis: z, at: [0.25, 0.05, 0], coordinate: f}
  jaw: {type: revolute, axis: z, at: [0.3, 0.9, 0], coordinate: g}
bodies:
  crank: {mass: m, com: [l/2, 0, 0], inertia: {zz: J}}
  coupler: {mass: m, com: [k/2, 0, 0], inertia: {zz: J}}
  rocker: {mass: m, com: [k/2, 0, 0], inertia: {zz: J}}
  link: {mass: m, com: [0.2, 0, 0], inertia: {zz: J}}
  lever: {mass: m, com: [0.1, 0, 0], inertia: {zz: J}}
  strut: {mass: m, com: [0.2, 0, 0], inertia: {zz: J}}
  jaw: {mass: m, com: [0.2, 0, 0], inertia: {zz: J}}
points:
  coupler_end: {frame: coupler, at: [k, 0, 0]}
  rocker_end: {frame: rocker, at: [0.4, 0, 0]}
  link_end: {frame: link, at: [0.4, 0, 0]}
  lever_end: {frame: lever, at: [0.35, 0, 0]}
  strut_end: {frame: strut, at: [0.35, 0, 0]}
  jaw_end: {frame: jaw, at: [0.4, 0, 0]}
loops:
  one: {type: point, between: [coupler_end, rocker_end]}
  two: {type: point, between: [link_end, lever_end]}
  three: {type: point, between: [strut_end, jaw_end]}
inputs:
  crank_drive: {unit: N*m, joint: a}
  rocker_drive: {unit: N*m, joint: c}
  jaw_drive: {unit: N*m, joint: g}
configuration: {a: 1.2, b: -0.9, c: 2, d: 0.6, e: 3, f: 0.8, g: -0.8}
outputs: [inverse_dynamics, forward_dynamics, multipliers, singularity]
"""
OUTPUTS = ("inverse_dynamics", "forward_dynamics", "multipliers", "singularity")


@pytest.fixture(params=[PRESS, PRESS.replace(", range: [0.65, 0.75]", ""), GRIPPER], ids=["press", "fixed", "gripper"])
def linkage(request: pytest.FixtureRequest) -> System:
    return system(request.param, OUTPUTS)


@pytest.mark.campaign
def test_no_kernel_asks_for_what_the_model_does_not_have(linkage: System) -> None:
    model = linkage.model
    known = {name for c in model.coordinates for name in (c.name, c.rate, c.acceleration)}
    known |= {p.name for p in model.parameters} | {i.name for i in model.inputs}
    for quantity in linkage.derivations.quantities:
        nodes = list(quantity.outputs)
        guards = list(quantity.guards)
        while guards:
            guard = guards.pop()
            guards += guard.first
            nodes += [guard.denominator] if guard.scale is None else [guard.denominator, guard.scale]
        assert {str(node.payload) for node in reached(nodes) if node.op == "symbol"} <= known


def test_its_kernels_are_right(linkage: System) -> None:
    for sample in sample_states(linkage.reference, OUTPUTS, 8):
        linkage.assert_right(sample.state, OUTPUTS)
