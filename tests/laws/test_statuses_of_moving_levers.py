"""Inputs whose moments act about points that move: how their columns are bounded is no drop of their rank."""

from __future__ import annotations

import math

import pytest
from laws_harness import System

from symgen.ir.kernel import Scalar, Status

HOOKS = ((0.3, 0.1, -0.2), (-0.2, 0.25, 0.1), (0.1, -0.3, 0.2), (-0.3, -0.1, -0.1), (0.2, 0.2, 0.3), (-0.1, 0.3, -0.3))
WINCHES = ((4, 0, 3), (-3, 4, 0), (0, -4, 3), (-4, -3, 1), (2, 3, 5), (-1, -2, -4))
OUTPUTS = ("inverse_dynamics", "actuator_mass_matrix")


def lifted() -> str:
    """A body on six ropes; its attitude is a quaternion."""
    points = [
        f"  w_{k}: {{at: {list(winch)}}}\n  h_{k}: {{frame: load, at: {list(hook)}}}\n"
        for k, (winch, hook) in enumerate(zip(WINCHES, HOOKS, strict=True))
    ]
    ropes = [f"  r_{k}: {{unit: N, cable: [h_{k}, w_{k}]}}\n" for k in range(len(HOOKS))]
    return (
        "model: lifted\njoints:\n  load: {type: floating, coordinates: [x, y, z, e0, e1, e2, e3]}\n"
        "bodies:\n  load: {mass: 3, inertia: {xx: 0.2, yy: 0.3, zz: 0.25}}\n"
        f"points:\n{''.join(points)}inputs:\n{''.join(ropes)}configuration: {{z: 0.5, e0: 1}}\n"
    )


@pytest.fixture(scope="module")
def ropes() -> System:
    return System(lifted(), OUTPUTS)


@pytest.mark.parametrize("scalar", ["float64", "float32"])
@pytest.mark.parametrize("far", [0.2, 2.0, 9.0])
def test_regular_states_have_results(ropes: System, far: float, scalar: Scalar) -> None:
    turn = (0.8, 0.3, -0.4, math.sqrt(1 - 0.64 - 0.09 - 0.16))
    state = ropes.state((far, -0.7 * far, 0.4 * far, *turn), scalar=scalar)
    ropes.assert_right(state, OUTPUTS, scalar)


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_ropes_that_meet_have_a_status(ropes: System, scalar: Scalar) -> None:
    # so far away all of them are parallel
    state = ropes.state((3e8, 2e8, -1e8, 0.8, 0.6, 0.0, 0.0), scalar=scalar)
    for name in OUTPUTS:
        assert ropes.run(name, state, scalar)[0] in (Status.ACTUATION_RANK, Status.NOT_FINITE)
