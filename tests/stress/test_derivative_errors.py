"""Derivatives of the paper's formulas are those of the kernel where no choice fails, and lose them where one does."""

from __future__ import annotations

import math

import pytest
import shipped

from symgen.laboratory.slopes.errors import DerivativeErrors, derivative_errors
from symgen.laboratory.slopes.page import derivatives_page
from symgen.laboratory.stress.families import Family
from symgen.laboratory.stress.series import FIXED, PARTITION, SYMGEN
from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference, State


@pytest.mark.campaign
def test_a_stretched_arm_costs_formulas_with_a_choice_their_digits() -> None:
    """With links in line the angles of the third arm say nothing of the second direction: loops need not be closed."""
    model = shipped.model("rapkm_2rrr_rr")
    selection = derive_quantities(model, ("admissible_velocity", "admissible_acceleration"))
    velocity, acceleration = (Evaluator(one.outputs) for one in selection.quantities)
    mechanics, parameters = selection.mechanics, parameter_values(System(model))
    names = [str(node.payload) for node in mechanics.motion]
    n = model.n

    def state(d: float) -> State | None:
        if d not in (1.0, 1e-6):
            return None
        point = {name: math.sin(1.7 * k + 0.3) for k, name in enumerate(names)} | {"b_3": d} | parameters
        qd = list(velocity(point))
        qdd = list(acceleration(point | dict(zip(names[n : 2 * n], qd, strict=True))))
        given = tuple(parameters[parameter.name] for parameter in model.parameters)
        return State(tuple(point[name] for name in names[:n]), tuple(qd), tuple(qdd), (0.0,) * model.m, given)

    family = Family("parameter", "sin b₃", "b₃", (state,), ((0, 1), (0, 3)), ((0, 1),))
    made = derivative_errors(model, Reference(model), family)
    errors = {one.method: dict(one.errors) for one in made}
    assert all(errors[method][1.0] < 1e-9 for method in (PARTITION, FIXED, SYMGEN))
    assert errors[SYMGEN][1e-6] < 1e-13
    assert errors[PARTITION][1e-6] > 1e-3
    assert errors[FIXED][1e-6] > 1e-3


def test_the_page_shows_the_family_nearest_to_rounding() -> None:
    distances = [10 ** (-k / 2) for k in range(25)]

    def family(symgen: float) -> tuple[DerivativeErrors, ...]:
        lost = tuple((d, 1e-15 / d**2 if d > 1e-9 else math.inf) for d in distances)
        return DerivativeErrors(PARTITION, lost), DerivativeErrors(SYMGEN, tuple((d, symgen) for d in distances))

    text, chart = derivatives_page("some", {"far": family(1e-12), "near": family(3e-16)})
    assert "Towards near = 0" in text
    assert "| near = 0 | (9) fixed partition | 1e-15 | 1e-11 | 1e-07 | 1e-03 | 1e+01 | none | none |" in text
    assert "| near = 0 | symgen | 3e-16 | 3e-16" in text
    assert "<svg" in chart
