"""Results beside a drop of rank stay within the tolerance: nothing that becomes small there is multiplied out."""

from __future__ import annotations

from pathlib import Path

import pytest
from rows_that_meet import beside, wheels

from symgen.generation.runnable import SCALARS, STRESSED, RunnableKernels
from symgen.ir.kernel import Status
from symgen.laboratory.stress.method_kernels import MethodKernels
from symgen.laboratory.stress.statuses.rule import of_more_draws
from symgen.model.model import Model
from symgen.verify.reference.reference import Reference
from symgen.verify.tolerance import FACTOR, expectations

ONE = "cos(p)*e_dot + sin(p)*h_dot + 0.3*p_dot"
OTHER = "cos(s)*e_dot + sin(s)*h_dot + 0.3*p_dot"
SUM = f"({ONE}) + ({OTHER})"
APART = (1.0, 1e-2, 1e-4, 1e-6)
STABLE = ("minor", "schur_qr", "nullspace", "householder", "elimination")

SYSTEMS = {
    "two_wheels": {"left": ONE, "right": OTHER},
    "three_wheels": {"left": ONE, "right": OTHER, "both": SUM},
    "wheels_and_knife": {"left": ONE, "right": OTHER, "knife": "e_dot - 2*h_dot + 0.4*s_dot"},
}


@pytest.mark.parametrize(
    "name",
    ["three_wheels", *(pytest.param(name, marks=pytest.mark.campaign) for name in ("two_wheels", "wheels_and_knife"))],
)
def test_no_digit_is_lost_twice(name: str, tmp_path: Path) -> None:
    model = wheels(name, SYSTEMS[name])
    generated = RunnableKernels(model, tmp_path, STRESSED)
    methods = MethodKernels(model, tmp_path, generated.names)
    assert _beyond(model, generated, methods) == []


def _beyond(model: Model, generated: RunnableKernels, methods: MethodKernels) -> list[str]:
    """What is beyond the tolerance with status 0; each kernel has to answer at most states."""
    reference, breaches = Reference(model), list[str]()
    for scalar in SCALARS:
        for apart in APART:
            for seed in range(3):
                state = beside(reference, apart, seed, scalar)
                expected = expectations(reference, state, generated.names, scalar, f"{apart} {seed}")
                outcomes = {name: generated.run(name, state, scalar) for name in generated.names}
                answered = {name: one.entries for name, one in outcomes.items() if one.status == Status.OK}
                assert answered or (scalar == "float32" and apart < 1e-5)
                results = [("generated", *one) for one in answered.items()]
                for label, name, entries in methods.run(state, scalar):
                    if entries is not None and label.removeprefix("method ") in STABLE:
                        results.append((label, name, tuple(entries)))
                for label, name, entries in results:
                    one = expected[name]
                    if not one.in_units(one.distance(entries)) <= FACTOR:
                        one = of_more_draws(reference, state, name, scalar, f"{apart} {seed}", one)
                    units = one.in_units(one.distance(entries))
                    if not units <= FACTOR:
                        breaches.append(f"{label} {name} {scalar} at {apart}: {units:.3g}")
    return breaches
