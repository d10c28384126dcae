"""Limits of inputs along one to four directions of internal force, against every face of what they leave."""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Callable
from functools import cache
from itertools import combinations, product
from pathlib import Path
from types import ModuleType
from typing import Any

import allocation_models as models
import numpy as np
import pytest
from generated_python import load_generated
from laws_harness import System

from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python
from symgen.ir.kernel import Scalar, Status
from symgen.model.load import load_text
from symgen.verify.reference.reference import BeyondLimitsError

# Four, five and six drives on a shaft and a slide: two directions of motion.
DRIVES = """\
model: drives
coordinates: {a: {unit: rad}, x: {unit: m}}
parameters: {mass: {value: 2, unit: kg}, inertia: {value: 0.3, unit: kg*m**2}}
kinetic_energy: mass/2*x_dot**2 + inertia/2*a_dot**2 + a_dot*x_dot*cos(a)/8
inputs:
  d_1: {acts_on: {a: 1, x: cos(a)}}
  d_2: {acts_on: {a: -1, x: sin(a)}}
  d_3: {acts_on: {a: 2, x: 1/2}}
  d_4: {acts_on: {a: 1/3, x: -cos(2*a)}}
"""
FIVE = DRIVES + "  d_5: {acts_on: {a: -0.7, x: -1}}\n"
SIX = FIVE + "  d_6: {acts_on: {a: 1, x: 1}}\n"
PAIR = models.CRANKS.replace(", C: {unit: N*m, acts_on: {c: 2}}", "")
# By the number of directions: a system, the block, and how large accelerations are.
CASES = {
    1: (PAIR, "limits: {A: [-0.5, 1], B: [-1, 1]}", 6.0),
    2: (DRIVES, "weights: {d_2: 3}, limits: {d_1: [-2, 1], d_2: [-1, 1], d_3: [-1, 2], d_4: [0.1, 2]}", 4.0),
    3: (FIVE, "preload: {d_1: 0.7}, limits: {d_1: [-1, 1], d_2: [-1, 0], d_3: [-1, 1], d_5: [-1, 0.5]}", 8.0),
    4: (SIX, "limits: {d_1: [-1, 1], d_2: [-0.2, 1], d_3: [-1, 1], d_4: [-1, 1], d_5: [-0.3, 1], d_6: [-1, 1]}", 6.0),
}
QUANTITIES = ("inverse_dynamics", "projected_control_matrix")
# Of the limits: what rounding leaves of them, and what decides nothing else.
TOUCHING = 1e-9


@cache
def system(directions: int) -> System:
    text, block, _ = CASES[directions]
    return System(f"{text}allocation: {{{block}}}\n", QUANTITIES)


def module(made: System, folder: Path, name: str) -> ModuleType:
    path = folder / f"{name}.py"
    (text,) = emit_python(made.model, made.program()).values()
    path.write_text(text, encoding="utf-8")
    return load_generated(path)


class Problem:
    """States drawn at random, and the inputs of least norm for their motions, by NumPy."""

    def __init__(self, directions: int, count: int, folder: Path) -> None:
        text, _, size = CASES[directions]
        made = system(directions)
        self.module = module(made, folder, f"limited_{directions}")
        free = module(System(text, QUANTITIES), folder, f"free_{directions}")
        source = np.random.default_rng(directions)
        n = made.model.n
        self.q = np.repeat(source.uniform(-1, 1, (count, 1)), n, axis=1)  # on the rows of those that have any
        self.qd = source.uniform(-1, 1, (count, n))
        self.qdd = size * source.uniform(-1, 1, (count, n))
        self.control = free.projected_control_matrix(self.q)
        self.made_by = free.inverse_dynamics(self.q, self.qd, self.qdd)
        allocation = made.model.allocation
        assert allocation is not None
        names = [item.name for item in made.model.inputs]
        values = {p.name: float(p.value.number) for p in made.model.parameters if hasattr(p.value, "number")}
        values |= {name: getattr(self.module.PARAMETERS, name) for name in self.module.PARAMETERS.__dataclass_fields__}
        self.weights = np.array([dict(allocation.weights).get(name, 1.0) for name in names], dtype=object)
        self.weights = np.array([values[w] if isinstance(w, str) else w for w in self.weights], dtype=float)
        preferred = dict(allocation.preferred)
        self.target = np.array([values[preferred[name]] if name in preferred else 0.0 for name in names])
        self.limits = [(names.index(x.input), values[x.lower], values[x.upper]) for x in allocation.limits]
        self.directions = directions

    def best(self) -> tuple[Any, Any]:
        """The nearest inputs within limits (NaN where there are none), and how much room the limits leave there."""
        root = 1 / np.sqrt(self.weights)
        inverse = root[:, None] * np.linalg.pinv(self.control * root, rcond=1e-10)
        wanted = np.einsum("sij,sj->si", self.control, self.made_by - self.target)
        least = self.target + np.einsum("sij,sj->si", inverse, wanted)
        unmoving = (np.eye(len(root)) - inverse @ self.control) * root**2
        best = np.full_like(least, np.nan)
        distance = np.full(len(least), np.inf)
        for count in range(self.directions + 1):
            for held in combinations(self.limits, count):
                for sides in product((1, 2), repeat=count):
                    places = [limit[0] for limit in held]
                    reached = np.array([limit[side] for limit, side in zip(held, sides, strict=True)])
                    missing = reached - least[:, places]
                    gram = unmoving[:, places][:, :, places]
                    with np.errstate(all="ignore"):
                        factors = np.linalg.solve(gram + 1e-300, missing[..., None])[..., 0] if count else missing
                    u = least + np.einsum("sij,sj->si", unmoving[:, :, places], factors)
                    square = np.einsum("si,si->s", missing, factors)
                    kept = np.isfinite(square) & (self.beyond(u) <= TOUCHING) & (square < distance)
                    best[kept], distance[kept] = u[kept], square[kept]
        return best, least

    def beyond(self, u: Any) -> Any:
        """By how much inputs exceed their limits."""
        return np.max([np.maximum(u[:, k] - upper, lower - u[:, k]) for k, lower, upper in self.limits], axis=0)


def compared(directions: int, count: int, folder: Path) -> Problem:
    problem = Problem(directions, count, folder)
    best, least = problem.best()
    u = problem.module.inverse_dynamics(problem.q, problem.qd, problem.qdd)
    none, refused = np.isnan(best).any(axis=1), np.isnan(u).any(axis=1)
    untouched = np.abs(best - least).max(axis=1) < 1e-12
    # states of each kind, and none that is decided otherwise
    kinds = (none.sum(), untouched.sum(), (~none & ~untouched).sum())
    assert min(kinds) > count // 50, kinds
    assert (none == refused).all(), np.flatnonzero(none != refused)
    assert np.abs(u - best)[~none].max() < 1e-9
    assert problem.beyond(u[~none]).max() < 1e-12
    moved = np.einsum("sij,sj->si", problem.control, u - problem.made_by)
    assert np.abs(moved[~none]).max() < 1e-11
    return problem


@pytest.mark.parametrize("directions", [2, 3])
def test_a_limit_far_below_the_other_inputs_is_no_reason_to_refuse(directions: int, tmp_path: Path) -> None:
    """What rounding leaves of it is as much as of the others: loads of 1e9 beside a limit of 1."""
    text, _, _ = CASES[directions]
    made = module(System(f"{text}allocation: {{limits: {{d_1: [-1, 1]}}}}\n", QUANTITIES), tmp_path, "heavy")
    source = np.random.default_rng(3)
    q, qd, qdd = source.uniform(-1, 1, (3, 200, 2))
    u = made.inverse_dynamics(q, qd, 1e9 * qdd)
    assert np.isfinite(u).all()
    assert np.abs(u[:, 0]).max() < 1 + 1e-15 * np.abs(u).max()


@pytest.mark.parametrize("directions", CASES)
def test_inputs_are_the_nearest_within_their_limits_or_there_are_none(directions: int, tmp_path: Path) -> None:
    compared(directions, 1_000, tmp_path)


@pytest.mark.campaign
@pytest.mark.parametrize("directions", CASES)
def test_so_they_are_at_a_hundred_thousand_states(directions: int, tmp_path: Path) -> None:
    compared(directions, 25_000, tmp_path)


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.parametrize("directions", CASES)
def test_float32_decides_the_same(directions: int, tool: Callable[[str], str], tmp_path: Path) -> None:
    made = system(directions)
    problem = Problem(directions, 400, tmp_path)
    best, _ = problem.best()
    for path, text in emit_c(made.model, made.program("float32")).items():
        (tmp_path / Path(path).name).write_text(text)
    library, name = tmp_path / "lib.so", f"{made.model.name}_f"
    command = [tool("cc"), "-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(library)]
    subprocess.run([*command, str(tmp_path / f"{name}.c"), "-lm"], check=True)
    call = getattr(ctypes.CDLL(str(library)), f"{made.model.name}_inverse_dynamics_f")
    numbers = ctypes.c_float * 16
    fields = problem.module.PARAMETERS.__dataclass_fields__
    parameters = numbers(*(getattr(problem.module.PARAMETERS, field) for field in fields))
    differing = 0
    for index, wanted in enumerate(best):
        result = numbers()
        status = call(*(numbers(*given[index]) for given in (problem.q, problem.qd, problem.qdd)), parameters, result)
        differing += (status == 0) != bool(np.isfinite(wanted).all())
        if status == 0 and np.isfinite(wanted).all():
            assert np.abs(np.array(result[: len(wanted)]) - wanted).max() < 1e-3 * np.abs(wanted).max()
        else:
            assert status in (0, Status.LIMITS)
    # nearer to what no inputs do than numbers of seven digits tell
    assert differing <= 1


@pytest.mark.parametrize("directions", CASES)
def test_the_reference_takes_the_same(directions: int, tmp_path: Path) -> None:
    made = system(directions)
    problem = Problem(directions, 40, tmp_path)
    best, _ = problem.best()
    for index, wanted in enumerate(best):
        state = made.state(*(given[index].tolist() for given in (problem.q, problem.qd, problem.qdd)))
        try:
            (u,) = made.reference.matrices(state, ("inverse_dynamics",)).values()
        except BeyondLimitsError:
            assert np.isnan(wanted).any()
            continue
        assert [float(x) for x in u.entries()] == pytest.approx(wanted, abs=1e-9)


# Of five drives one does what another does, turned around, and one alone does what all others do not.
ALIKE = """\
model: alike
coordinates: {a: {unit: rad}, x: {unit: m}, y: {unit: m}}
parameters: {mass: {value: 2, unit: kg}}
kinetic_energy: mass/2*(x_dot**2 + y_dot**2) + a_dot**2/5
inputs:
  one: {acts_on: {a: cos(a), x: cos(a + 1), y: sin(a + 1)}}
  other: {acts_on: {a: -3*cos(a), x: -3*cos(a + 1), y: -3*sin(a + 1)}}
  third: {acts_on: {a: 1, x: sin(a)*cos(a + 1), y: sin(a)*sin(a + 1)}}
  fourth: {acts_on: {a: -1, x: cos(a + 1)/2, y: sin(a + 1)/2}}
  alone: {acts_on: {a: 0.3, x: 1}}
"""


@pytest.mark.parametrize("scalar", ["float64", "float32"])
@pytest.mark.parametrize("others", ["other: [-1, 2], one: [-1, 2]", "third: [-1, 2]"])
def test_what_takes_no_part_is_not_brought_to_its_limit_by_roundings(others: str, scalar: Scalar) -> None:
    """An input that the motion determines, and one that does what another does, at the limit of which that one is."""
    made = System(f"{ALIKE}allocation: {{limits: {{{others}, alone: [-1, 1]}}}}\n", QUANTITIES)
    seen = {Status.OK: 0, Status.LIMITS: 0}
    for k in range(60):
        a, across = 0.02 * k - 0.6, 0.05 * k - 1.2
        # along what the others do, and beside it
        away = [np.cos(a + 1) + across, np.sin(a + 1)]
        state = made.state([a, 0.3, 0.1], [0.0, 0.0, 0.0], [0.3, *map(float, away)], scalar=scalar)
        status, u = made.run("inverse_dynamics", state, scalar)
        seen[status] += 1
        needed = 2 * across
        if abs(abs(needed) - 1) > 1e-3:
            assert (status is Status.OK) == (abs(needed) < 1), (a, across)
        if status is Status.OK:
            assert u[4] == pytest.approx(needed, abs=1e-5)
            limited = u[:2] if "one" in others else u[2:3]
            assert -1.00001 <= min(limited) <= max(limited) <= 2.00001
            assert max(map(abs, u)) < 50
    assert min(seen.values()) > 10


@pytest.mark.campaign
def test_kernels_pass_verification_and_say_what_they_refuse(tmp_path: Path) -> None:
    from symgen.cli.main import main

    text, block, _ = CASES[2]
    ranges = "ranges: {a_ddot: [-4, 4], x_ddot: [-4, 4]}\n"
    path = tmp_path / "drives.yaml"
    path.write_text(f"{text}allocation: {{{block}}}\n{ranges}", encoding="utf-8")
    assert main([str(path), "--out", str(tmp_path), "--only", "c,python", "--quiet"]) == 0
    header = (tmp_path / "drives/c/drives.h").read_text(encoding="utf-8")
    assert "or the status LIMITS where no inputs within them produce the motion" in header
    assert "DRIVES_LIMITS" in header


def test_one_direction_with_a_sign_of_its_own_has_no_status() -> None:
    model = load_text(f"{models.AXIS}allocation: {{limits: {{left: [-1, 1]}}}}\n", "axis.yaml")
    assert not model.keeps_limits
    assert system(1).model.keeps_limits
