"""The unit of error d + eps |y*|: what roundings of the inputs do, whichever way they go."""

from __future__ import annotations

import random
from itertools import combinations

import numpy as np
import pytest

from symgen.model.load import load_text
from symgen.verify.expected import Expected
from symgen.verify.reference.reference import REFERENCE_BITS, VANISHING, Reference, State
from symgen.verify.tolerance import PERTURBATIONS, PERTURBED_BITS, _set_apart, _signs, expectations

# Two cranks that a rod of the length of their distance keeps at one angle: its rows depend on each other there.
CRANKS = """\
model: cranks
coordinates: {a: {unit: rad}, b: {unit: rad}}
parameters: {l: {value: 0.83}, m: {value: 1.9}}
kinetic_energy: (0.17 + m*l**2)/2*a_dot**2 + 0.17/2*b_dot**2
constraints:
  geometric:
    x: l*cos(a) - l*cos(b)
    y: l*sin(a) - l*sin(b)
inputs: {u: {acts_on: {a: 1}}}
outputs: [inverse_dynamics_residual]
configuration: {a: -1.1, b: -1.1}
"""


def state(a: float, b: float) -> State:
    return State((a, b), (0.3, 0.3), (0.7, 0.7), (0.0,), (0.83, 1.9), ())


@pytest.mark.parametrize("beside", [0.0, 1.0])
def test_numbers_of_equal_size_move_apart_both_ways(beside: float) -> None:
    """Up to what they are rounded by: from one unit in the last place apart, one way leads to the other side of 0."""
    reference = Reference(load_text(CRANKS, "cranks.yaml"))
    b = float(np.nextafter(-1.1, -2.0)) if beside else -1.1
    for seed in range(40):
        drawn = _signs(reference, state(-1.1, b), random.Random(seed))
        assert len(drawn) == PERTURBATIONS
        assert {(0, 1), (1, 0)} <= {tuple(signs[:2]) for signs in drawn}
        made = expectations(reference, state(-1.1, b), ["inverse_dynamics_residual"], "float64", str(seed))
        known = made["inverse_dynamics_residual"]
        # what is 0 on the constraints is within the tolerance
        assert known.in_units(known.distance([0.0, 0.0])) < 1


def test_what_vanishes_is_worked_out_with_no_more_digits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of one direction that is driven nothing is left, and no number of digits shows a share of that."""
    text = CRANKS.replace("x: l*cos(a) - l*cos(b)", "x: sin(a) + l*b").replace("    y: l*sin(a) - l*sin(b)\n", "")
    reference = Reference(load_text(text.replace("a: -1.1, b: -1.1", "a: 0, b: 0"), "cranks.yaml"))
    used: set[int] = set()
    matrices = Reference.matrices

    def counted(self: Reference, at: State, names: list[str], bits: int, *literals: list[object]) -> dict[str, object]:
        used.add(bits)
        return matrices(self, at, names, bits, *literals)

    monkeypatch.setattr(Reference, "matrices", counted)
    residual, inputs = "inverse_dynamics_residual", "inverse_dynamics"
    known = expectations(reference, state(-1.1, -0.9), [residual, inputs], "float64", "")
    assert known[residual].size < VANISHING < known[inputs].size
    assert max(used - {REFERENCE_BITS}) == PERTURBED_BITS


def test_literals_of_equal_value_move_apart_both_ways() -> None:
    """What 3 and -3 leave of a row may be all there is of it."""
    text = CRANKS.replace("x: l*cos(a) - l*cos(b)", "x: l*cos(a) - l*cos(b) + 3*(l + 7) - 3*l - 3*7")
    reference = Reference(load_text(text, "cranks.yaml"))
    values = [literal.value for literal in reference.system.literals]
    pairs = [(i, j) for j, x in enumerate(values) for i in range(j) if values[i] == x]
    assert len(pairs) > 3
    for seed in range(40):
        drawn = _signs(reference, state(-1.1, -0.9), random.Random(seed))
        literals = [signs[-len(values) :] for signs in drawn]
        missing = [pair for pair in pairs if not {(0, 1), (1, 0)} <= {tuple(s[k] for k in pair) for s in literals}]
        # where three are equal a pair may lack one way
        assert all(values.count(values[i]) > 2 for i, _ in missing)


# 0.4 cos a + 0.2 sin 2 a and its first two derivatives vanish together at a = -pi/2: so do roundings of both numbers.
CREST = """\
model: crest
coordinates: {a: {unit: rad}, b: {unit: rad}}
parameters: {m: {value: 1.9}}
kinetic_energy: m/2*a_dot**2 + m/2*b_dot**2
inputs: {u: {acts_on: {a: 1}}, v: {acts_on: {b: 1}}}
task: {height: 0.4*cos(a) + 0.2*sin(2*a), side: b}
outputs: [configuration_from_task]
"""


def test_any_two_numbers_move_together_and_apart() -> None:
    """Changes in which two happen to agree each time say nothing of what lies between them, and d is luck."""
    reference = Reference(load_text(CREST, "crest.yaml"))
    a = -np.pi / 2 + 1e-3
    there = float(0.4 * np.cos(a + 1e-5) + 0.2 * np.sin(2 * a + 2e-5))
    start = State((a, 0.3), (0.1, 0.2), (0.0, 0.0), (0.0, 0.0), (1.9,), (there, 0.3))
    units = []
    for seed in range(40):
        dice = random.Random(seed)
        numbers = [*zip(*_set_apart(_signs(reference, start, dice), dice), strict=True)]
        for pair in combinations(numbers, 2):
            assert len({a ^ b for a, b in zip(*pair, strict=True)}) == 2
        made = expectations(reference, start, ["configuration_from_task"], "float64", str(seed))
        units.append(made["configuration_from_task"].unit)
    assert max(units) < 3 * min(units)


# Three links that end at a pin, which stands twice in the file, and one more whose task leaves directions open.
TWICE = """\
model: twice
joints:
  j_1: {type: revolute, axis: z, coordinate: a}
  j_2: {type: revolute, parent: j_1, at: [0.4, 0, 0], axis: z, coordinate: b}
  j_3: {type: revolute, parent: j_2, at: [0.7, 0, 0], axis: z, coordinate: c}
  j_4: {type: revolute, parent: j_3, at: [0.51, 0, 0], axis: z, coordinate: d}
bodies:
  j_1: {mass: 1.9, inertia: {zz: 0.1}}
  j_2: {mass: 1.1, inertia: {zz: 0.1}}
  j_3: {mass: 0.7, inertia: {zz: 0.1}}
  j_4: {mass: 0.3, inertia: {zz: 0.1}}
points:
  tip_0: {frame: j_3, at: [0.51, 0, 0]}
  pin_0: {at: [0.93, 0.77, 0]}
  tip_1: {frame: j_3, at: [0.51, 0, 0]}
  pin_1: {at: [0.93, 0.77, 0]}
loops:
  loop_0: {type: point, between: [tip_0, pin_0]}
  loop_1: {type: point, between: [tip_1, pin_1]}
inputs: {u: {joint: a}}
task: {height: 0.51*sin(c + d)}
outputs: [configuration_from_task]
configuration: {a: 0.1, b: 0.5, c: 0.6, d: 1.1}
"""


@pytest.mark.campaign
@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_loops_that_stand_twice_have_a_unit_of_error(scalar: str) -> None:
    """Their numbers moved apart no configuration closes both, and there would be no value beside any state."""
    model = load_text(TWICE, "twice.yaml")
    expected = Expected(model, ["configuration_from_task"], 8, lambda _: None)
    assert len(expected.values(scalar)) == len(expected.samples(scalar)) == 8
    eps = 2.0**-24 if scalar == "float32" else 2.0**-53
    for made in expected.values(scalar):
        (one,) = made.values()
        assert eps * one.size < one.unit < 1e4 * eps * one.size
