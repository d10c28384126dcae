"""Where numbers of a file hide how far off a kernel is, worst states are judged."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.ir.kernel import Kernel
from symgen.model.load import load_text
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.sampling.judged import numbers_hide
from symgen.verify.sampling.searched import WorstStateSearch
from symgen.verify.sampling.states import Sample, rounded
from symgen.verify.tolerance import FACTOR, GrowingUnit

# A link that is pinned where an arm turns on it: its length is given twice, and no kernel knows that it may be two.  A
# heavy slide on the arm cannot move, as its end is pinned, too.
PINNED_TWICE = """
model: pinned_twice
gravity: [0, -9.81, 0]
joints:
  east: {type: prismatic, axis: x, coordinate: x}
  north: {type: prismatic, parent: east, axis: y, coordinate: y}
  link: {type: revolute, parent: north, axis: z, coordinate: a}
  arm: {type: revolute, parent: link, at: [0.69, 0, 0], axis: z, coordinate: b}
  slide: {type: prismatic, parent: arm, at: [0, -0.35, 0], axis: y, coordinate: s}
bodies:
  east: {mass: 2.8}
  north: {mass: 1.7}
  link: {mass: 5.3, com: [0.345, 0, 0], inertia: {zz: 0.28}}
  arm: {mass: 3.2, inertia: {zz: 0.29}}
  slide: {mass: 1000, inertia: {zz: 0.1}}
points:
  tip: {frame: link, at: [0.69, 0, 0]}
  pin: {at: [1.3, 1.43, 0]}
  end: {frame: slide, at: [-0.2, 0.81, 0]}
  other: {at: [1.9, 0.76, 0]}
loops:
  one: {type: point, between: [tip, pin]}
  two: {type: point, between: [end, other]}
inputs: {push: {joint: x}}
configuration: {a: 0.4, b: -1.9, s: 0.42, x: 0.66, y: 1.16}
outputs: [forward_dynamics]
"""

ROD = """
model: rod
parameters: {l: {value: 0.69}, r: {value: 0.43}, c: {value: 0.35}, x: {value: 0.81}, y: {value: 0.25}}
gravity: [0, -9.81, 0]
joints:
  arm: {type: revolute, axis: z, coordinate: a}
  fore: {type: revolute, parent: arm, at: [l, 0, 0], axis: z, coordinate: b}
bodies:
  arm: {mass: 5, com: [l/2, 0, 0], inertia: {zz: 0.25}}
  fore: {mass: 3, com: [r/2, 0, 0], inertia: {zz: 0.25}}
points: {tip: {frame: fore, at: [r, 0, 0]}, pin: {at: [x, y, 0]}}
loops: {rod: {type: distance, between: [tip, pin], length: c}}
outputs: [forward_dynamics]
"""


@pytest.mark.campaign
def test_what_numbers_given_twice_do_to_units_hides_no_worst_state() -> None:
    """Moved apart they make the unit eighty times what arguments make it, but for a few states: there it is small."""
    model = load_text(PINNED_TWICE, "pinned_twice.yaml")
    programs = draft_of(model, model.outputs, Options()).programs
    (kernel,), (single,) = programs["float64"].kernels, programs["float32"].kernels
    expected = Expected(model, model.outputs, 32, lambda _: None)
    expected.values("float32")
    errors, search = RoundingErrors(kernel), WorstStateSearch(expected)
    assert numbers_hide(expected, kernel, errors)
    made = search._estimated(kernel, errors)
    estimated = search._brought(kernel, made.states, made.estimated, 40)
    assert _largest_in_float32(expected, single, estimated) < FACTOR
    search.look(kernel.name, "its method", lambda: kernel)
    assert search.largest(single, programs["float32"].sincos, "float32") > 4 * FACTOR


def _largest_in_float32(expected: Expected, kernel: Kernel, samples: Sequence[Sample]) -> float:
    units = []
    for sample in samples:
        state = rounded(sample, "float32").state
        unit = GrowingUnit(expected.reference, state, kernel.name, "float32", "a state")
        units.append(unit.units_above(outcomes(kernel, None, "float32", [state])[0].entries, 0.0))
    return max(units)


@pytest.mark.campaign
def test_numbers_hide_nothing_where_lengths_are_parameters() -> None:
    model = load_text(ROD, "rod.yaml")
    (kernel,) = draft_of(model, model.outputs, Options()).programs["float64"].kernels
    expected = Expected(model, model.outputs, 16, lambda _: None)
    expected.values("float32")
    assert not numbers_hide(expected, kernel, RoundingErrors(kernel))
