"""SymPy's own mechanics (Lagrange, Kane) against the generated Python."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy
from generated_python import generated_python
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

WITHIN = 1e-9


def close(computed: Any, expected: Any) -> bool:
    return bool(np.abs(computed - expected).max() <= WITHIN * np.abs(expected).max())


def test_scara_by_lagrange() -> None:
    module = generated_python("scara")
    p = module.PARAMETERS
    z, q_1, q_2, q_4 = q = dynamicsymbols("z q_1 q_2 q_4")
    t = dynamicsymbols._t
    first, second = q_1, q_1 + q_2
    wrist = (p.l_1 * sympy.cos(first) + p.l_2 * sympy.cos(second), p.l_1 * sympy.sin(first) + p.l_2 * sympy.sin(second))
    centre = (
        p.l_1 * sympy.cos(first) + p.l_2 / 2 * sympy.cos(second),
        p.l_1 * sympy.sin(first) + p.l_2 / 2 * sympy.sin(second),
    )
    turn = second - q_4  # the spindle's axis points downwards
    kinetic = (p.J_1 + p.m_1 * p.l_1**2 / 4 + p.J_r) * q_1.diff(t) ** 2 / 2 + p.J_r * q_2.diff(t) ** 2 / 2
    kinetic += p.m_2 / 2 * sum(x.diff(t) ** 2 for x in centre) + p.J_2 / 2 * second.diff(t) ** 2
    kinetic += p.m_3 / 2 * (sum(x.diff(t) ** 2 for x in wrist) + z.diff(t) ** 2) + p.J_3 / 2 * turn.diff(t) ** 2
    system = LagrangesMethod(kinetic + p.m_3 * p.g * z, list(q))
    system.form_lagranges_equations()
    rates, accelerations = sympy.symbols("a:4"), sympy.symbols("b:4")
    plain = sympy.symbols("c:4")
    equations = system.eom.subs({x.diff(t, 2): b for x, b in zip(q, accelerations, strict=True)})
    equations = equations.subs({x.diff(t): a for x, a in zip(q, rates, strict=True)})
    equations = equations.subs(dict(zip(q, plain, strict=True)))
    tau = sympy.lambdify([plain, rates, accelerations], equations)
    source = np.random.default_rng(1)
    for _ in range(5):
        state = source.uniform(0.1, 1, (3, 4))
        rate = state[1]
        force = tau(*state).ravel()
        for i, (d, c, width) in {1: (0.8, 1.5, 0.02), 2: (0.5, 1, 0.02), 0: (20, 5, 0.005)}.items():
            force[i] += d * rate[i] + c * np.tanh(rate[i] / width)
        # the inputs are in the order of the joints, z third
        assert close(module.inverse_dynamics(*state), force[[1, 2, 0, 3]])


def test_rolling_disc_by_kane() -> None:
    module = generated_python("rolling_disc")
    parameters = module.PARAMETERS
    m, R, g = parameters.m, parameters.R, parameters.g
    q = x, y, z, psi, beta, phi = dynamicsymbols("x y z psi beta phi")
    speeds = dynamicsymbols("v_x v_y v_z w_1 w_2 w_3")
    drive, steer, tilt = sympy.symbols("drive steer tilt")
    t = dynamicsymbols._t
    world = ReferenceFrame("N")
    heading = world.orientnew("A", "Axis", [psi, world.z])
    fork = heading.orientnew("F", "Axis", [beta, heading.x])
    disc = fork.orientnew("D", "Axis", [phi, fork.y])
    rates = {a.diff(t): w for a, w in zip(q, speeds, strict=True)}
    disc.set_ang_vel(world, speeds[3] * world.z + speeds[4] * heading.x + speeds[5] * fork.y)
    origin, centre = Point("O"), Point("C")
    origin.set_vel(world, 0)
    centre.set_pos(origin, x * world.x + y * world.y + z * world.z)
    centre.set_vel(world, speeds[0] * world.x + speeds[1] * world.y + speeds[2] * world.z)
    lowest = centre.locatenew("P", -R * fork.z)
    lowest.v2pt_theory(centre, world, disc)
    slip = [lowest.vel(world).dot(axis) for axis in (world.x, world.y, world.z)]
    J = m * R**2 / 4
    body = RigidBody("disc", centre, disc, m, (inertia(disc, J, 2 * J, J), centre))
    kane = KanesMethod(
        world,
        q_ind=[x, y, psi, beta, phi],
        q_dependent=[z],
        configuration_constraints=[z - R * sympy.cos(beta)],
        u_ind=list(speeds[3:]),
        u_dependent=list(speeds[:3]),
        velocity_constraints=slip,
        kd_eqs=[w - rate for rate, w in rates.items()],
    )
    torque = drive * fork.y + steer * world.z + tilt * heading.x
    kane.kanes_equations([body], [(centre, -m * g * world.z), (disc, torque)])
    plain_q, plain_v = sympy.symbols("a:6"), sympy.symbols("b:6")
    plain = dict(zip([*q, *speeds], [*plain_q, *plain_v], strict=True))
    # speeds in Kane's own order: the independent ones first
    matrices = [x.subs(rates).subs(plain) for x in (kane.mass_matrix, kane.forcing)]
    values = sympy.lambdify([plain_q, plain_v, (drive, steer, tilt)], matrices)
    source = np.random.default_rng(2)
    for _ in range(5):
        at = source.uniform(-0.6, 0.6, 6)
        at[2] = R * np.cos(at[4])
        free, u = source.uniform(-2, 2, 3), source.uniform(-3, 3, 3)
        rate = np.concatenate([np.zeros(3), free])
        allowed = sympy.lambdify([plain_q, plain_v], sympy.Matrix(slip).subs(plain))
        rate[:3] = -allowed(at, rate).ravel()  # the centre's velocity enters each row with factor 1
        mass, forcing = values(at, rate, u)
        solution = np.linalg.solve(mass, forcing.ravel())
        assert close(module.forward_dynamics(at, rate, u), np.concatenate([solution[3:], solution[:3]]))
