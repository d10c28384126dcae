"""Friction that grows with reactions, against Newton and Euler's equations of each body, solved by NumPy."""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from generated_python import load_generated
from laws_harness import System

from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Scalar, Status
from symgen.verify.given import arrays
from symgen.verify.reference.reference import LocksError

MODEL = Path(__file__).with_name("rough_slider_crank.yaml")
QUANTITIES = ("inverse_dynamics", "friction_residual", "forward_dynamics", "multipliers")
# A crank, a connecting rod and a block on a guide, whose reaction is one number: lambda = a / (1 - b sgn a).
SCALAR = """\
model: block
parameters: {r: 0.1, l: 0.3, mu: 0.05, w: 0.01, m: 1.2, J: 0.01}
coordinates: {alpha: {unit: rad}, x: {unit: m, range: [0.1, 0.5]}}
definitions: {y: r*sin(alpha)}
kinetic_energy: J/2*alpha_dot**2 + m/2*x_dot**2
constraints: {geometric: {rod: (x - r*cos(alpha))**2/2 + y**2/2 - l**2/2}}
friction: {rod: {coulomb: mu, width: w, reaction: [rod], rate: x_dot}}
inputs: {motor: {joint: alpha}}
configuration: {alpha: 0.5, x: 0.38}
"""


@cache
def system() -> System:
    return System(MODEL.read_text(encoding="utf-8"), QUANTITIES)


def module(made: System, folder: Path) -> ModuleType:
    path = folder / f"{made.model.name}.py"
    (text,) = emit_python(made.model, made.program()).values()
    path.write_text(text, encoding="utf-8")
    return load_generated(path)


def _along(angle: float) -> Any:
    return np.array([np.cos(angle), np.sin(angle)])


def _across(angle: float) -> Any:
    return np.array([-np.sin(angle), np.cos(angle)])


class SliderCrank:
    """The machine as a mechanic draws it: each body cut free, seven forces and the torque, friction as it turns out."""

    def __init__(self, p: Any) -> None:
        self.p = p

    def motions(self, count: int, seed: int) -> Iterator[tuple[Any, Any, Any]]:
        """Closed configurations with rates and accelerations that the wrist allows."""
        source, p = np.random.default_rng(seed), self.p
        for _ in range(count):
            a, a_d, a_dd = source.uniform(-np.pi, np.pi), source.uniform(-8, 8), source.uniform(-40, 40)
            sine = (p.e - p.r * np.sin(a)) / p.l
            b = np.arcsin(sine)  # of the rod, from the horizontal
            b_d = -p.r * np.cos(a) * a_d / (p.l * np.cos(b))
            rest = p.r * (np.sin(a) * a_d**2 - np.cos(a) * a_dd) + p.l * np.sin(b) * b_d**2
            b_dd = rest / (p.l * np.cos(b))
            s = p.r * np.cos(a) + p.l * np.cos(b)
            s_d = -p.r * np.sin(a) * a_d - p.l * np.sin(b) * b_d
            s_dd = -p.r * (np.cos(a) * a_d**2 + np.sin(a) * a_dd) - p.l * (np.cos(b) * b_d**2 + np.sin(b) * b_dd)
            yield np.array([a, b - a, s]), np.array([a_d, b_d - a_d, s_d]), np.array([a_dd, b_dd - a_dd, s_dd])

    def forces(self, q: Any, qd: Any, qdd: Any) -> Any:
        """Forces A, B, C in the pins (two each), N on the slider, and the torque of the motor."""
        p, (a, relative, _), (a_d, b_rate, s_d), (a_dd, b_acc, s_dd) = self.p, q, qd, qdd
        b, b_d, b_dd = a + relative, a_d + b_rate, a_dd + b_acc
        pin = p.r * (_across(a) * a_dd - _along(a) * a_d**2)
        crank, rod = pin / 2, pin + p.l / 2 * (_across(b) * b_dd - _along(b) * b_d**2)
        rough = p.mu_p * p.rho
        way = [np.tanh(a_d / p.w_p), np.tanh(b_rate / p.w_p), np.tanh(b_d / p.w_p), np.tanh(s_d / p.w_g)]
        x = np.zeros(8)
        weight = np.array([0, -p.g])
        for _ in range(400):
            A, B, C, N = x[:2], x[2:4], x[4:6], x[6]
            torque = [rough * np.linalg.norm(F) * t for F, t in zip((A, B, C), way[:3], strict=True)]
            rows, right = np.zeros((8, 8)), np.zeros(8)
            # crank: A - B + m g = m a; A acts on it, B on the rod, C on the slider
            rows[0:2, 0:2], rows[0:2, 2:4], right[0:2] = np.eye(2), -np.eye(2), p.m_c * (crank - weight)
            rows[2:4, 2:4], rows[2:4, 4:6], right[2:4] = np.eye(2), -np.eye(2), p.m_r * (rod - weight)
            rows[4:6, 4:6], rows[5, 6] = np.eye(2), 1
            right[4:6] = p.m_s * (np.array([s_dd, 0]) - weight) + np.array([p.mu_g * abs(N) * way[3], 0])
            # moments about the pin A of the crank and about B of the rod
            lever, half = p.r * _along(a), p.r / 2 * _along(a)
            rows[6, 2:4], rows[6, 7] = [lever[1], -lever[0]], 1
            right[6] = p.J_c * a_dd + p.m_c * _cross(half, crank - weight) + torque[0] - torque[1]
            lever, half = p.l * _along(b), p.l / 2 * _along(b)
            rows[7, 4:6] = [lever[1], -lever[0]]
            right[7] = p.J_r * b_dd + p.m_r * _cross(half, rod - weight) + torque[1] + torque[2]
            x = np.linalg.solve(rows, right)
        return x


def _cross(a: Any, b: Any) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


@pytest.mark.campaign
def test_inputs_are_those_of_each_body_cut_free(tmp_path: Path) -> None:
    made = module(system(), tmp_path)
    machine = SliderCrank(made.PARAMETERS)
    smooth = made.Parameters(mu_p=0.0, mu_g=0.0)
    shares = []
    for q, qd, qdd in machine.motions(60, 1):
        x = machine.forces(q, qd, qdd)
        u = made.inverse_dynamics(q, qd, qdd)
        assert u[0] == pytest.approx(x[7], rel=1e-11, abs=1e-12)
        shares.append(abs(u[0] / made.inverse_dynamics(q, qd, qdd, smooth)[0] - 1))
    assert np.median(shares) > 0.01  # friction counts


@pytest.mark.campaign
def test_accelerations_and_multipliers_under_these_inputs_are_those_of_the_motion(tmp_path: Path) -> None:
    made = module(system(), tmp_path)
    machine = SliderCrank(made.PARAMETERS)
    for q, qd, qdd in machine.motions(60, 2):
        x = machine.forces(q, qd, qdd)
        assert made.forward_dynamics(q, qd, x[7:]) == pytest.approx(qdd, rel=1e-9, abs=1e-9)
        assert made.multipliers(q, qd, x[7:]) == pytest.approx(x[4:6], rel=1e-9, abs=1e-9)


def test_the_residual_is_what_given_inputs_lack(tmp_path: Path) -> None:
    made = module(system(), tmp_path)
    machine = SliderCrank(made.PARAMETERS)
    for q, qd, qdd in machine.motions(40, 3):
        u = made.inverse_dynamics(q, qd, qdd)
        rest = made.friction_residual(q, qd, qdd, u)
        more = made.friction_residual(q, qd, qdd, u + 0.5)
        assert np.abs(rest).max() < 1e-13
        projected = made.friction_residual(q, qd, qdd, 0 * u)
        assert more - rest == pytest.approx(-0.5 / u[0] * projected, rel=1e-9)


@pytest.mark.campaign
@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_kernels_are_within_the_rounding_of_the_reference(scalar: Scalar) -> None:
    made = system()
    machine = SliderCrank(_defaults(made))
    for q, qd, qdd in machine.motions(12, 4):
        state = made.state(q.tolist(), qd.tolist(), qdd.tolist(), [1.5], scalar=scalar)
        assert max(made.errors(state, QUANTITIES, scalar).values()) <= 1


def _defaults(made: System) -> Any:
    class Given:
        pass

    given = Given()
    for parameter, value in zip(made.model.parameters, made.state([0.0, 0.0, 0.4]).parameters, strict=True):
        setattr(given, parameter.name, float(value))
    return given


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_where_friction_returns_half_there_is_a_status(scalar: Scalar, tmp_path: Path) -> None:
    made = system()
    (q, qd, qdd), *_ = SliderCrank(_defaults(made)).motions(1, 5)
    seen = []
    for size in np.linspace(0.5, 12, 24):
        rougher = {"mu_p": 0.1 * size, "mu_g": 0.15 * size}
        state = made.state(q.tolist(), qd.tolist(), qdd.tolist(), [1.0], rougher, scalar)
        for name in QUANTITIES:
            status, _ = made.run(name, state, scalar)
            try:
                made.reference.matrices(state, (name,))
                locks = False
            except LocksError:
                locks = True
            assert status is (Status.FRICTION_LOCK if locks else Status.OK), (name, size)
        seen.append(status)
    assert {*seen} == {Status.OK, Status.FRICTION_LOCK}
    loaded = module(made, tmp_path)
    assert np.isnan(loaded.inverse_dynamics(q[None], qd[None], qdd[None], loaded.Parameters(mu_p=9.0))).all()

@pytest.mark.parametrize("scalar", ["float64", "float32"])
@pytest.mark.parametrize(("steps", "settles"), [(2, False), (40, True)])
def test_steps_that_are_too_few_are_a_status(scalar: Scalar, steps: int, settles: bool) -> None:
    """Where friction returns a third of the reactions, forty steps change nothing any more, and two do."""
    made = system()
    known = made.model.friction_steps
    assert known is not None
    few = draft_of(replace(made.model, friction_steps=replace(known, steps=steps)), ("inverse_dynamics",), Options())
    (q, qd, qdd), *_ = SliderCrank(_defaults(made)).motions(1, 5)
    state = made.state(q.tolist(), qd.tolist(), qdd.tolist(), [1.0], {"mu_p": 0.3, "mu_g": 0.3}, scalar)
    kernel, sincos = few.kernels("inverse_dynamics")[scalar], few.programs[scalar].sincos
    status, _ = Interpreter(sincos, scalar).run(kernel, arrays(state, [kernel]), state.parameters)
    assert status is (Status.OK if settles else Status.FRICTION_LOCK)


@pytest.mark.campaign
@pytest.mark.toolchain
def test_c_returns_the_bits_of_python_and_the_status(tool: Callable[[str], str], tmp_path: Path) -> None:
    made = system()
    loaded = module(made, tmp_path)
    for path, text in emit_c(made.model, made.program()).items():
        (tmp_path / Path(path).name).write_text(text)
    header = (tmp_path / "rough_slider_crank.h").read_text(encoding="utf-8")
    assert "ROUGH_SLIDER_CRANK_FRICTION_LOCK = 12" in header
    assert "worked out in 10 steps; status FRICTION_LOCK" in header
    library = tmp_path / "lib.so"
    command = [tool("cc"), "-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(library)]
    subprocess.run([*command, str(tmp_path / "rough_slider_crank.c"), "-lm"], check=True)
    call = ctypes.CDLL(str(library)).rough_slider_crank_inverse_dynamics
    numbers = ctypes.c_double * 20
    fields = loaded.PARAMETERS.__dataclass_fields__
    for rough in (0.1, 9.0):
        values = loaded.Parameters(mu_p=rough)
        parameters = numbers(*(getattr(values, field) for field in fields))
        for q, qd, qdd in SliderCrank(loaded.PARAMETERS).motions(20, 6):
            result = numbers(7.0)
            status = call(numbers(*q), numbers(*qd), numbers(*qdd), parameters, result)
            if rough > 1:
                assert (status, result[0]) == (Status.FRICTION_LOCK, 7.0)
            else:
                assert (status, result[0]) == (Status.OK, loaded.inverse_dynamics(q, qd, qdd)[0])


def test_one_scalar_reaction_is_explicit(tmp_path: Path) -> None:
    made = System(SCALAR, QUANTITIES[:2])
    steps = made.model.friction_steps
    assert steps is not None
    assert steps.explicit
    loaded, p = module(made, tmp_path), _defaults(made)
    source = np.random.default_rng(7)
    for _ in range(40):
        a, a_d, a_dd, x_dd = source.uniform(-1, 1, 4) * [3, 5, 30, 20]
        x = p.r * np.cos(a) + np.sqrt(p.l**2 - (p.r * np.sin(a)) ** 2)
        reach = x - p.r * np.cos(a)
        slope = np.array([reach * p.r * np.sin(a) + p.r**2 * np.sin(a) * np.cos(a), reach])
        x_d = -slope[0] / slope[1] * a_d
        # m x'' + b_x lambda = -D: the row of x alone gives lambda, that of the motor u
        d = p.mu * np.tanh(x_d / p.w)
        free, share = -p.m * x_dd / slope[1], -d / slope[1]
        force = free / (1 - share * np.sign(free))
        u = p.J * a_dd + slope[0] * force
        got = loaded.inverse_dynamics(np.array([a, x]), np.array([a_d, x_d]), np.array([a_dd, x_dd]))
        assert got[0] == pytest.approx(u, rel=1e-10, abs=1e-12)


@pytest.mark.campaign
def test_methods_that_form_no_reactions_are_refused_by_name(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    from symgen.cli.main import main

    for form, why in (("elimination", "multipliers"), ("forward_dynamics=articulated", "reactions")):
        assert main([str(MODEL), "--method", form, "--no-verify", "--out", str(tmp_path), "--quiet"]) != 0
        assert f"friction grows with {why}, which it does not form" in capsys.readouterr().err
