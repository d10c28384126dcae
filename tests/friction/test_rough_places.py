"""What rough places are, how many steps their loads take, and what is refused by name."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from laws_harness import System

from symgen.ir.kernel import Scalar, Status
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System as Mechanics
from symgen.model.availability import lacking
from symgen.model.configurations.friction_shares import friction_shares
from symgen.model.configurations.friction_steps import LEFT_OF_LOADS, friction_steps, steps_for
from symgen.model.load import load_text
from symgen.model.quantities import ROWS
from symgen.quantities.select import requested

# Turns in space before and after the joints, a slide that stands oblique in its parent, a drive for each.
ARM = """\
model: arm
gravity: [0, 0, -9.81]
parameters: {l: 0.3, m: {value: 1.5, range: [0.5, 3]}, J: {value: 0.01, range: [0.005, 0.02]}, mu: {value: 0.1}}
joints:
  base: {type: revolute, axis: z, coordinate: a}
  upper: {type: revolute, parent: base, at: [0, 0, l], rotation: [[x, pi/2]], axis: z, coordinate: b}
  slide: {type: prismatic, parent: upper, at: [l, 0, 0], rotation: [[y, 0.3]], axis: x, coordinate: s}
  wrist: {type: revolute, parent: slide, at: [l, 0, 0], rotation: [[z, 0.2], [x, pi/3]], axis: y, coordinate: c}
bodies:
  base: {mass: m, inertia: {zz: J}}
  upper: {mass: m, com: [l/2, 0, 0], inertia: {xx: J, yy: J, zz: J}}
  slide: {mass: m, com: [0.1, 0, 0], inertia: {xx: J, yy: J, zz: J}}
  wrist: {mass: m, com: [0.1, 0.05, 0], inertia: {xx: J, yy: J, zz: J}}
friction:
  base: {coulomb: mu, radius: 0.02, width: 0.1}
  upper: {coulomb: mu, radius: 0.02, width: 0.1}
  slide: {coulomb: mu, width: 0.01}
  wrist: {coulomb: mu, radius: 0.01, width: 0.1}
inputs: {A: {joint: a}, B: {joint: b}, S: {joint: s}, C: {joint: c}}
ranges: {s: [-0.1, 0.2]}
"""
# A cart on two wheels in a row, whose bearings carry what the tyres press along it and a share of the weight.
CART = """\
model: cart
parameters: {R: 0.1, m: {value: 10, range: [5, 20]}, J: {value: 0.05, range: [0.01, 0.1]}, mu: 0.2, g: 9.81}
coordinates: {x: {unit: m}, front: {unit: rad}, rear: {unit: rad}}
joints:
  cart: {type: prismatic, at: [0, 0, R], axis: x, coordinate: x}
  front_wheel: {type: revolute, parent: cart, at: [0.4, 0, 0], axis: y, coordinate: front}
  rear_wheel: {type: revolute, parent: cart, axis: y, coordinate: rear}
bodies: {cart: {mass: m}, front_wheel: {mass: 0, inertia: {yy: J}}, rear_wheel: {mass: 0, inertia: {yy: J}}}
rolling: {front_tyre: {frame: front_wheel, radius: R}, rear_tyre: {frame: rear_wheel, radius: R}}
friction:
  front_bearing: {coulomb: mu, radius: 0.01, width: 0.1, reaction: [front_tyre_along], rate: front_dot, load: m*g/3}
  rear_bearing: {coulomb: mu, radius: 0.01, width: 0.1, reaction: [rear_tyre_along], rate: rear_dot, load: 2*m*g/3}
inputs: {motor: {joint: rear}}
"""
PENDULUM = """\
model: pendulum
gravity: [0, -9.81, 0]
parameters: {l: 0.3, m: 1, J: 0.001, mu: 0.1}
joints: {hinge: {type: revolute, coordinate: a}}
bodies: {hinge: {mass: m, com: [l, 0, 0], inertia: {zz: J}}}
friction: {hinge: {coulomb: mu, radius: 0.02, width: 0.1}}
inputs: {motor: {joint: a}}
outputs: [inverse_dynamics, forward_dynamics]
"""
QUANTITIES = ("inverse_dynamics", "friction_residual", "forward_dynamics")
CASES = {"arm": ARM, "cart": CART, "pendulum": PENDULUM}


@cache
def system(name: str) -> System:
    return System(CASES[name], QUANTITIES)


def states(made: System, count: int, scalar: Scalar) -> list[object]:
    source = np.random.default_rng(count)
    ranges = [[float(x) for x in c.range] for c in made.model.coordinates]
    return [
        made.state([source.uniform(*x) for x in ranges], scalar=scalar, qd=source.uniform(-2, 2, len(ranges)).tolist())
        for _ in range(count)
    ]


@pytest.mark.campaign
@pytest.mark.parametrize("scalar", ["float64", "float32"])
@pytest.mark.parametrize("name", CASES)
def test_kernels_agree_with_the_reference(name: str, scalar: Scalar) -> None:
    made = system(name)
    names = QUANTITIES if name != "arm" else QUANTITIES[:2]
    for state in states(made, 6, scalar):
        assert max(made.errors(state, names, scalar).values()) <= 1


def test_a_pin_of_a_pendulum_by_hand() -> None:
    """R = m (c'' - g), friction mu rho |R| tanh: explicit, in both directions."""
    made = system("pendulum")
    for a, rate, acceleration in ((0.3, 1.0, -2.0), (2.0, -0.4, 5.0), (-1.2, 0.02, 30.0)):
        state = made.state([a], [rate], [acceleration])
        radial, tangential = -0.3 * rate**2 + 9.81 * np.sin(a), 0.3 * acceleration + 9.81 * np.cos(a)
        friction = 0.1 * 0.02 * np.hypot(radial, tangential) * np.tanh(rate / 0.1)
        ((u,),) = made.matrix("inverse_dynamics", state)
        assert u == pytest.approx((0.001 + 0.09) * acceleration + 0.3 * 9.81 * np.cos(a) + friction, rel=1e-13)
        ((back,),) = made.matrix("forward_dynamics", made.state([a], [rate], [0.0], [u]))
        assert back == pytest.approx(acceleration, rel=1e-12)


def test_what_drives_turn_presses_nothing() -> None:
    """The friction of a joint that a drive of its own turns adds to this drive alone: no steps."""
    model = system("arm").model
    assert model.friction_steps is not None
    assert model.friction_steps.explicit
    assert model.friction_steps.kappa < 1e-12
    assert model.motion_steps is not None
    assert model.motion_steps.steps > 1


def test_shares_at_loading_are_those_of_kernels() -> None:
    """Floats and one linear system on one hand, minors and reflections of scalars on the other."""
    from symgen.methods.spaces import along_minors, along_reflections
    from symgen.model.configurations.mechanics import default_values
    from symgen.symbolic.evaluate import Evaluator

    model = system("cart").model
    assert model.assembly is not None
    shares = friction_shares(model, model.assembly, False)
    mechanics = Mechanics(model)
    generic = genericity(mechanics)
    for derivation in (along_minors(mechanics, generic), along_reflections(mechanics, generic)):
        assert not isinstance(derivation, str)
        assert derivation.friction is not None
        ((guard,),) = [[x for x in derivation.friction.guards if x.status is Status.FRICTION_LOCK]]
        point = default_values(model.parameters) | {c.name: 0.2 for c in model.coordinates}
        fast = {c.rate: 50.0 for c in model.coordinates}
        (excess,) = Evaluator([guard.denominator])(point | fast)
        kappa = max(sum(row) for row in shares[0])
        assert excess == 0
        assert 0 < kappa < 0.5
        more = point | fast | {"mu": 1.5 * 0.2 / kappa / 2}
        assert Evaluator([guard.denominator])(more)[0] == pytest.approx(0.75 - 0.5, rel=1e-9)


@pytest.mark.parametrize("count", [2, 3, 6])
def test_after_the_steps_less_than_a_rounding_is_left(count: int) -> None:
    source = np.random.default_rng(count)
    for _ in range(50):
        shares = source.uniform(0, 1, (count, count)) ** 3
        shares *= source.uniform(0.01, 0.45) / shares.sum(axis=1).max()
        steps = steps_for(shares.tolist())
        errors = np.ones(count)
        for _ in range(steps):
            for i in range(count):
                errors[i] = (shares[i] @ errors - shares[i, i] * errors[i]) / (1 - shares[i, i])
        assert errors.max() <= LEFT_OF_LOADS
        assert steps_for((0.5 * shares).tolist()) <= steps
        assert friction_steps([shares.tolist()]).steps >= steps


def test_places_in_a_chain_take_a_step_each_at_most() -> None:
    chain = [[0.0, 0.3, 0.1], [0.0, 0.0, 0.4], [0.0, 0.0, 0.2]]
    assert steps_for(chain) == 3
    assert steps_for([row[::-1] for row in chain[::-1]]) == 1


def test_steps_are_enough_for_the_largest_share() -> None:
    even = [[0.0, 0.5], [0.5, 0.0]]
    assert steps_for(even) == 28
    locked = friction_steps([even, [[0.0, 0.1], [0.1, 0.0]]])
    assert (locked.locking, locked.points, locked.locks) == (1, 2, False)
    assert friction_steps([even]).locks
    assert friction_steps([]).locks


def test_motions_that_lock_everywhere_are_refused_by_name() -> None:
    model = load_text(PENDULUM.replace("radius: 0.02", "radius: 4"), "pendulum.yaml")
    why = lacking(ROWS["forward_dynamics"], model)
    assert why is not None
    assert why.startswith("friction locks where inputs are given: it returns 1.3 of the reactions")
    assert lacking(ROWS["inverse_dynamics"], model) is None
    assert any("`forward_dynamics` is not made" in notice.message for notice in model.notices)


def test_what_is_made_without_friction_only_is_refused_by_name() -> None:
    made = system("cart")
    names = ("actuator_bias", "regressor", "inverse_dynamics_jacobian", "forward_dynamics_gradient", "inverse_dynamics")
    present, absent = requested(made.model, made.derivations.generic, names)
    assert present == ["inverse_dynamics"]
    assert len(absent) == len(names) - 1
    assert all("friction that grows with reactions" in why for _, why in absent)
    plain = load_text(CART[: CART.index("friction:")] + CART[CART.index("inputs:") :], "cart.yaml")
    assert "friction_residual" in dict(requested(plain, made.derivations.generic, ("friction_residual",))[1])
    assert requested(plain, made.derivations.generic, ("all",))[0].count("friction_residual") == 0


def test_friction_of_coordinates_stays_as_it_was() -> None:
    text = PENDULUM.replace("friction: {hinge: {coulomb: mu, radius: 0.02,", "friction: {a: {coulomb: mu,")
    model = load_text(text, "pendulum.yaml")
    assert model.rough == ()
    assert model.friction_steps is None
    assert [force.name for force in model.forces] == ["friction of a"]


def test_a_load_stands_at_right_angles() -> None:
    made = system("cart")
    x_dd, mass, weight = 3.0, 10.0, 10.0 * 9.81
    state = made.state([0.0, 0.0, 0.0], [1.0, 10.0, 10.0], [x_dd, x_dd / 0.1, x_dd / 0.1])
    ((u,),) = made.matrix("inverse_dynamics", state)
    # front tyre: J phi'' = -F R - T; cart: m x'' = F_rear - F_front; rear: J phi'' = u - F_rear R - T
    front = 0.0
    for _ in range(100):
        front = 0.05 * x_dd / 0.1 / 0.1 + 0.2 * 0.01 * np.hypot(front, weight / 3) / 0.1
    rear = mass * x_dd + front
    torque = 0.2 * 0.01 * np.hypot(rear, 2 * weight / 3)
    assert u == pytest.approx(0.05 * x_dd / 0.1 + 0.1 * rear + torque, rel=1e-12)


def test_margins_are_those_of_the_page() -> None:
    from symgen.model.configurations.friction_steps import LOCKING_SHARE, SHARE_MARGIN

    shares = (LOCKING_SHARE, SHARE_MARGIN)
    assert shares == (Fraction(1, 2), Fraction(5, 4))
