"""Status 0 means within the tolerance, and a status that a measure is small: swept towards what is singular."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from pathlib import Path

import pytest
from rows_that_meet import wheels

from symgen.generation.runnable import SCALARS, STRESSED, RunnableKernels, rounded_state
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Scalar, Status
from symgen.laboratory.stress.families import search
from symgen.laboratory.stress.statuses.rule import Held, breaches, counted
from symgen.laboratory.stress.statuses.rule_states import CLOSEST, DECADES, Pushed, far_apart, towards_singular_sets
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.verify.reference.reference import Reference, State
from symgen.verify.running.compile import Outcome
from symgen.verify.tolerance import expectations

CASTORS = {
    "front": "cos(p)*e_dot + sin(p)*h_dot + reach*p_dot",
    "rear": "sin(s)*h_dot - cos(s)*e_dot + trail*sin(p)*s_dot",
}
LENGTHS = """reach: {value: 0.4, unit: m, range: [0.1, 1]}
  trail: {value: 0.25, unit: m, range: [0.1, 1]}"""

CRANK_AND_SWING = """
model: crank_and_swing
coordinates:
  first: {unit: rad}
  knee: {unit: rad}
  swing: {unit: rad}
parameters:
  a: {value: 0.3, unit: m, range: [0.2, 0.5]}
  b: {value: 0.7, unit: m, range: [0.5, 1]}
  c: {value: 0.6, unit: m, range: [0.4, 1]}
  far: {value: 0.8, unit: m, range: [0.5, 1]}
  m_b: {value: 1.5, unit: kg, range: [0.5, 2]}
  J_a: {value: 0.02, unit: kg*m**2, range: [0.01, 0.1]}
  J_c: {value: 0.05, unit: kg*m**2, range: [0.01, 0.1]}
kinetic_energy: >-
  J_a/2*first_dot**2 + J_c/2*swing_dot**2 + m_b/2*(a**2*first_dot**2 + b**2/3*(first_dot + knee_dot)**2
  + a*b*cos(knee)*first_dot*(first_dot + knee_dot))
potential_energy: m_b*9.81*(a*sin(first) + b/2*sin(first + knee))
constraints:
  geometric:
    along: a*cos(first) + b*cos(first + knee) - far - c*cos(swing)
    across: a*sin(first) + b*sin(first + knee) - c*sin(swing)
inputs:
  drive: {unit: N*m, acts_on: {first: 1}}
configuration: {first: 0.5, knee: 0.4, swing: 1.9}
"""


def castors(third: str = "") -> Model:
    """Two castors with lengths as parameters, and a third row that follows from theirs."""
    rows = CASTORS | ({"both": third} if third else {})
    return wheels("castors" if not third else "castors_and_bar", rows, parameters=LENGTHS)


SYSTEMS = {
    "castors": castors,
    "castors_and_bar": lambda: castors(f"2*({CASTORS['front']}) - ({CASTORS['rear']})"),
    "crank_and_swing": lambda: load_text(CRANK_AND_SWING, "crank_and_swing"),
}


def swept(model: Model, folder: Path, closest: int = CLOSEST, decades: Sequence[int] = DECADES) -> tuple[Held, ...]:
    """What is counted of a model towards its singular sets and with parameters far apart."""
    reference = Reference(model)
    pushed = chain(towards_singular_sets(search(reference), closest), far_apart(reference, 1, decades))
    return counted(reference, RunnableKernels(model, folder, STRESSED), pushed)


SWEPT = ["castors", *(pytest.param(name, marks=pytest.mark.campaign) for name in SYSTEMS if name != "castors")]


@pytest.mark.campaign
@pytest.mark.parametrize("name", SWEPT)
def test_float64_breaks_it_nowhere(name: str, tmp_path: Path) -> None:
    held = [one for one in swept(SYSTEMS[name](), tmp_path) if one.scalar == "float64"]
    assert [one.quantity for one in held if one.answered > one.states / 2] == [one.quantity for one in held]
    assert breaches(held) == ()


@pytest.mark.campaign
@pytest.mark.parametrize("name", SWEPT)
def test_float32_holds_it_towards_singular_sets_and_four_decades(name: str, tmp_path: Path) -> None:
    held = swept(SYSTEMS[name](), tmp_path, closest=12, decades=(1, 2, 4))
    assert breaches([one for one in held if one.scalar == "float32"]) == ()


def test_what_is_wrong_is_found(tmp_path: Path) -> None:
    """A kernel that is off by a millionth, and one that refuses everything."""
    reference = Reference(castors())
    states = [one for _, one in zip(range(3), far_apart(reference), strict=False)]

    class Off(RunnableKernels):
        def run(self, name: str, state: State, scalar: Scalar) -> Outcome:
            outcome = super().run(name, state, scalar)
            if name == "multipliers":
                return Outcome(2, outcome.entries)
            return Outcome(outcome.status, tuple(x * (1 + 1e-6) for x in outcome.entries))

    held = counted(reference, Off(reference.model, tmp_path), states)
    for one in held:
        if one.quantity == "multipliers":
            assert len(one.unexplained) == one.states > 0
        elif one.scalar == "float64":
            assert len(one.beyond) == one.answered > 0
    assert len(breaches(held)) >= len(SCALARS) + len(STRESSED) - 1


def test_states_go_to_singular_sets_and_far_apart() -> None:
    reference = Reference(castors())
    towards = list(towards_singular_sets(search(reference), closest=8))
    apart = list(far_apart(reference, decades=(9,)))
    assert all(isinstance(one, Pushed) for one in (*towards, *apart))
    assert {one.where.split()[0] for one in towards} & {"constraint", "input", "parameter"}
    names = [p.name for p in reference.model.parameters]
    moved = {one.where: one.state.parameters for one in apart}
    assert moved["mu times 1e9"][names.index("mu")] == pytest.approx(3e9)
    assert moved["trail times 1e-9"][names.index("trail")] == pytest.approx(2.5e-10)


LIGHT_BETWEEN_HEAVY = """
model: light_between_heavy
coordinates: {a: {unit: m}, b: {unit: m}, c: {unit: m}, d: {unit: m}}
parameters:
  light: {value: 1, unit: kg}
  heavy: {value: 1, unit: kg}
kinetic_energy: light/2*a_dot**2 + heavy/2*(b_dot**2 + c_dot**2 + d_dot**2)
constraints:
  geometric: {one: a + b + d - 1, other: 2*a + c - d - 2}
inputs: {push: {unit: N, acts_on: {d: 1}}}
outputs: [forward_dynamics, multipliers]
"""


def test_rows_that_masses_make_one_have_a_status() -> None:
    """Both rows ask for the acceleration of a light body: what they ask of heavy ones is below what a number holds."""
    model = load_text(LIGHT_BETWEEN_HEAVY, "light_between_heavy")
    reference = Reference(model)
    methods = dict.fromkeys(model.outputs, "schur_qr_refined")
    derived = derive_quantities(model, model.outputs, methods)
    programs = schedule(derived.mechanics, derived.quantities, SCALARS)
    cases: tuple[tuple[Scalar, float, int], ...] = (
        ("float32", 1e-6, 0),
        ("float32", 1e-14, 5),
        ("float64", 1e-14, 0),
        ("float64", 1e-31, 5),
    )
    for scalar, light, expected in cases:
        state = rounded_state(State((0.5,) * 4, (0.0,) * 4, (0.0,) * 4, (1.0,), (light, 1.0)), scalar)
        by_quantity = expectations(reference, state, model.outputs, scalar, "light")
        for kernel in programs[scalar].kernels:
            run = Interpreter(programs[scalar].sincos, scalar).run
            status, entries = run(kernel, {"q": state.q, "qd": state.qd, "u": state.u}, state.parameters)
            assert status == expected
            if not status:
                one = by_quantity[kernel.name]
                assert one.in_units(one.distance(entries)) <= 16


FAINT_ROW = """
model: faint_row
coordinates: {a: {unit: rad}, b: {unit: m}, c: {unit: m}, d: {unit: m}, e: {unit: m}}
parameters:
  m: {value: 2, unit: kg}
kinetic_energy: 1/2*a_dot**2 + m/2*(b_dot**2 + c_dot**2 + d_dot**2 + 2*e_dot**2) + b_dot*c_dot/3
constraints:
  nonholonomic:
    faint: sin(a)*(b_dot + 2*c_dot)
    one: b_dot + c_dot - d_dot + e_dot
    other: 4*cos(a)*b_dot + 3*c_dot - d_dot + e_dot
inputs: {push: {unit: N, acts_on: {d: 1}}, turn: {unit: N*m, acts_on: {a: 1}}}
outputs: [forward_dynamics, multipliers]
"""


@pytest.mark.parametrize("scalar", SCALARS)
def test_a_row_that_all_but_vanishes_is_no_lost_row(scalar: Scalar) -> None:
    """However short it is beside the others, what it holds is known.  Where one row follows from others is a status.

    With a = 0 the faint row is 0, and with cos(a) = 1/2 the last row is the sum of the directions of the others.
    """
    model = load_text(FAINT_ROW, "faint_row")
    reference = Reference(model)
    derived = derive_quantities(model, model.outputs, dict.fromkeys(model.outputs, "schur_qr"))
    program = schedule(derived.mechanics, derived.quantities, (scalar,))[scalar]
    regular, lost = (1.0, 1e-4, 1e-16, -1e-18), (0.0, math.pi / 3)
    cases = [*((a, Status.OK) for a in regular), *((a, Status.CONSTRAINT_RANK) for a in lost)]
    for a, expected in cases:
        state = rounded_state(State((a, 0.3, 0.2, 0.1, 0), (0.7, 0, 0, 0, 0), (0.0,) * 5, (1, 2), (2,)), scalar)
        for kernel in program.kernels:
            run = Interpreter(program.sincos, scalar).run
            status, entries = run(kernel, {"q": state.q, "qd": state.qd, "u": state.u}, state.parameters)
            assert status == expected, (kernel.name, a)
            if not status:
                one = expectations(reference, state, model.outputs, scalar, "faint")[kernel.name]
                assert one.in_units(one.distance(entries)) <= 16
