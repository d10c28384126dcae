"""The share of their limits that inputs need, against linear programs and by hand."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

import allocation_models as models
import numpy as np
import pytest
from generated_python import load_generated
from laws_harness import System
from scipy.optimize import linprog
from shipped import sparing
from test_limits_along_several_directions import FIVE, PAIR, SIX

from symgen.backends.python.module import emit_python
from symgen.cli.main import main
from symgen.model.load import load_text
from symgen.witness.casadi_derivation import witness_functions

# A stage moved by four and by six springs of its own: delta = 4 and 5 with two and one directions left.
STAGE = """\
model: stage
coordinates: {w: {}, x: {}, y: {}, z: {}}
kinetic_energy: w_dot**2 + x_dot**2/2 + y_dot**2 + z_dot**2/3 + w_dot*z_dot*cos(x)/2
inputs:
  a: {acts_on: {w: 1, x: cos(y)}}
  b: {acts_on: {x: 1, y: sin(w)}}
  c: {acts_on: {y: 1, z: -1}}
  d: {acts_on: {z: 1, w: cos(x)}}
  e: {acts_on: {w: -1, x: -1, y: 1/2}}
  f: {acts_on: {x: 1, y: -1, z: -1/3}}
"""
# The same where two drives do the same, and one is alone with its coordinate.
TWIN_AND_ALONE = "twin: {acts_on: {w: -2, x: -2, y: 1}}\n  alone: {acts_on: {v: 3}}"
ALIKE = (
    STAGE.replace("model: stage", "model: alike")
    .replace("{w: {}", "{v: {}, w: {}")
    .replace("kinetic_energy: ", "kinetic_energy: v_dot**2 + ")
    .replace("f: {acts_on: {x: 1, y: -1, z: -1/3}}", TWIN_AND_ALONE)
)
# By name: a system, limits of its inputs.
CASES = {
    "one axis": (models.AXIS, "left: [-1, 1], right: [-0.5, 0.7]"),
    "thrusters": (models.PLATE, "p: [0.1, 2], q_1: [-1, 2], s: [0, 2], t_1: [-1, 1]"),
    "skid": (models.SKID, "p: [0.1, 2], q_1: [-1, 2], s: [0, 2], t_1: [-1, 1], v: [-2, 3]"),
    "dependent rows": (PAIR, "A: [-0.5, 1], B: [-1, 1]"),
    "five drives": (FIVE, "d_1: [-1, 1], d_2: [-1, 0], d_3: [-1, 1], d_4: [0.5, 1], d_5: [-1, 0.5]"),
    "six drives": (SIX, "d_1: [-1, 1], d_2: [-1, 0], d_3: [-1, 1], d_4: [0.5, 1], d_5: [-1, 0.5], d_6: [-2, 2]"),
    "stage": (STAGE, "a: [-1, 1], b: [-1, 2], c: [0.2, 1], d: [-1, 1], e: [-2, 1], f: [-1, 1]"),
    "alike": (ALIKE, "a: [-1, 1], b: [-1, 2], c: [0.2, 1], d: [-1, 1], e: [-2, 1], twin: [-1, 1], alone: [-4, 2]"),
}
STATES = 60


def system(name: str) -> System:
    text, limits = CASES[name]
    return System(f"{text}allocation: {{limits: {{{limits}}}}}\n", ("utilisation", "projected_control_matrix"))


def states(made: System, seed: int) -> tuple[Any, Any, Any]:
    source = np.random.default_rng(seed)
    q = source.uniform(-1, 1, (STATES, made.model.n))
    if made.model.r:
        q[:] = q[:, :1]  # on the rows of cranks, which are equal; those of the skid hold rates alone
    return q, source.uniform(-1, 1, q.shape), 3 * source.uniform(-1, 1, q.shape)


def loaded(made: System, folder: Path, name: str) -> ModuleType:
    (text,) = emit_python(made.model, made.program()).values()
    path = folder / f"{name}.py"
    path.write_text(text, encoding="utf-8")
    return load_generated(path)


def limits_of(made: System, module: ModuleType) -> Any:
    assert made.model.allocation is not None
    by_input = {x.input: (x.lower, x.upper) for x in made.model.allocation.limits}
    return np.array([[getattr(module.PARAMETERS, x) for x in by_input[i.name]] for i in made.model.inputs])


def least_share(control: Any, force: Any, ends: Any) -> float:
    """The linear program: least s with M u = f, |u - c| <= s h."""
    middles, halves = ends.sum(axis=1) / 2, (ends[:, 1] - ends[:, 0]) / 2
    m = len(middles)
    upper = np.block([[np.eye(m), -halves[:, None]], [-np.eye(m), -halves[:, None]]])
    solved = linprog(
        [0] * m + [1],
        A_ub=upper,
        b_ub=np.concatenate([middles, -middles]),
        A_eq=np.hstack([control, np.zeros((len(control), 1))]),
        b_eq=force,
        bounds=[(None, None)] * m + [(0, None)],
    )
    assert solved.status == 0
    return float(solved.fun)


@pytest.mark.parametrize("name", CASES)
def test_it_is_the_value_of_the_linear_program(name: str, tmp_path: Path) -> None:
    made = system(name)
    module = loaded(made, tmp_path, "limited")
    least = loaded(System(CASES[name][0], ("inverse_dynamics",)), tmp_path, "free")
    q, qd, qdd = states(made, len(name))
    shares = module.utilisation(q, qd, qdd)
    control = module.projected_control_matrix(q)
    inputs = least.inverse_dynamics(q, qd, qdd)
    ends = limits_of(made, module)
    for k in range(STATES):
        # of rows that depend on each other as many as hold
        basis = np.linalg.svd(control[k])[0][:, : np.linalg.matrix_rank(control[k], 1e-9)].T
        wanted = least_share(basis @ control[k], basis @ control[k] @ inputs[k], ends)
        assert float(shares[k, 0]) == pytest.approx(wanted, rel=1e-8)


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["thrusters", "skid", "stage"])
def test_witness_and_reference_agree(name: str) -> None:
    made = system(name)
    function = witness_functions(made.model)["utilisation"]
    state = made.state([0.3, -0.2, 0.4, 0.1][: made.model.n])
    (wanted,) = made.reference.evaluate(state, ["utilisation"])["utilisation"]
    parts = {"q": state.q, "qd": state.qd, "qdd": state.qdd, "u": state.u, "p": state.parameters}
    share = function(*(list(parts[argument]) for argument in function.name_in()))
    assert float(share) == pytest.approx(float(wanted), rel=1e-9)


@pytest.mark.campaign
@pytest.mark.parametrize("name", CASES)
def test_kernels_pass_verification(name: str, tmp_path: Path) -> None:
    text, limits = CASES[name]
    path = tmp_path / "limited.yaml"
    path.write_text(f"{text}allocation: {{limits: {{{limits}}}}}\noutputs: [utilisation]\n", encoding="utf-8")
    assert main([str(path), "--out", str(tmp_path), "--only", "c,python", "--states", "16", "--quiet"]) == 0


def test_one_axis_by_hand() -> None:
    """5 x_ddot = u_1 + 2 u_2, |u_1| <= 1 and |u_2 - 0.1| <= 0.6: at x_ddot = 1, (5 - 0.2) / (1 + 2 * 0.6)."""
    made = system("one axis")
    _, (share,) = made.run("utilisation", made.state([0.3], qdd=[1.0]))
    assert share == pytest.approx(4.8 / 2.2, rel=1e-15)


def test_inputs_that_the_motion_determines_have_a_share_too() -> None:
    text = "model: one\ncoordinates: {x: {}}\nkinetic_energy: x_dot**2\ninputs: {f: {acts_on: {x: 1}}}\n"
    block = "allocation: {limits: {f: [-4, 2]}}\n"
    made = System(f"{text}{block}", ("utilisation", "inverse_dynamics"))
    _, (share,) = made.run("utilisation", made.state([0.0], qdd=[1.0]))
    assert share == (2 - -1) / 3
    assert made.run("inverse_dynamics", made.state([0.0], qdd=[1.0]))[1] == [2.0]
    (notice,) = load_text(text + block, "one.yaml").notices
    assert notice.message.endswith("name `utilisation` in `outputs`")
    assert load_text(f"{text}{block}outputs: [utilisation]\n", "one.yaml").notices == ()


@pytest.mark.campaign
@pytest.mark.parametrize(
    "name", sparing(["one axis", "skid", "five drives", "stage", "alike"], ("five drives", "stage"))
)
def test_with_scale_inputs_are_those_of_the_largest_share_of_a_motion(name: str, tmp_path: Path) -> None:
    text, limits = CASES[name]
    names = ("inverse_dynamics", "utilisation", "projected_control_matrix")
    scaled = System(f"{text}allocation: {{scale: true, limits: {{{limits}}}}}\n", names)
    kept = loaded(System(f"{text}allocation: {{limits: {{{limits}}}}}\n", names), tmp_path, "kept")
    least = loaded(System(text, names), tmp_path, "free")
    module = loaded(scaled, tmp_path, "scaled")
    q, qd, qdd = states(scaled, 7)
    u, shares = module.inverse_dynamics(q, qd, qdd), np.maximum(module.utilisation(q, qd, qdd), 1)
    assert np.isfinite(u).all()
    possible = shares[:, 0] == 1
    assert 0 < possible.sum() < STATES
    assert u[possible] == pytest.approx(kept.inverse_dynamics(q, qd, qdd)[possible], abs=1e-10)
    ends = limits_of(scaled, module)
    assert (u >= ends[:, 0] - 1e-9).all()
    assert (u <= ends[:, 1] + 1e-9).all()
    middles, control = ends.sum(axis=1) / 2, module.projected_control_matrix(q)
    supplied = np.einsum("sij,sj->si", control, u - middles)
    needed = np.einsum("sij,sj->si", control, least.inverse_dynamics(q, qd, qdd) - middles)
    assert supplied == pytest.approx(needed / shares, abs=1e-9)


def test_tensions_of_cables_are_limits() -> None:
    cables = """\
model: hanging
coordinates: {x: {unit: m}, y: {unit: m, range: [-2, -1]}}
parameters: {m: {value: 2, unit: kg}, g: {value: 9.81, unit: m/s**2}, f: {value: 3, unit: N}}
gravity: [0, -g, 0]
frames: {load: {translation: [x, y, 0]}}
bodies: {load: {mass: m}}
points: {a: {at: [-2, 0, 0]}, b: {at: [0, 0, 0]}, c: {at: [2, 0, 0]}}
inputs:
"""
    pulled = "tension: {minimum: f, maximum: 20*f}"
    marked = cables + "".join(f"  f_{k}: {{unit: N, cable: [{k}, load], {pulled}}}\n" for k in "abc")
    written = cables + "".join(f"  f_{k}: {{unit: N, cable: [{k}, load]}}\n" for k in "abc")
    written += f"allocation: {{limits: {{{', '.join(f'f_{k}: [f, 20*f]' for k in 'abc')}}}}}\n"
    one, other = (load_text(text, "cables.yaml") for text in (marked, written))
    assert one.allocation is not None
    assert other.allocation is not None
    assert one.allocation.limits == other.allocation.limits
    assert [(p.name, p.value, p.unit) for p in one.parameters] == [(p.name, p.value, p.unit) for p in other.parameters]


def test_it_needs_limits_of_every_input() -> None:
    made = System(f"{models.AXIS}allocation: {{limits: {{left: [-1, 1]}}}}\n", ("utilisation", "mass_matrix"))
    assert made.names == ["mass_matrix"]
    assert ("utilisation", "it needs `limits` of every input, under `allocation`") in made.derivations.absent


def leaning(directions: int, drives: int) -> str:
    """Drives that push a carriage along one line, but for a share e of what each does beside it."""
    source = np.random.default_rng(3)
    names, shares = "abc"[: directions - 1], source.uniform(-1, 1, (directions - 1, drives)).round(3)
    inputs = ""
    for k in range(drives):
        pushes = (f"{s[0]}*cos(q) + e*{s[k]}*sin(q + {k})" for s in shares)
        acts = ", ".join(f"{name}: {push}" for name, push in zip(names, pushes, strict=True))
        inputs += f"  d_{k}: {{acts_on: {{{acts}, q: {3 + k}/10}}}}\n"
    return (
        f"model: leaning\ncoordinates: {{{''.join(f'{name}: {{}}, ' for name in names)}q: {{unit: rad}}}}\n"
        f"parameters: {{e: {{value: 1, range: [1/1000000, 1]}}}}\n"
        f"kinetic_energy: ({' + '.join(f'{name}_dot**2' for name in names)} + q_dot**2)/2\ninputs:\n{inputs}"
        f"allocation: {{limits: {{{', '.join(f'd_{k}: [-1, 1]' for k in range(drives))}}}}}\n"
    )


@pytest.mark.parametrize(("directions", "drives"), [(3, 5), (4, 5), (4, 6)])
def test_inputs_that_all_but_agree_cost_no_digits(directions: int, drives: int) -> None:
    """Determinants of four columns that are a ten thousandth apart would lose a hundred times what is allowed."""
    made, source = System(leaning(directions, drives), ("utilisation",)), np.random.default_rng(1)
    for share in (1.0, 1e-2, 1e-4):
        for _ in range(6):
            q, rest = [0.1] * (directions - 1) + [0.7], [0.0] * directions
            made.assert_right(made.state(q, rest, source.uniform(-1, 1, directions).tolist(), parameters={"e": share}))
