"""Joints about main axes of both their frames: the same forces in fewer operations, whatever the axes and signs."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
from shipped import model as shipped_model

from symgen.mechanics.system import System
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.load import load_text
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.traverse import cost, reached

TURNED = ("[x, pi/2]", "[x, -pi/2]", "[y, pi/2]", "[z, -pi/2]", "[x, pi]", "[y, 0.3]")
BODY = "{mass: m, com: [x, -y, z], inertia: {xx: J, yy: 2*J, zz: 1.5*J, xy: 0.1*J, xz: -0.2*J, yz: 0.3*J}}"


def chain(axes: str, turns: tuple[str, ...], without_body: tuple[int, ...] = ()) -> str:
    """A chain of revolute joints; the frames of some have no body of their own."""
    lines = ["model: chain", "joints:"]
    for k, (axis, turn) in enumerate(zip(axes, turns, strict=True)):
        parent = f"parent: f_{k - 1}, " if k else ""
        at = "at: [x, z, -y], " if k else ""
        lines.append(f"  f_{k}: {{type: revolute, {parent}{at}rotation: [{turn}], axis: {axis}, coordinate: q_{k}}}")
    lines += ["parameters:", "  m: {value: 2, unit: kg}", "  g: {value: 9.81, unit: m/s**2}"]
    lines += ["  J: {value: 1, unit: kg*m**2}", *(f"  {name}: {{value: 0.1, unit: m}}" for name in "xyz")]
    lines += ["gravity: [0.1*g, 0.2*g, -g]", "bodies:"]
    lines += [f"  f_{k}: {BODY}" for k in range(len(axes)) if k not in without_body]
    lines += ["inputs:", *(f"  u_{k}: {{unit: N*m, joint: q_{k}}}" for k in range(len(axes)))]
    return "\n".join([*lines, "outputs: [inverse_dynamics]", ""])


@pytest.mark.parametrize("seed", range(12))
def test_axes_and_signs(seed: int) -> None:
    source = random.Random(seed)
    turns = tuple(source.choice(TURNED) for _ in range(4))
    axes = "".join(source.choice("xyz") for _ in range(4))
    model = load_text(chain(axes, turns, (1,) if seed % 3 == 0 else ()), "chain.yaml")
    bodies, energies = System(model), System(energy_form(model))
    symbols = (*bodies.q, *bodies.qd, *bodies.qdd, *bodies.parameters)
    state = {str(symbol.payload): float(Fraction(source.randrange(200, 1200), 1000)) for symbol in symbols}
    expected = Evaluator(energies.balance)(state)
    assert Evaluator(bodies.balance)(state) == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_a_body_on_a_fixed_axis_has_one_inertia() -> None:
    """q_ddot (J_zz + m (x^2 + y^2)) and the weight; the rate's square does no work."""
    model = load_text(chain("z", ("[x, pi/2]",)), "chain.yaml")
    mechanics = System(model)
    (force,) = mechanics.balance
    assert mechanics.qd[0] not in set(reached([force]))
    assert cost([force]).weight < 60


def test_what_frames_share_is_computed_once() -> None:
    operations = cost(System(shipped_model("arm7")).balance)
    assert operations.additive + operations.multiplications <= 720
