"""Second derivatives of w^T u along a direction: rules on the graph, differences of the reference, and CasADi agree."""

from __future__ import annotations

import random

import numpy as np
import pytest
import shipped

from symgen.mechanics.genericity import parameter_values
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference, State
from symgen.witness.casadi_derivation import witness_functions

PRODUCT = "inverse_dynamics_hessian_product"


@pytest.mark.parametrize("name", ["rapkm_2rrr_rr", "front_car", "rolling_disc", "delta", "double_pendulum"])
def test_three_ways_to_second_derivatives_agree(name: str) -> None:
    model = shipped.model(name)
    selection = derive_quantities(model, (PRODUCT,))
    mechanics, dice = selection.mechanics, random.Random(name)
    q, qd, qdd = ([dice.uniform(0.3, 1.1) for _ in range(model.n)] for _ in range(3))
    weights = [dice.uniform(-1, 1) for _ in range(model.m)]
    usual = parameter_values(mechanics)
    p = [usual[one.name] for one in model.parameters]
    # the direction that verification takes of a state
    direction = [*qd, *qdd, *q]
    symbols = (*mechanics.motion, *(x for part in mechanics.further("w_u", "v_x") for x in part))
    given = [*q, *qd, *qdd, *weights, *direction]
    place = {str(symbol.payload): value for symbol, value in zip(symbols, given, strict=True)}
    (derived,) = selection.quantities
    by_rules = np.array(Evaluator(derived.outputs)(usual | place))
    state = State(tuple(q), tuple(qd), tuple(qdd), tuple(weights), tuple(p))
    by_differences = np.array([float(x.mid()) for x in Reference(model).evaluate(state, (PRODUCT,))[PRODUCT]])
    values = [float(x) for x in p]
    by_casadi = witness_functions(model)[PRODUCT](q, qd, qdd, weights, direction, values).full()[:, 0]
    size = np.linalg.norm(by_differences)
    assert size > 1e-3
    assert np.linalg.norm(by_rules - by_differences) < 1e-13 * size
    assert np.linalg.norm(by_casadi - by_differences) < 1e-11 * size


def test_differences_hold_fifty_digits_and_more() -> None:
    """At half as many digits again the reference's second differences stay as they are to far beyond a float64."""
    model = shipped.model("double_pendulum")
    reference, dice = Reference(model), random.Random(7)
    parts = [tuple(dice.uniform(0.3, 1.1) for _ in range(k)) for k in (2, 2, 2, model.m, len(model.parameters))]
    state = State(*parts)
    few, many = (reference.matrices(state, (PRODUCT,), bits)[PRODUCT].entries() for bits in (520, 780))
    largest = max(abs(float(x)) for x in many)
    assert max(abs(float(a.mid() - b.mid())) for a, b in zip(few, many, strict=True)) < 1e-60 * largest
