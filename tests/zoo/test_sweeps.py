"""Sweeps of draws: states reach what is singular, and what violates the rule of statuses is counted."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.laboratory.zoo import sweeps
from symgen.laboratory.zoo.approach import Approach
from symgen.laboratory.zoo.campaign import Campaign
from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import read_description
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.sweep_campaign import one_sweep, record_of, table, write_violations
from symgen.laboratory.zoo.sweeps import ANSWERED, BEYOND, UNEXPLAINED, UNKNOWN, LedState, compared, sweep
from symgen.laboratory.zoo.witness.generated import Answer, Target
from symgen.laboratory.zoo.witness.kkt import GenericRanks
from symgen.laboratory.zoo.witness.results import JudgedResult
from symgen.laboratory.zoo.witness.states import FloatState, rounded
from symgen.laboratory.zoo.witness.witness import Witness
from symgen.model.load import load_text
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.tolerance import FACTOR, expectations

FOUR_BAR = """
model: four_bar
joints:
  crank: {type: revolute, axis: z, coordinate: a}
  coupler: {type: revolute, axis: z, parent: crank, at: [0.3, 0, 0], coordinate: b}
  rocker: {type: revolute, axis: z, at: [0.8, 0.6, 0], coordinate: c}
bodies:
  crank: {mass: 1, com: [0.15, 0, 0], inertia: {zz: 0.1}}
  coupler: {mass: 2, com: [0.45, 0, 0], inertia: {zz: 0.1}}
  rocker: {mass: 1, com: [0.3, 0, 0], inertia: {zz: 0.1}}
points: {end: {frame: coupler, at: [1.1, 0, 0]}, tip: {frame: rocker, at: [0.4, 0, 0]}}
loops: {pin: {type: point, between: [end, tip]}}
inputs: {u: {joint: a}}
configuration: {a: 1.5, b: -1.1, c: 1.4}
"""
# the angle of the base
BASE = math.atan2(0.6, 0.8)


def led_on(text: str, kind: str) -> tuple[dict[int, np.ndarray], Approach]:
    """The nearest decades that a walk from regular states reaches, with their configurations."""
    witness = Witness(text)
    walker, defaults = witness.walker(), witness.defaults()
    starts, ranks = walker.states(defaults, 3)
    approach = Approach(walker, defaults, ranks, walker.points(defaults, 40))
    reached = {
        decade: q
        for start in (*(state.q for state in starts), *approach.nearest(kind, 3))
        for decade, q in approach.towards(kind, start, Dice("approach"))
    }
    return reached, approach


def test_a_four_bar_reaches_its_flat_pose() -> None:
    """Crank and coupler are 1.4 long together, as base and rocker are: rows lose rank where all lie along the base."""
    reached, approach = led_on(FOUR_BAR, "rows")
    assert set(range(1, 7)) <= set(reached)
    for decade, q in reached.items():
        assert math.floor(-math.log10(approach.distance("rows", q) or 1)) == decade
    deepest = reached[max(reached)]
    assert np.abs(np.sin(deepest - BASE * np.array([1, 0, 1]))).max() < 1e-4


def test_a_crank_reaches_its_dead_point() -> None:
    """The input of the rocker moves nothing where crank and coupler lie along one line."""
    text = FOUR_BAR.replace("at: [0.3, 0, 0]", "at: [0.25, 0, 0]").replace("joint: a}", "joint: c}")
    reached, _ = led_on(text, "inputs")
    assert set(range(1, 12)) <= set(reached)
    assert abs(math.sin(reached[max(reached)][1])) < 1e-9


def test_a_row_vanishes_where_a_parallelogram_is_flat() -> None:
    """Its directions do not: rows of length 1 keep their rank there."""
    text = """
model: parallelogram
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}}
kinetic_energy: a_dot**2 + b_dot**2 + c_dot**2
constraints: {geometric: {x: cos(a) + 2*cos(c) - 2 - cos(b), y: sin(a) + 2*sin(c) - sin(b)}}
configuration: {a: 0.8, b: 0.8, c: 0}
"""
    reached, approach = led_on(text, "lengths")
    deepest = reached[max(reached)]
    assert max(reached) >= 6
    assert abs(math.sin(deepest[0])) < 1e-5
    assert (approach.distance("rows", deepest) or 0) > 0.1


def test_inertias_are_no_singular_set() -> None:
    reached, _ = led_on(FOUR_BAR, "masses")
    assert set(reached) == {0}


SLIDE = """model: slide
coordinates: {x: {unit: m}}
parameters: {m: 3, k: 2}
kinetic_energy: m/2*x_dot**2
potential_energy: k/2*x**2
inputs: {u: {acts_on: {x: 1}}}
outputs: [inverse_dynamics]
configuration: {x: 0.4}
"""


def kernel(scalar: str, change: Callable[[FloatState, float], Answer]) -> Target:
    """u of the slide, as `change` has it."""

    def call(_quantity: str, state: FloatState, _count: int) -> Answer:
        m, k = state.parameters
        exact = m * state.qdd[0] + k * state.q[0]
        return change(state, rounded((exact,), scalar)[0])

    return Target(f"C {scalar}", scalar, ("inverse_dynamics",), ("m", "k"), call)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """What a run tells of the slide."""
    derivation = {"sizes": {"alpha": 1, "r": 0}, "blocks": []}
    (tmp_path / "derivation.json").write_text(json.dumps(derivation), encoding="utf-8")
    return tmp_path


def swept(
    folder: Path, monkeypatch: pytest.MonkeyPatch, change: Callable[[FloatState, float], Answer]
) -> sweeps.SweepCounts:
    """The sweep of a kernel of the slide."""
    both = [kernel(scalar, change) for scalar in ("float64", "float32")]
    monkeypatch.setattr(sweeps, "targets", lambda *_: both)
    return sweep(read_description(SLIDE, {"x": 0.4}), folder)


def test_an_honest_kernel_violates_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tally = swept(folder, monkeypatch, lambda _, u: Answer(0, (u,)))
    assert tally.violations == ()
    # m is scaled, k is neither a mass nor a length
    assert tally.counts["parameters", "float32", ANSWERED] == len(sweeps.EXPONENTS)
    assert tally.counts["inputs", "float64", ANSWERED] > 0


def test_an_error_with_status_0_is_found(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(state: FloatState, u: float) -> Answer:
        return Answer(0, (u * (1 + (1e-4 if state.parameters[0] > 1e6 else 0)),))

    tally = swept(folder, monkeypatch, wrong)
    assert {(one.kind, one.where, one.target) for one in tally.violations} == {
        ("parameters", f"m times 1e{exponent}", f"C {scalar}")
        for exponent in (6, 9)
        for scalar in ("float64", "float32")
    }
    assert tally.of(BEYOND) == 4
    assert "units, relative error 1.0e-04" in tally.violations[0].text
    write_violations(folder / "violations.json", tally)
    (first, *_) = json.loads((folder / "violations.json").read_text())
    assert first["state"]["parameters"][0] == 3e6


def test_a_status_at_a_clear_state_is_counted(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tally = swept(folder, monkeypatch, lambda at, u: Answer(5 * (at.parameters[0] < 1e-5), (u,)))
    assert tally.of(UNEXPLAINED) == tally.of("mass rank") == 4
    assert "mass rank although clear" in tally.violations[0].text


def test_where_the_truth_is_singular_there_is_none(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Many digits do not tell every state from a drop of rank: it is counted, and ends no sweep."""

    def lost(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(Witness, "_truth", lost)
    tally = swept(folder, monkeypatch, lambda _, u: Answer(0, (u,)))
    assert tally.of(UNKNOWN) > 0
    assert tally.of(UNKNOWN) == sum(tally.counts.values())


def test_a_status_beside_a_singular_set_is_not(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    witness = Witness(SLIDE)
    witness.opened(folder)
    monkeypatch.setattr(sweeps, "targets", lambda *_: [kernel("float64", lambda *_: Answer(2, ()))])
    state = FloatState((0.4,), (0.1,), (0.2,), (1.0,), (3.0, 2.0))
    for distance, unexplained in ((1.0, 1), (1e-6, 0)):
        tally = compared(witness, folder, "slide", [LedState("lengths", "beside", state, GenericRanks(0, 1), distance)])
        assert tally.of("constraint rank") == 1
        assert tally.of(UNEXPLAINED) == unexplained


def test_a_coordinate_out_of_its_range_is_a_reason_of_its_own(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Within the range that the file states, or where it states none, a kernel has to answer."""
    monkeypatch.setattr(sweeps, "targets", lambda *_: [kernel("float64", lambda *_: Answer(13, ()))])
    state = FloatState((0.4,), (0.1,), (0.2,), (1.0,), (3.0, 2.0))
    for ranges, unexplained in (("", 1), ("ranges: {x: [0.1, 0.5]}\n", 1), ("ranges: {x: [0.1, 0.3]}\n", 0)):
        witness = Witness(SLIDE + ranges)
        witness.opened(folder)
        tally = compared(witness, folder, "slide", [LedState("lengths", "beside", state, GenericRanks(0, 1), 1e-6)])
        assert tally.of("coordinate range") == 1
        assert tally.of(UNEXPLAINED) == unexplained


@pytest.mark.parametrize(("units", "outcome"), [(2.0, [ANSWERED, BEYOND]), (0.5, [ANSWERED])])
def test_the_tolerance_is_that_of_regular_states_wherever_it_is_met(units: float, outcome: list[str]) -> None:
    assert list(sweeps._outcomes(JudgedResult(0, units, 3e4, 1e-12, False), True)) == outcome


def test_records_are_told_and_summed_up(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tally = swept(folder, monkeypatch, lambda _, u: Answer(0, (u * 1.1,)))
    record = record_of(7, 3, "slides", "verified", tally)
    assert record.line.startswith("7:3 slides: ")
    assert f"{tally.of(BEYOND)} beyond the tolerance, 0 statuses unexplained" in record.line
    text = table([record, record_of(7, 4, "slides", "refused", sweeps.SweepCounts({}))])
    assert text.startswith("1 of 2 draws swept")
    (row,) = (line.split() for line in text.splitlines() if line.startswith("parameters float64"))
    assert row[2:] == ["6", *["0"] * len(sweeps.STATUSES), "0", "6", "0"]


@pytest.mark.campaign
def test_a_draw_is_swept(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("gcc")
    record, line = one_sweep(Campaign(2001, tmp_path), 22)
    assert record.violations == ()
    assert record.swept.of(ANSWERED) > 100
    assert "0 beyond the tolerance" in line
    assert not (tmp_path / "2001_22").exists()


RING = """
model: ring
parameters: {a: {value: 0.4}, m: {value: 2}}
gravity: [0, 0, -9.81]
frames:
  end: {parent: r_5, translation: [a, 0, 0], rotation: [[x, pi/2]]}
  dock: {translation: ["-a", 0, 0], rotation: [[x, pi/2]]}
joints:
  r_1: {type: revolute, axis: z, coordinate: t_1}
  r_2: {type: revolute, axis: z, parent: r_1, at: [a, 0, 0], rotation: [[x, pi/2]], coordinate: t_2}
  r_3: {type: revolute, axis: z, parent: r_2, at: [a, 0, 0], rotation: [[x, "-pi/2"]], coordinate: t_3}
  r_4: {type: revolute, axis: z, parent: r_3, at: [a, 0, 0], rotation: [[x, pi/2]], coordinate: t_4}
  r_5: {type: revolute, axis: z, parent: r_4, at: [a, 0, 0], rotation: [[x, "-pi/2"]], coordinate: t_5}
bodies:
  r_1: {mass: m, com: [a/2, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
  r_3: {mass: 3, com: [a/2, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
loops: {ring: {type: revolute, between: [end, dock]}}
inputs: {u: {joint: t_1}}
outputs: [inverse_dynamics]
configuration: {t_1: 1.12, t_2: -1.87913, t_3: 1.12, t_4: -1.87913, t_5: 1.12}
"""


@pytest.mark.campaign
def test_inputs_of_dependent_rows_hold_the_rule_towards_a_dead_point() -> None:
    """Determinants that are 0 on V hold a rounding beside it: at a dead point they are as large as the others."""
    model = load_text(RING, "ring.yaml")
    reference, programs = Reference(model), draft_of(model, model.outputs, Options()).programs
    reached, _ = led_on(RING, "inputs")
    walker, defaults = Witness(RING).walker(), Witness(RING).defaults()
    answered = 0
    for decade, q in reached.items():
        nearest = walker.refined(q, defaults)
        assert nearest is not None
        exact_state = walker.state(nearest, defaults)
        for scalar, program in programs.items():
            parts = (exact_state.q, exact_state.qd, exact_state.qdd, exact_state.u, exact_state.parameters)
            state = State(*(rounded(part, scalar) for part in parts))
            (made,) = outcomes(program.kernels[0], program.sincos, scalar, [state])
            if made.valid:
                truth = expectations(reference, state, ["inverse_dynamics"], scalar, f"ring {decade}")
                expected = truth["inverse_dynamics"]
                assert expected.in_units(expected.distance(made.entries)) <= FACTOR, (decade, scalar)
                answered += 1
    assert max(reached) >= 10
    assert answered >= 8


BENNETT = """
model: bennett
parameters: {a: {value: 0.3}, b: {value: a*sin(1.7)/sin(1.2)}}
frames:
  end: {parent: r_3, translation: [a, 0, 0], rotation: [[x, 1.2]]}
  dock: {translation: ["-b", 0, 0], rotation: [[x, -1.7]]}
joints:
  r_1: {type: revolute, axis: z, coordinate: t_1}
  r_2: {type: revolute, axis: z, parent: r_1, at: [a, 0, 0], rotation: [[x, 1.2]], coordinate: t_2}
  r_3: {type: revolute, axis: z, parent: r_2, at: [b, 0, 0], rotation: [[x, 1.7]], coordinate: t_3}
bodies: {r_1: {mass: 1, com: [a/2, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}}
loops: {ring: {type: revolute, between: [end, dock]}}
inputs: {u: {joint: t_3}}
configuration: {t_1: 2.1, t_2: 2.32187, t_3: -2.1}
"""


def test_a_state_that_refinement_leads_elsewhere_is_none() -> None:
    """Where a row of the linkage all but vanishes, what rounding leaves of it passes for a direction."""
    reached, _ = led_on(BENNETT, "lengths")
    walker, defaults = Witness(BENNETT).walker(), Witness(BENNETT).defaults()
    states, ranks = walker.states(defaults, 3)
    places = [*(state.q for state in states), *reached.values()]
    # how small the row is beside the others, and so how many directions it seems to hold, differs among processors
    one_more = [walker.refined(q, defaults, ranks.geometric + 1) for q in places]
    assert any(q is None for q in one_more)
    for q in (*one_more, *(walker.refined(q, defaults) for q in places)):
        if q is not None:
            assert np.abs(walker.numbers(q, defaults).residual).max() < 1e-13


def test_what_closes_but_for_the_last_digits_of_the_file_is_a_state() -> None:
    """Two rows for one angle, whose numbers are rounded: the steep one leaves as many times that to the other."""
    description = draw(21001, 359, None)
    witness = Witness(description.text, description.start, description.text, description.files)
    states, ranks = witness.walker().states(witness.defaults(), 3)
    assert len(states) == 3
    assert ranks.geometric == 1
