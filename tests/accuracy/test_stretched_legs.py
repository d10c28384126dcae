"""lambda keeps its digits where a leg of two links is all but stretched: their columns of B are all but alike."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from symgen.ir.kernel import Scalar
from symgen.lowering.schedule import schedule
from symgen.methods.forward_dynamics.absolute import in_absolute_angles
from symgen.methods.forward_dynamics.columns_apart import apart
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.model.load import load_text
from symgen.model.quantities import MOTIONS
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import Sample, rounded
from symgen.verify.tolerance import FACTOR, expectations

# A leg that ends on the rim of a heavy wheel: what holds it along itself is the sine of its knee.
LEG = """model: leg_on_a_wheel
parameters:
  thigh: {value: 0.31, range: [0.2, 0.5]}
  shin: {value: 0.43, range: [0.2, 0.5]}
  rim: {value: 0.25, range: [0.2, 0.5]}
  x: {value: 0.6}
  y: {value: 0.1}
  J: {value: 3000, range: [0.1, 1e6]}
coordinates: {hip: {unit: rad}, knee: {unit: rad}, wheel: {unit: rad}}
kinetic_energy: >-
  (0.02*hip_dot**2 + 0.7*thigh**2*hip_dot**2 + 0.4*shin**2*(hip_dot + knee_dot)**2
  + 0.6*thigh*shin*cos(knee)*hip_dot*(hip_dot + knee_dot) + J*wheel_dot**2)/2
constraints:
  geometric:
    along: thigh*cos(hip) + shin*cos(hip + knee) - x - rim*cos(wheel)
    across: thigh*sin(hip) + shin*sin(hip + knee) - y - rim*sin(wheel)
inputs: {muscle: {acts_on: {hip: 1}}}
outputs: [forward_dynamics, multipliers]
"""


@pytest.mark.parametrize("quantity", MOTIONS)
def test_results_hold_where_a_knee_is_all_but_straight(quantity: str) -> None:
    model = load_text(LEG, "leg.yaml")
    selection = derive_quantities(model, [quantity], {quantity: "schur_qr_refined"})
    scalars: tuple[Scalar, ...] = ("float64", "float32")
    programs = schedule(selection.mechanics, selection.quantities, scalars)
    reference = Reference(model)
    for scalar, knee in [("float64", 10.0**-k) for k in range(1, 9)] + [("float32", 10.0**-k) for k in range(1, 4)]:
        for turn in (0.4, 1.1, 2.3):
            shank, wheel = turn + knee, turn + 0.01
            tip = [0.31 * f(turn) + 0.43 * f(shank) - 0.25 * f(wheel) for f in (math.cos, math.sin)]
            given = State((turn, knee, wheel), (0.0, 0.0, 0.0), (0.0,) * 3, (2.0,), (0.31, 0.43, 0.25, *tip, 3000.0))
            state = rounded(Sample(given, True, (1.0, 1.0)), scalar).state
            expected = expectations(reference, state, (quantity,), scalar, "stretched")[quantity]
            program = programs[scalar]
            (kernel,) = (one for one in program.kernels if one.name == quantity)
            (made,) = outcomes(kernel, program.sincos, scalar, [state])
            assert made.valid
            assert expected.in_units(expected.distance(made.entries)) < FACTOR / 4


# Three links one behind the other, two more from the other side, and a slide: columns of each kind.
CHAINS = """model: chains
parameters: {l: {value: 0.4, range: [0.1, 1]}, k: {value: 0.3, range: [0.1, 1]}, J: {value: 2, range: [0.1, 10]}}
coordinates: {a: {unit: rad}, b: {unit: rad}, c: {unit: rad}, d: {unit: rad}, e: {unit: rad}, s: {unit: m}}
definitions:
  knee_x: l*cos(a) + k*cos(a + b)
  tip_x: knee_x + l*cos(a + b + c)
  tip_y: l*sin(a) + k*sin(a + b) + l*sin(a + b + c)
kinetic_energy: >-
  (J*(a_dot**2 + b_dot**2 + c_dot**2 + 2*d_dot**2 + e_dot**2) + 3*s_dot**2
  + 0.1*cos(b)*a_dot*b_dot + 0.2*cos(c)*b_dot*c_dot + 0.1*cos(e)*d_dot*e_dot)/2
constraints:
  geometric:
    along: tip_x - 1 - k*cos(d) - l*cos(d + e)
    across: tip_y - k*sin(d) - l*sin(d + e)
    bar: 0.6*s + 0.8*tip_x - tip_y
inputs: {push: {acts_on: {s: 1}}}
outputs: [multipliers]
configuration: {a: 1.9, b: -1.0, c: -0.5, d: 2.3, e: -1.1, s: 0.0}
"""


# A thigh that is bent: its column has two terms, and no factor in common with that of the shin.
BENT = LEG.replace("along: thigh*cos(hip)", "along: thigh*cos(hip) - 0.03*sin(hip)").replace(
    "across: thigh*sin(hip)", "across: thigh*sin(hip) + 0.03*cos(hip)"
)


@pytest.mark.parametrize("text", [LEG, CHAINS, BENT], ids=["leg", "chains", "bent"])
def test_they_are_the_same_equations(text: str) -> None:
    mechanics = in_absolute_angles(load_text(text, "model.yaml"))
    assert mechanics is not None
    problem = Problem(mechanics, ())
    separated = apart(problem)
    assert separated is not None
    n, r = problem.n, problem.r
    graph, source = mechanics.graph, random.Random(1)
    unknown = tuple(graph.symbol(f"x_{j}") for j in range(n))
    brought = separated.brought_back(Motion(unknown, (), ())).accelerations
    names = [str(symbol.payload) for symbol in (*mechanics.q, *mechanics.qd, *unknown)]
    point = {name: source.uniform(-2, 2) for name in (*names, "u_1", "push", "muscle")}
    point |= {p.name: 0.3 + 0.1 * i for i, p in enumerate(mechanics.model.parameters)}
    evaluate = Evaluator([*brought, *flatten(problem.mass_matrix), *flatten(problem.rows), *problem.force,
                          *flatten(separated.mass_matrix), *flatten(separated.rows), *separated.force])
    turn = np.zeros((n, n))
    for j in range(n):
        axis = {str(x.payload): float(i == j) for i, x in enumerate(unknown)}
        values = np.array(evaluate(point | axis))
        turn[:, j] = values[:n]
    whole, rows, force, whole_apart, rows_apart, force_apart = np.split(
        values[n:], np.cumsum([n * n, r * n, n, n * n, r * n])
    )
    assert not np.allclose(turn, np.eye(n))
    assert whole_apart.reshape(n, n) == pytest.approx(turn.T @ whole.reshape(n, n) @ turn, abs=1e-12)
    assert rows_apart.reshape(r, n) == pytest.approx(rows.reshape(r, n) @ turn, abs=1e-12)
    assert force_apart == pytest.approx(turn.T @ force, abs=1e-12)
    assert separated.bias == problem.bias


def test_nothing_is_divided_by_that_may_be_0() -> None:
    free = LEG.replace("shin: {value: 0.43, range: [0.2, 0.5]}", "shin: {value: 0.43, range: [-0.1, 0.5]}")
    mechanics = in_absolute_angles(load_text(free, "leg.yaml"))
    assert mechanics is not None
    assert apart(Problem(mechanics, ())) is None
