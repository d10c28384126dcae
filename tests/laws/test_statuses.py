"""What kernels say at singular states, beyond the range of angles and for values that are no numbers."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, inf, isfinite, nan, pi, sin

import pytest
import special_texts as texts
from laws_harness import System, shipped_system, system
from linkages import row_of_four_bars

from symgen.ir.kernel import Scalar, Status
from symgen.verify.reference.reference import State

SCALARS: tuple[Scalar, ...] = ("float64", "float32")
EPS = {"float64": 2.0**-53, "float32": 2.0**-24}
MOTION = ("inverse_dynamics", "forward_dynamics", "multipliers", "nullspace_projector")
MODELS = ("skate", "front_car", "rear_car", "rapkm_two_drives", "slider_crank", "double_pendulum")


@pytest.mark.parametrize("scalar", SCALARS)
def test_rear_car_with_wheels_across_has_no_inverse_dynamics(scalar: Scalar) -> None:
    car = shipped_system("rear_car")
    for turned in (pi / 2, -pi / 2, 3 * pi / 2):
        state = car.state([0.1, 0.2, 0.3, turned], scalar=scalar)
        for name in ("inverse_dynamics", "projected_control_pseudoinverse", "actuator_mass_matrix", "actuator_bias"):
            assert car.run(name, state, scalar)[0] is Status.ACTUATION_RANK, name
        # B keeps its rank: forward dynamics, multipliers and the projector do not mind
        for name in ("forward_dynamics", "multipliers", "nullspace_projector"):
            assert car.run(name, state, scalar)[0] is Status.OK, name
    assert car.run("inverse_dynamics", car.state([0.1, 0.2, 0.3, 1.5], scalar=scalar), scalar)[0] is Status.OK


def _stretched_arm(name: str, distance: float, scalar: Scalar) -> tuple[System, State]:
    """The mechanism with the third arm stretched but for `distance`, which the first two drives cannot hold."""
    given = shipped_system(name)
    values = dict(zip((p.name for p in given.model.parameters), given.state([0.0] * 6).parameters, strict=True))
    l_1, l_2 = values["l_1"], values["l_2"]
    # the tip on the ray from the third base towards the other two
    heading = -1.7
    reach = (l_1**2 + l_2**2 + 2 * l_1 * l_2 * cos(distance)) ** 0.5
    lead = _lead(l_1, l_2, reach)
    tip = (values["x_3"] + reach * cos(heading), values["y_3"] + reach * sin(heading))
    angles = [_arm(tip, values[f"x_{i}"], values[f"y_{i}"], l_1, l_2) for i in (1, 2)]
    q = [angles[0][0], angles[1][0], heading - lead, angles[0][1], angles[1][1], distance]
    return given, given.state(q, scalar=scalar)


def _lead(l_1: float, l_2: float, reach: float) -> float:
    return acos(max(-1.0, min(1.0, (l_1**2 + reach**2 - l_2**2) / (2 * l_1 * reach))))


def _arm(tip: tuple[float, float], x: float, y: float, l_1: float, l_2: float) -> tuple[float, float]:
    reach = hypot(tip[0] - x, tip[1] - y)
    elbow = acos((reach**2 - l_1**2 - l_2**2) / (2 * l_1 * l_2))
    return atan2(tip[1] - y, tip[0] - x) - _lead(l_1, l_2, reach), elbow


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("count", [2, 4])
def test_loops_in_a_row_are_lost_where_one_of_them_is(count: int, scalar: Scalar) -> None:
    """What is divided by is one factor for each loop: their product is nothing long before one of them is."""
    row = system(row_of_four_bars(count, "0.4", "0.3"), ("inverse_dynamics",))
    for angle in (0.1, 1e-3, 1e-4):
        row.assert_right(row.state([angle] * (count + 1) + [0.0] * count, scalar=scalar), ["inverse_dynamics"], scalar)
    # the driven crank cannot turn the others out of the line, nor out of what is rounded to it
    for angle in (0.0, EPS[scalar]):
        flat = row.state([angle] * (count + 1) + [0.0] * count, scalar=scalar)
        assert row.run("inverse_dynamics", flat, scalar)[0] in (Status.ACTUATION_RANK, Status.CONSTRAINT_RANK)


@pytest.mark.parametrize("scalar", SCALARS)
def test_two_drives_lose_the_mechanism_where_the_third_arm_is_stretched(scalar: Scalar) -> None:
    given, state = _stretched_arm("rapkm_two_drives", 0.0, scalar)
    assert given.run("inverse_dynamics", state, scalar)[0] is Status.ACTUATION_RANK
    assert given.run("forward_dynamics", state, scalar)[0] is Status.OK
    given, near = _stretched_arm("rapkm_two_drives", 0.01, scalar)
    given.assert_right(near, ["inverse_dynamics", "forward_dynamics"], scalar)
    # the third drive makes the difference
    three, same = _stretched_arm("rapkm_2rrr_rr", 0.0, scalar)
    three.assert_right(same, MOTION, scalar)


@pytest.mark.parametrize("scalar", SCALARS)
def test_equal_links_with_the_slider_at_the_crank(scalar: Scalar) -> None:
    given = system(texts.EQUAL_LINKS)
    folded = given.state([0.0, 0.0, 0.8], scalar=scalar)
    given.assert_right(folded, ["nullspace_projector", "inverse_dynamics", "forward_dynamics"], scalar)
    # pi/2 itself is no number of the scalar type: the second row is tiny, yet known to full relative accuracy
    across = given.state([pi / 2, -pi / 2, 0.0], scalar=scalar)
    given.assert_right(across, ["nullspace_projector", "constraint_pseudoinverse"], scalar)


FOUR_BAR = """
# The ground link is inclined: near the change points both rows stay long and become parallel.
model: parallelogram
coordinates: {a: {}, b: {}, c: {}}
parameters: {l: 0.4, w: 0.7, slope: 0.5}
kinetic_energy: a_dot**2/2 + b_dot**2/3 + c_dot**2
constraints:
  geometric:
    loop_x: l*cos(a) + w*cos(b) - l*cos(c) - w*cos(slope)
    loop_y: l*sin(a) + w*sin(b) - l*sin(c) - w*sin(slope)
inputs: {T: {acts_on: {a: 1}}}
independent_velocities: [a]
configuration: {a: 1.2, b: 0.5, c: 1.2}
"""


@pytest.mark.parametrize("scalar", SCALARS)
def test_a_four_bar_at_its_change_point_is_singular(scalar: Scalar) -> None:
    given = system(FOUR_BAR)
    for angle in (0.5, 0.5 + pi):
        state = given.state([angle, 0.5, angle], scalar=scalar)
        for name in given.names:
            status, _ = given.run(name, state, scalar)
            kernel = given.kernel(name, scalar)
            constrained = any(
                check.status is Status.CONSTRAINT_RANK for block in kernel.blocks for check in block.checks
            )
            if constrained:
                assert status is Status.CONSTRAINT_RANK, name
        # a failing rank of the inputs looks for its cause first
        assert given.run("inverse_dynamics", state, scalar)[0] is Status.CONSTRAINT_RANK
    near = given.state([0.51, 0.5, 0.51], scalar=scalar)
    given.assert_right(near, ["inverse_dynamics", "forward_dynamics", "nullspace_projector"], scalar)


def test_statuses_follow_the_measure_of_singularity() -> None:
    for scalar in SCALARS:
        low, high = (3 * EPS[scalar]) ** 2, (3e3 * EPS[scalar]) ** 2
        given = system(FOUR_BAR)
        seen = set()
        for exponent in range(-58, 0):
            angle = 2.0**exponent
            state = given.state([0.5 + angle, 0.5, 0.5 + angle], scalar=scalar)
            (measure,), _ = given.matrix("singularity", state, scalar)
            status, _ = given.run("nullspace_projector", state, scalar)
            if measure < low:
                assert status is Status.CONSTRAINT_RANK
            elif measure > high:
                assert status is Status.OK
            seen.add(status)
        assert seen == {Status.OK, Status.CONSTRAINT_RANK}


@pytest.mark.parametrize(("scalar", "limit"), [("float64", 1e5), ("float32", 100.0)])
def test_angles_are_refused_beyond_their_range(scalar: Scalar, limit: float) -> None:
    skate = shipped_system("skate")
    for name in ("nullspace_projector", "inverse_dynamics", "forward_dynamics"):
        assert skate.run(name, skate.state([limit, 0, 0], scalar=scalar), scalar)[0] is Status.OK
        beyond = skate.state([-limit * 1.0001, 0, 0], scalar=scalar)
        assert skate.run(name, beyond, scalar)[0] is Status.ANGLE_RANGE
    # what does not enter is not tested
    assert skate.run("mass_matrix", skate.state([10 * limit, 0, 0], scalar=scalar), scalar)[0] is Status.OK
    assert skate.run("nullspace_projector", skate.state([0.3, inf, nan], scalar=scalar), scalar)[0] is Status.OK


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("model", MODELS)
def test_no_number_never_passes(model: str, scalar: Scalar) -> None:
    given = shipped_system(model)
    n = len(given.model.coordinates)
    good = given.state([0.4 + 0.1 * i for i in range(n)], scalar=scalar)
    for name in sorted({*MOTION, "singularity", "energy"}.intersection(given.names)):
        for load in given.kernel(name, scalar).loads:
            for bad in (nan, inf, -inf, 1e38):
                parts = {"q": good.q, "qd": good.qd, "qdd": good.qdd, "u": good.u, "p": good.parameters}
                values = list(parts[load.argument])
                values[load.index] = bad
                parts[load.argument] = tuple(values)
                state = State(parts["q"], parts["qd"], parts["qdd"], parts["u"], parts["p"])
                status, outputs = given.run(name, state, scalar)
                assert status is not Status.OK or all(map(isfinite, outputs)), (name, load.local, bad)
                if load.argument != "p":
                    assert isfinite(bad) or status is not Status.OK, (name, load.local, bad)


VANISHING_MASS = """
model: vanishing_mass
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: (x_dot*sin(y))**2 + y_dot**2 + z_dot**2/1e6
CONSTRAINT
inputs: {push: {acts_on: {x: 1}}, pull: {acts_on: {y: 1}}}
"""


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("constraint", ["", "constraints: {nonholonomic: {row: z_dot - y_dot*cos(x)}}"])
def test_motion_without_mass_has_no_acceleration(constraint: str, scalar: Scalar) -> None:
    given = system(VANISHING_MASS.replace("CONSTRAINT", constraint))
    state = given.state([0.4, 0.0, 0.2], scalar=scalar)
    assert given.run("forward_dynamics", state, scalar)[0] is Status.MASS_RANK
    assert given.run("inverse_dynamics", state, scalar)[0] is Status.OK
    # a small mass beside a large one is no reason to refuse
    given.assert_right(given.state([0.4, 0.01, 0.2], scalar=scalar), ["forward_dynamics", "inverse_dynamics"], scalar)
