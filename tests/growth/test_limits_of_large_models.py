"""Large models of one kind end below stated limits of counted work and memory."""

from __future__ import annotations

import math
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from symgen.generation.results import Options
from symgen.model.load import load_text
from symgen.pipeline import generate
from symgen.quantities.select import derive_quantities
from symgen.runtime.effort import done, worth_trying

LINKS = 200
# Of a verified run: CPU seconds, and MB that its largest process holds.
SECONDS, MEMORY = 60, 1000


def dependent_rows(scales: tuple[str, ...]) -> str:
    """A slider on an ellipse, the same row written several times."""
    rows = "\n".join(f"    row{k}: {scale}*(x**2/4 + y**2 - 1)" for k, scale in enumerate(scales))
    return f"""model: ellipse
coordinates: {{x: {{range: [0.3, 1.5]}}, y: {{range: [0.3, 1]}}, z: {{range: [-1, 1]}}}}
parameters: {{m: 2}}
kinetic_energy: m*(x_dot**2 + y_dot**2 + z_dot**2)/2
potential_energy: 9.81*m*y + z*x
constraints:
  geometric:
{rows}
inputs: {{push: {{acts_on: {{x: 1}}}}, lift: {{acts_on: {{z: 1}}}}}}
configuration: {{x: 1, y: 0.87, z: 0}}
outputs: [inverse_dynamics, forward_dynamics]
"""


def chain(links: int) -> str:
    """A chain of rods that hangs from the ground, driven at every joint."""
    lines = ["model: chain", "gravity: [0, -9.81, 0]", "joints:"]
    for k in range(links):
        parent = f", parent: j{k - 1}, at: [0.1, 0, 0]" if k else ""
        lines.append(f"  j{k}: {{type: revolute, axis: z, coordinate: a{k}{parent}}}")
    lines.append("bodies:")
    lines += [f"  j{k}: {{mass: 0.2, com: [0.05, 0, 0], inertia: {{zz: 0.0002}}}}" for k in range(links)]
    lines.append("inputs:")
    lines += [f"  u{k}: {{joint: a{k}}}" for k in range(links)]
    return "\n".join([*lines, "outputs: [inverse_dynamics]", ""])


def hexapod() -> str:
    """A platform on six rods, each with two bearings in the ground and a driven slide, pinned to it by balls."""
    platform = [("slide_x", "prismatic", "x", ""), ("slide_y", "prismatic", "y", "slide_x")]
    platform += [("slide_z", "prismatic", "z", "slide_y"), ("turn_x", "revolute", "x", "slide_z")]
    platform += [("turn_y", "revolute", "y", "turn_x"), ("plate", "revolute", "z", "turn_y")]
    joints = [
        f"  {name}: {{type: {kind}, axis: {axis}, coordinate: q_{name}{f', parent: {parent}' if parent else ''}}}"
        for name, kind, axis, parent in platform
    ]
    start = {name: 0.9 if name == "slide_z" else 0.0 for name, *_ in platform}
    frames, loops, inputs = [], [], []
    bodies = ["  plate: {mass: 20, com: [0, 0, 0.05], inertia: {xx: 0.5, yy: 0.5, zz: 0.9}}"]
    for k in range(6):
        low, high = (k + 0.35 * (-1) ** k) * math.pi / 3, (k - 0.2 * (-1) ** k) * math.pi / 3
        base = (round(0.8 * math.cos(low), 3), round(0.8 * math.sin(low), 3))
        top = (round(0.4 * math.cos(high), 3), round(0.4 * math.sin(high), 3))
        across, along, up = top[0] - base[0], top[1] - base[1], start["slide_z"]
        length = math.sqrt(across * across + along * along + up * up)
        # a turn about x, then one about y, brings z to the rod
        start |= {f"first{k}": -math.atan2(along, up), f"second{k}": math.asin(across / length), f"rod{k}": length}
        joints += [
            f"  first{k}: {{type: revolute, axis: x, coordinate: q_first{k}, at: [{base[0]}, {base[1]}, 0]}}",
            f"  second{k}: {{type: revolute, axis: y, coordinate: q_second{k}, parent: first{k}}}",
            f"  rod{k}: {{type: prismatic, axis: z, coordinate: q_rod{k}, parent: second{k}}}",
        ]
        frames.append(f"  top{k}: {{parent: plate, translation: [{top[0]}, {top[1]}, 0]}}")
        bodies.append(f"  second{k}: {{mass: 2, com: [0, 0, 0.2], inertia: {{xx: 0.02, yy: 0.02, zz: 0.001}}}}")
        bodies.append(f"  rod{k}: {{mass: 1, com: [0, 0, -0.2], inertia: {{xx: 0.01, yy: 0.01, zz: 0.001}}}}")
        loops.append(f"  ball{k}: {{type: spherical, between: [rod{k}, top{k}]}}")
        inputs.append(f"  u{k}: {{joint: q_rod{k}}}")
    given = ", ".join(f"q_{name}: {value:.6f}" for name, value in start.items())
    parts = [["joints:", *joints], ["frames:", *frames], ["bodies:", *bodies], ["loops:", *loops]]
    parts += [["inputs:", *inputs], [f"configuration: {{{given}}}", "outputs: [inverse_dynamics]", ""]]
    return "\n".join(["model: hexapod", "gravity: [0, 0, -9.81]", *(line for part in parts for line in part)])


def test_twice_the_multiples_of_one_row_are_about_twice_the_operations() -> None:
    """One of them in other units: subsets of more rows than are independent would double with each."""

    def operations(*scales: str) -> int:
        choice = derive_quantities(load_text(dependent_rows(scales), "ellipse.yaml"), ("inverse_dynamics",)).choices[0]
        return dict(choice.costs)[choice.title]

    five = ("1", "2", "-3", "1/7", "1e4")
    assert operations(*five, "5", "-1/3", "1e-3", "11", "1/9") <= 2.5 * operations(*five)


@pytest.mark.campaign
def test_rows_that_are_multiples_of_one_row_are_verified(tmp_path: Path) -> None:
    path = tmp_path / "ellipse.yaml"
    path.write_text(dependent_rows(("1", "2", "-3", "1/7", "1e4")))
    result = generate(path, Options(states=8, parts=("c", "python")), lambda _: None)
    assert not result.failures


@pytest.mark.campaign
def test_a_gear_in_a_long_chain_leaves_its_accelerations_to_the_links() -> None:
    """What would factor the whole mass matrix is given up once that takes longer than it may be worth."""
    text = chain(60).replace("[inverse_dynamics]", "[forward_dynamics]")
    geared = load_text(f"{text}constraints: {{geometric: {{gear: a9 - 2*a8}}}}\n", "chain.yaml")
    before = done()
    (choice,) = derive_quantities(geared, ["forward_dynamics"]).choices
    assert choice.method == "articulated"
    assert done() - before < 3 * worth_trying(min(dict(choice.costs).values()))


@pytest.mark.campaign
def test_u_of_a_long_chain_takes_a_few_operations_a_link() -> None:
    few, many = (
        derive_quantities(load_text(chain(links), "chain.yaml"), ("inverse_dynamics",)).choices[0]
        for links in (LINKS // 4, LINKS // 2)
    )
    assert dict(many.costs)[many.title] <= 2.1 * dict(few.costs)[few.title]


@pytest.mark.campaign
@pytest.mark.parametrize("make", [lambda: chain(LINKS), hexapod], ids=["chain", "hexapod"])
def test_a_verified_run_of_a_large_model_stays_below_its_limits(make: Callable[[], str], tmp_path: Path) -> None:
    """CPU of the run and of all it starts, and the largest process of these."""
    path = tmp_path / "large.yaml"
    path.write_text(make())
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    made = subprocess.run(
        [sys.executable, "-m", "symgen", str(path), "--out", str(tmp_path / "out"), "--only", "c,python"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert made.returncode == 0, made.stderr[-2000:]
    assert after.ru_utime - before.ru_utime <= SECONDS
    assert after.ru_maxrss <= MEMORY * 1024
