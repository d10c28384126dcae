"""Small systems whose rows of B come to lie along each other as an angle falls, and states beside that."""

from __future__ import annotations

import random
from dataclasses import replace

from symgen.generation.runnable import rounded_state
from symgen.ir.kernel import Scalar
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import Reference, State

BITS = 256


def wheels(name: str, rows: dict[str, str], parameters: str = "") -> Model:
    """A plate on a ramp with wheels that steer by p and s; `rows` are what the wheels ask of the rates."""
    lines = "\n".join(f"    {label}: {row}" for label, row in rows.items())
    return load_text(
        f"""
model: {name}
coordinates:
  e: {{unit: m}}
  h: {{unit: m}}
  p: {{unit: rad}}
  s: {{unit: rad}}
parameters:
  mu: {{value: 3, unit: kg, range: [1, 5]}}
  I_p: {{value: 0.7, unit: kg*m**2, range: [0.1, 1]}}
  I_s: {{value: 0.2, unit: kg*m**2, range: [0.1, 1]}}
  {parameters}
kinetic_energy: mu/2*(e_dot**2 + h_dot**2) + I_p/2*p_dot**2 + I_s/2*(p_dot + s_dot)**2
potential_energy: mu*9.81*(e/3 + h/7)
constraints:
  nonholonomic:
{lines}
inputs:
  drive: {{unit: N, acts_on: {{e: 1, h: 0.4}}}}
  turn: {{unit: N*m, acts_on: {{s: 1}}}}
""",
        name,
    )


def beside(reference: Reference, apart: float, seed: int, scalar: Scalar) -> State:
    """Coordinates at random, but s = p + `apart`; rates and accelerations that the rows allow for even seeds."""
    model, source = reference.model, random.Random(seed)
    q = [source.uniform(-1, 1) for _ in range(model.n)]
    q[3] = q[2] + apart
    qd, qdd = (tuple(source.uniform(-1, 1) for _ in range(model.n)) for _ in range(2))
    u = tuple(source.uniform(-1, 1) for _ in model.inputs)
    state = State(tuple(q), qd, qdd, u, tuple(map(float, default_parameters(model))))
    if seed % 2 == 0:
        names = ("admissible_velocity", "admissible_acceleration")
        matrices = reference.matrices(state, names, BITS)
        qd, qdd = (tuple(map(float, matrices[name].entries())) for name in names)
        state = replace(state, qd=qd, qdd=qdd)
    return rounded_state(state, scalar)
