"""`trig_range`: where status 4 begins, from both sides of each limit, in both ranges and scalar types."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
import shipped

from symgen.backends.defaults import default_values
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Program, Scalar, Status
from symgen.lowering.schedule import schedule
from symgen.model.load import load_text
from symgen.quantities.select import derive_quantities

LIMITS: dict[tuple[str, Scalar], float] = {
    ("normal", "float64"): 1e5,
    ("normal", "float32"): 100.0,
    ("wide", "float64"): 1e7,
    ("wide", "float32"): 4e4,
}


@cache
def programs(trig_range: str) -> dict[Scalar, Program]:
    text = (shipped.ROOT / "models/front_car.yaml").read_text(encoding="utf-8")
    model = load_text(f"{text}\ntrig_range: {trig_range}\n", "front_car.yaml")
    derivations = derive_quantities(model, ("inverse_dynamics", "constraint_jacobian", "forward_dynamics"))
    return schedule(derivations.mechanics, derivations.quantities, shipped.SCALARS)


def test_the_range_is_normal_unless_told() -> None:
    assert shipped.model("front_car").trig_range == "normal"


@pytest.mark.parametrize(("trig_range", "scalar"), LIMITS)
@pytest.mark.parametrize("angle", [2, 3])
def test_both_sides_of_the_limit(trig_range: str, scalar: Scalar, angle: int) -> None:
    program = programs(trig_range)[scalar]
    interpreter = Interpreter(program.sincos, scalar)
    parameters = [float(value) for value in default_values(shipped.model("front_car")).values()]
    limit = np.dtype(scalar).type(LIMITS[trig_range, scalar])
    beyond = np.nextafter(limit, np.inf, dtype=scalar)
    for kernel in program.kernels:
        for sign in (-1.0, 1.0):
            for value, wanted in ((limit, Status.OK), (beyond, Status.ANGLE_RANGE), (np.nan, Status.ANGLE_RANGE)):
                state = {argument.name: [0.5] * argument.length for argument in kernel.arguments}
                state["q"][angle] = sign * float(value)
                assert interpreter.run(kernel, state, parameters)[0] is wanted, (kernel.name, value)


@pytest.mark.parametrize("scalar", shipped.SCALARS)
def test_far_angles_give_what_near_ones_give(scalar: Scalar) -> None:
    program = programs("wide")[scalar]
    (kernel,) = (kernel for kernel in program.kernels if kernel.name == "constraint_jacobian")
    interpreter = Interpreter(program.sincos, scalar)
    parameters = [float(value) for value in default_values(shipped.model("front_car")).values()]
    tolerance = 3e-15 if scalar == "float64" else 1e-6
    for far in (12_345.0, 39_999.0, *((9_999_999.0, 6_543_210.5) if scalar == "float64" else ())):
        near = math.atan2(math.sin(far), math.cos(far))
        (status, outputs), (_, wanted) = (
            interpreter.run(kernel, {"q": [0.0, 0.0, angle, 0.3]}, parameters) for angle in (far, near)
        )
        assert status is Status.OK
        assert outputs == pytest.approx(wanted, abs=tolerance)
