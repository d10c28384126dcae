"""u asks nothing of rows in whose coordinates no input acts, where inputs span less than the motions."""

from __future__ import annotations

import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.ir.kernel import Status
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.methods.driven_blocks import where_inputs_act
from symgen.model.load import load_text
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import State

# A board on two axles that turn against it, with a flywheel; no input works on what the rows hold.
BOARD = """
model: board
coordinates: {{x: {{unit: m}}, y: {{unit: m}}, a: {{unit: rad}}, w: {{unit: rad}}, f: {{unit: rad}}, h: {{unit: rad}}}}
parameters: {{m: {{value: 6}}, l: {{value: 0.2}}, J: {{value: 0.1}}}}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2) + J/2*a_dot**2 + 0.02/2*(a_dot + w_dot)**2
  + 0.002/2*((a_dot + f_dot)**2 + (a_dot + h_dot)**2)
constraints:
  nonholonomic:
    front: cos(a + f)*y_dot - sin(a + f)*x_dot + l*cos(f)*a_dot
    back: cos(a + h)*y_dot - sin(a + h)*x_dot - l*cos(h)*a_dot
inputs: {{flywheel: {{acts_on: {{w: 1}}}}, steer: {{acts_on: {{f: 1}}}}, {last}}}
outputs: [inverse_dynamics]
"""
# Two rods that close over a slide each: one is driven, the other follows a spring.
PAIR = """
model: pair
coordinates: {{a: {{unit: rad}}, x: {{unit: m}}, b: {{unit: rad}}, y: {{unit: m}}, s: {{unit: m}}}}
kinetic_energy: a_dot**2/2 + 3*x_dot**2/2 + b_dot**2/2 + 5*(y_dot + s_dot)**2/2 + s_dot**2/2
potential_energy: 20*(y - x - s)**2
constraints:
  geometric:
    first: x - 2*cos(a)
    second: y - 3*cos(b)
inputs: {{push: {{acts_on: {{{on}: 1}}}}}}
outputs: [inverse_dynamics]
configuration: {{a: 1, x: 1.0806046117362795, b: 0.7, y: 2.2945265618534655}}
"""


def statuses(text: str) -> set[Status]:
    model = load_text(text, "model.yaml")
    (kernel,) = draft_of(model, model.outputs, Options()).programs["float64"].kernels
    return {check.status for block in kernel.blocks for check in block.checks}


def test_u_of_what_no_row_holds_has_no_rank_to_test() -> None:
    """The axles may be parallel, where the rows depend on each other: u is right there."""
    model = load_text(BOARD.format(last="other: {acts_on: {h: 1}}"), "board.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    (kernel,) = program.kernels
    assert not [check for block in kernel.blocks for check in block.checks]
    assert not any(statement.operation in ("sincos", "div") for statement in kernel.statements)
    quarter = 1.5707963267948966
    state = State((0.0, 0.0, 0.3, 0.1, quarter, quarter), (0.0,) * 6, (1.0, 2.0, 3.0, 4.0, 5.0, 6.0), (), (6, 0.2, 0.1))
    (found,) = outcomes(kernel, program.sincos, "float64", [state])
    assert found.status == Status.OK
    assert found.entries == pytest.approx([0.02 * 7, 0.002 * 8, 0.002 * 9], rel=1e-15)


def test_an_input_on_what_rows_hold_keeps_their_test() -> None:
    assert Status.ACTUATION_RANK in statuses(BOARD.format(last="push: {acts_on: {x: cos(a), y: sin(a)}}"))


@pytest.mark.parametrize(("on", "kept"), [("a", ("first",)), ("y", ("second",)), ("s", ())])
def test_rows_of_blocks_that_an_input_acts_in_are_kept(on: str, kept: tuple[str, ...]) -> None:
    model = load_text(PAIR.format(on=on), "pair.yaml")
    found = where_inputs_act(model, genericity(System(model)))
    assert found is not None
    smaller, generic = found
    assert tuple(row.name for row in smaller.constraints) == kept
    assert (generic.r, generic.rank, generic.geometric_rank, generic.delta) == (len(kept),) * 3 + (5 - len(kept),)
    assert bool(statuses(PAIR.format(on=on))) == bool(kept)


def test_inputs_that_span_all_motions_keep_all_rows() -> None:
    """A crank that rows hold still, beside a driven one: methods for full actuation are shorter."""
    text = """
model: held
coordinates: {a: {unit: rad}, b: {unit: rad}}
kinetic_energy: a_dot**2/2 + b_dot**2/2
constraints: {geometric: {still: b - 0.5}}
inputs: {drive: {acts_on: {a: 1}}}
configuration: {b: 0.5}
"""
    model = load_text(text, "held.yaml")
    assert where_inputs_act(model, genericity(System(model))) is None
