"""docs/casadi.md is true, and its optimum is that of equations which CasADi derives itself, with exact Hessians."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import pytest
import shipped

from symgen.laboratory.bench.peers.formulas.native import inverse_dynamics
from symgen.model.configurations.mechanics import default_values
from symgen.witness.lagrange import differentiate

PAGE = shipped.ROOT / "docs" / "casadi.md"
NODES, DURATION = 41, 0.5


def optimum_by_casadi(first: Any, last: Any, start: Any) -> Any:
    """The nodes (41 x 6) of least sum of squared inputs between two configurations, from (27) with (28) in CasADi.

    It knows nothing of the generated code; IPOPT has exact Hessians of it.
    """
    model = shipped.model("rapkm_2rrr_rr")
    s = differentiate(model)
    usual = default_values(model.parameters)
    p = [usual[one.name] for one in model.parameters]
    u = casadi.Function("u", [s.q, s.qd, s.qdd, s.p], [inverse_dynamics(model, s)])
    g = casadi.Function("g", [s.q, s.p], [s.residual])
    step = DURATION / (NODES - 1)
    q = [casadi.SX.sym(f"q_{k}", model.n) for k in range(NODES)]
    padded = [q[1], *q, q[-2]]
    cost, loops = casadi.SX(0), [q[0] - first, q[-1] - last]
    for k, (before, here, after) in enumerate(zip(padded, q, padded[2:], strict=False)):
        rate, acceleration = (after - before) / (2 * step), (after - 2 * here + before) / step**2
        cost += step * casadi.sumsqr(u(here, rate, acceleration, p))
        if 0 < k < NODES - 1:
            loops.append(g(here, p))
    problem = {"x": casadi.vertcat(*q), "f": cost, "g": casadi.vertcat(*loops)}
    options = {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes"}
    solver = casadi.nlpsol("solver", "ipopt", problem, options)
    optimum = solver(x0=start.ravel(), lbg=0, ubg=0)
    assert solver.stats()["success"]
    return optimum["x"].full().reshape(NODES, model.n)


@pytest.fixture
def page_run(tmp_path: Path, tool: Callable[[str], str]) -> Callable[[str], str]:
    """Runs the page's blocks in languages that a pattern names, beside the shipped model, and gives what they print."""
    tool("cc")
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    (tmp_path / "rapkm_2rrr_rr.yaml").write_bytes((shipped.ROOT / "models/rapkm_2rrr_rr.yaml").read_bytes())

    def run(languages: str) -> str:
        printed = ""
        for language, block in re.findall(rf"```({languages})\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL):
            command = ["sh", "-ec", block] if language == "sh" else [sys.executable, "-c", block]
            made = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
            assert made.returncode == 0, made.stderr
            printed += made.stdout
        return printed

    return run


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
def test_an_optimum_through_a_singularity_of_minimal_coordinates(
    tmp_path: Path, page_run: Callable[[str], str]
) -> None:
    printed = page_run(r"\w+")
    said = re.findall(r"prints `([^`]+)`", PAGE.read_text(encoding="utf-8"))
    assert len(said) == 4
    for line in said:
        assert line in printed
    nodes = np.load(tmp_path / "nodes.npy")
    # from the straight line between the ends, loops open: another start than the page's
    straight = np.linspace(nodes[0], nodes[-1], NODES)
    assert optimum_by_casadi(nodes[0], nodes[-1], straight) == pytest.approx(nodes, abs=1e-6)


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
def test_jacobians_of_an_external_function_are_those_of_its_values(
    tmp_path: Path, page_run: Callable[[str], str]
) -> None:
    """What CasADi makes of `jac_u` and `jac_g` against differences of `u` and `g`."""
    page_run("sh")
    library = str(tmp_path / "rapkm_external.so")
    for name, count in (("u", 3), ("g", 1)):
        function = casadi.external(name, library)
        x = casadi.MX.sym("x", 6 * count)
        value = function(*casadi.vertsplit(x, 6))
        both = casadi.Function("both", [x], [value, casadi.jacobian(value, x)])
        place = np.random.default_rng(5).uniform(0.3, 1.2, 6 * count)
        slopes, step = both(place)[1].full(), 1e-5
        for k, axis in enumerate(np.eye(6 * count)):
            difference = (both(place + step * axis)[0] - both(place - step * axis)[0]).full()[:, 0] / (2 * step)
            assert slopes[:, k] == pytest.approx(difference, rel=1e-6, abs=1e-7)
