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


def equations_by_casadi() -> tuple[dict[str, Any], list[float]]:
    """u(q, qd, qdd, p) by (27) with (28) and g(q, p), which know nothing of the generated code; the parameters p."""
    model = shipped.model("rapkm_2rrr_rr")
    s = differentiate(model)
    usual = default_values(model.parameters)
    u = casadi.Function("u", [s.q, s.qd, s.qdd, s.p], [inverse_dynamics(model, s)])
    return {"u": u, "g": casadi.Function("g", [s.q, s.p], [s.residual])}, [usual[one.name] for one in model.parameters]


def optimum_by_casadi(first: Any, last: Any, start: Any) -> Any:
    """The nodes (41 x 6) of least sum of squared inputs between two configurations, from (27) with (28) in CasADi.

    It knows nothing of the generated code; IPOPT has exact Hessians of it.
    """
    equations, p = equations_by_casadi()
    u, g, n = equations["u"], equations["g"], 6
    step = DURATION / (NODES - 1)
    q = [casadi.SX.sym(f"q_{k}", n) for k in range(NODES)]
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
    return optimum["x"].full().reshape(NODES, n)


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
def test_an_external_function_and_its_jacobian_are_those_of_equations_that_casadi_differentiates(
    tmp_path: Path, page_run: Callable[[str], str]
) -> None:
    """`u`, `g`, `jac_u` and `jac_g` against (27) with (28) and the residual, and CasADi's derivatives of these."""
    page_run("sh")
    library = str(tmp_path / "rapkm_external.so")
    equations, p = equations_by_casadi()
    for name, count in (("u", 3), ("g", 1)):
        external = casadi.external(name, library)
        made = []
        for function, further in ((external, ()), (equations[name], (p,))):
            x = casadi.MX.sym("x", 6 * count)
            value = function(*casadi.vertsplit(x, 6), *further)
            made.append(casadi.Function("both", [x], [value, casadi.jacobian(value, x)]))
        place = np.random.default_rng(5).uniform(0.3, 1.2, 6 * count)
        for ours, theirs in zip(made[0](place), made[1](place), strict=True):
            assert ours.full() == pytest.approx(theirs.full(), rel=1e-11, abs=1e-12)
