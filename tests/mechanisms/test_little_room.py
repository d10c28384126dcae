"""Configurations where there is little room, far from the origin, turns away, or on one of several branches."""

from __future__ import annotations

import math

import pytest

from symgen.closedform.forms import derive_closed_forms
from symgen.diagnostics import ModelError
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.verify.reference.configurations.manifold import ManifoldRanks
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.states import VerificationError, sample_states

LATCH = """\
model: latch
coordinates: {{p: {{unit: rad}}, q: {{unit: rad}}, s: {{unit: rad}}}}
parameters: {{base: {base}}}
kinetic_energy: p_dot**2/5 + q_dot**2/7 + s_dot**2/9
constraints:
  geometric:
    along: {along}*(0.8*cos(p) + 0.3*cos(q) + 0.4*cos(s) - base)
    across: {across}*(0.8*sin(p) + 0.3*sin(q) + 0.4*sin(s))
inputs: {{turn: {{acts_on: {{p: 1}}}}}}
{rest}
"""


def latch(base: str, along: str = "1", across: str = "1", rest: str = "") -> Model:
    """A four-bar linkage of bars 0.8, 0.3, 0.4 on a base, stretched for a base of 1.5."""
    return load_text(LATCH.format(base=base, along=along, across=across, rest=rest), "latch.yaml")


@pytest.mark.parametrize("slack", ["1e-2", "1e-4", "1e-6"])
@pytest.mark.parametrize("start", ["", "configuration: {p: 0, q: 0, s: 0}"])
def test_a_linkage_that_is_all_but_stretched_moves(slack: str, start: str) -> None:
    model = latch(f"1.5 - {slack}", rest=start)
    assert model.assembly is not None
    assert model.assembly.regular
    assert (model.assembly.ranks.constraints, model.assembly.ranks.actuation) == (2, 1)
    reach = math.sqrt(2 * float(slack) / 0.3) * 1.5
    states = sample_states(Reference(model), ("inverse_dynamics",), 12)
    assert len(states) >= 8
    assert all(abs(math.remainder(x, math.tau)) < reach + 1e-3 for sample in states for x in sample.state.q[:2])


def test_a_linkage_that_closes_stretched_only_is_refused_with_the_row_that_loses_rank() -> None:
    with pytest.raises(ModelError, match=r"only singular configurations.*there `along` loses rank"):
        latch("1.5")


def test_a_loop_that_cannot_close_is_told_with_its_gap() -> None:
    with pytest.raises(ModelError, match=r"`along` stays at -0.25 "):
        latch("1.75")


def test_a_rod_that_is_too_short_is_told_with_the_length_it_would_need() -> None:
    text = """\
model: short_rod
joints:
  crank: {type: revolute, axis: z, coordinate: a}
  lever: {type: revolute, at: [2, 0, 0], axis: z, coordinate: b}
bodies: {crank: {mass: 1, inertia: {zz: 0.1}}, lever: {mass: 1, inertia: {zz: 0.1}}}
parameters: {l: 0.2}
gravity: [0, -9.81, 0]
points: {p: {frame: crank, at: [0.5, 0, 0]}, q: {frame: lever, at: [0.4, 0, 0]}}
loops: {rod: {type: distance, between: [p, q], length: 2*l}}
"""
    with pytest.raises(ModelError, match=r"`rod_length` stays at 1.05, a length of 1.1 in place of 0.4,"):
        load_text(text, "rod.yaml")


def test_a_ring_far_away_in_other_units_has_as_many_states_as_are_asked_for() -> None:
    """Where a thousandth of the coordinates is more than the ring is wide."""
    text = """\
model: bead_on_a_ring
coordinates: {east: {range: [539997, 540003]}, north: {range: [5.399997e+6, 5.400003e+6]}}
kinetic_energy: (east_dot**2 + north_dot**2)/2
constraints: {geometric: {ring: 1e-4*((east - 540000)**2 + (north - 5.4e+6)**2 - 4)}}
inputs: {push: {acts_on: {east: 1}}}
"""
    states = sample_states(Reference(load_text(text, "ring.yaml")), ("inverse_dynamics", "forward_dynamics"), 16)
    assert len(states) == 16


def test_a_small_circle_has_states_all_around() -> None:
    text = """\
model: grain
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: (x_dot**2 + y_dot**2 + z_dot**2)/2
constraints: {geometric: {ball: x**2 + y**2 + z**2 - 4e-8, plane: 1e5*(x - y)}}
inputs: {push: {acts_on: {x: 1}}}
"""
    states = sample_states(Reference(load_text(text, "grain.yaml")), ("inverse_dynamics",), 16)
    heights = [sample.state.q[2] for sample in states]
    assert len(states) == 16
    assert min(heights) < -1e-4 < 1e-4 < max(heights)


SCISSORS = """\
model: lazy_tongs
joints:
  foot: {type: prismatic, axis: x, coordinate: w}
  left_0: {type: revolute, axis: z, coordinate: a_0}
  right_0: {type: revolute, parent: foot, axis: z, coordinate: b_0}
  left_1: {type: revolute, parent: right_0, at: [0.6, 0, 0], axis: z, coordinate: a_1}
  right_1: {type: revolute, parent: left_0, at: [0.6, 0, 0], axis: z, coordinate: b_1}
bodies:
  left_0: {mass: 1, com: [0.3, 0, 0], inertia: {zz: 0.03}}
  right_0: {mass: 1, com: [0.3, 0, 0], inertia: {zz: 0.03}}
  left_1: {mass: 1, com: [0.3, 0, 0], inertia: {zz: 0.03}}
  right_1: {mass: 1, com: [0.3, 0, 0], inertia: {zz: 0.03}}
points:
  l_0: {frame: left_0, at: [0.3, 0, 0]}
  r_0: {frame: right_0, at: [0.3, 0, 0]}
  l_1: {frame: left_1, at: [0.3, 0, 0]}
  r_1: {frame: right_1, at: [0.3, 0, 0]}
loops: {pin_0: {type: point, between: [l_0, r_0]}, pin_1: {type: point, between: [l_1, r_1]}}
gravity: [0, -9.81, 0]
inputs: {push: {joint: w}}
"""


def test_angles_that_newton_turns_are_turned_back_into_their_ranges() -> None:
    """Without a start the branch that moves is found, although all bars folded together close, too."""
    model = load_text(SCISSORS, "tongs.yaml")
    assert model.assembly is not None
    assert (model.assembly.ranks.constraints, model.assembly.ranks.actuation) == (4, 1)
    angles = [x for place in model.assembly.places for x in place.q[1:]]
    assert all(abs(x) <= math.pi + 1e-9 for x in angles)


def test_angles_of_gears_are_not_turned_back() -> None:
    """Whole turns of one wheel are none of the other: they stay where the row holds."""
    text = """\
model: gears
coordinates: {big: {unit: rad}, small: {unit: rad, range: [-20, 20]}, arm: {unit: rad}}
kinetic_energy: big_dot**2 + small_dot**2 + arm_dot**2
constraints: {geometric: {teeth: 2.5*big - small, rod: cos(big) - cos(arm)}}
inputs: {turn: {acts_on: {small: 1}}}
"""
    model = load_text(text, "gears.yaml")
    assert model.assembly is not None
    for big, small, arm in (place.q for place in model.assembly.places):
        assert 2.5 * big == pytest.approx(small)
        assert math.cos(big) == pytest.approx(math.cos(arm))


def test_a_start_on_a_branch_where_inputs_span_less_is_not_said_to_be_far_from_closing() -> None:
    """Two equal bars on a slide that can also turn together where the slide stands still."""
    text = """\
model: equal_bars_on_a_slide
coordinates: {a: {unit: rad}, b: {unit: rad}, s: {}}
kinetic_energy: a_dot**2 + b_dot**2 + s_dot**2
constraints: {geometric: {x: 0.6*cos(a) + 0.6*cos(b) - s, y: 0.6*sin(a) + 0.6*sin(b)}}
inputs: {push: {acts_on: {s: 1}}}
configuration: {a: 0.9, b: -2.2415926535897931, s: 0}
"""
    model = load_text(text, "slide.yaml")
    said = [notice.message for notice in model.notices]
    assert model.assembly is not None
    assert model.assembly.ranks.actuation == 1
    assert any(text.startswith("another branch of configurations (a = 0.9, b = -2.24, s = 0)") for text in said)
    assert not any("far from it" in text for text in said)


def test_closed_forms_find_their_configurations_in_any_units_of_rows() -> None:
    """From a singular start, with rows 1e16 apart."""
    model = latch("1.3", along="1e-9", across="1e7", rest="configuration: {p: 0.3, q: -0.7, s: -0.4}")
    structure = derive_closed_forms(model).structure
    assert (structure.constraint_rank, structure.degree_of_actuation) == (2, 1)


def test_where_too_few_states_are_found_it_is_told_what_became_of_the_others() -> None:
    """For the ranks of a linkage of one row less, as if all of it were another branch."""
    reference = Reference(latch("1.3"), ManifoldRanks(constraints=1, geometric=1, actuation=1))
    with pytest.raises(VerificationError, match=r"only 0 regular configurations.*others looked at .* lie on other"):
        sample_states(reference, ("inverse_dynamics",), 8)
