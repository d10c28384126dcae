"""The CasADi witness of allocated inputs: another derivation, the same numbers as the reference."""

from __future__ import annotations

import allocation_models as models
import pytest
from laws_harness import System

from symgen.verify.sampling.states import sample_states
from symgen.witness.casadi_derivation import witness_functions

CASES = {
    "axis": (models.AXIS, "weights: {right: 3}, preload: 0.7, limits: {left: [-1, 1], right: [-0.5, 0.7]}"),
    "plate": (models.PLATE, "weights: {p: 0.5}, limits: {p: [-0.4, 0.4], s: [-0.3, 0.3]}"),
    "skid": (models.SKID, "weights: {q_1: 0.2, v: 3}, preload: {p: 1.5, v: -0.8}"),
    "lame": (models.LAME, "weights: {left: 3}, preload: {right: 2}"),
    "cranks": (models.CRANKS, "weights: {A: 3}, preload: {C: 2}"),
    "robot": (
        models.parallel_robot(),
        "weights: {drive_2: 3}, preload: -0.2, limits: {drive_1: [-0.3, 0.3], drive_3: [-0.2, 0.2]}",
    ),
    "within limits": (models.CRANKS, "weights: {A: 3}, limits: {A: [-1, 1], B: [-1, 0.2], C: [-0.3, 1]}"),
}


@pytest.mark.parametrize("name", CASES)
def test_witness_and_reference_agree(name: str) -> None:
    text, block = CASES[name]
    made = System(f"{text}allocation: {{{block}}}\n", ("inverse_dynamics",))
    function = witness_functions(made.model)["inverse_dynamics"]
    for sample in sample_states(made.reference, ["inverse_dynamics"], 8):
        state = sample.state
        wanted = [float(x) for x in made.reference.evaluate(state, ["inverse_dynamics"])["inverse_dynamics"]]
        parts = {"q": state.q, "qd": state.qd, "qdd": state.qdd, "u": state.u, "p": state.parameters}
        u = function(*(list(parts[argument]) for argument in function.name_in())).full().ravel()
        size = max(map(abs, wanted))
        assert list(u) == pytest.approx(wanted, rel=1e-9, abs=1e-9 * size)
