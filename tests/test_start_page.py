"""The pages one starts with are true: their blocks run one after the other, and print what they say."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from page_blocks import Page


@pytest.mark.slow
@pytest.mark.toolchain
def test_the_first_machine(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    page = Page("start.md", tmp_path)
    (model,), (source,), (mistakes,), (python,) = map(page.blocks, ("yaml", "c", "text", "python"))
    page.write("lift.yaml", model)
    page.write("main.c", source)
    wrong = model.replace("com: [l/2, 0, 0], inertia", "com: [L/2, 0, 0], inertia").replace("joint: s", "joint: nut")
    page.write("wrong.yaml", wrong)
    assert page.run("symgen", "wrong.yaml", code=1).stderr.strip().endswith(mistakes.strip())
    printed = "".join(page.run("sh", "-ec", block).stdout for block in page.blocks("sh"))
    printed += page.run("python", "-c", python).stdout
    for said in re.findall(r"prints `([^`]+)`", page.text):
        assert said in printed
    for path in re.findall(r"- `((?:report|c|./python)/[^`]+)`", page.text):
        assert (tmp_path / "generated" / "lift" / path).is_file()
    assert (tmp_path / "generated/lift/simulation.csv").is_file()


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
@pytest.mark.parametrize("name", ["energies", "parallel-robot"])
def test_a_machine_by_each_form(name: str, tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    page = Page(f"{name}.md", tmp_path)
    (model,), (command,), (python,), (shown,) = map(page.blocks, ("yaml", "sh", "python", "text"))
    page.write(f"{model.split()[1]}.yaml", model)
    printed = page.run("sh", "-ec", command).stdout
    (counted,) = re.findall(r"says `(n = [^`]+)`", page.text)
    assert counted in printed
    assert page.run("python", "-c", python).stdout == shown


@pytest.mark.campaign
def test_without_its_third_branch_the_plotter_has_a_status_on_the_rail(tmp_path: Path) -> None:
    page = Page("parallel-robot.md", tmp_path)
    (model,) = page.blocks("yaml")
    less = re.sub(r"  (far|rod_3|tip_3|pin_3|f_3|d): .*\n", "", model)
    less = less.replace(", s_3: 0.37", "").replace(", a_3: -2.7", "").replace(", s_3]", "]")
    page.write("two.yaml", less)
    page.run("symgen", "two.yaml", "--only", "python", "--no-verify")
    (said,) = re.findall(r"u has the status `(\w+)`", page.text)
    flat = "plotter.inverse_dynamics([-0.4, 0.4, 0.0, 3.141592653589793], [0.0] * 4, [0.0] * 4)"
    source = f"import sys\nsys.path.append('generated/plotter/python')\nimport plotter\n{flat}"
    assert f"inverse_dynamics: {said}" in page.run("python", "-c", source, code=1).stderr


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
def test_a_robot_with_a_loop(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    page = Page("urdf.md", tmp_path)
    (tree,), (model,), (command,), (python,) = map(page.blocks, ("xml", "yaml", "sh", "python"))
    mistake, shown = page.blocks("text")
    page.write("leg.urdf", tree)
    page.write("leg.yaml", model)
    page.write("wrong.yaml", model.replace("type: point, between: [rod_end, lever]",
                                           "type: revolute, between: [rod_end, lever], axis: y"))  # fmt: skip
    assert page.run("symgen", "wrong.yaml", code=1).stderr.strip().endswith(mistake.strip())
    printed = page.run("sh", "-ec", command).stdout
    (counted,) = re.findall(r"u takes (\d+) operations", page.text)
    assert re.search(rf"inverse_dynamics +{counted}\n", printed)
    assert "r = 2, δ = 2, m = 2" in printed
    assert page.run("python", "-c", python).stdout == shown


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.toolchain
def test_machines_from_other_formats(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("cc")
    page = Page("robots.md", tmp_path)
    (crane, press), models, (commands,), (python,) = map(page.blocks, ("xml", "yaml", "sh", "python"))
    shown, mistake = page.blocks("text")
    page.write("crane.xml", crane)
    page.write("press.sdf", press)
    for model in models:
        page.write(f"{model.split()[1]}.yaml", model)
    motor = '<motor name="pressure" joint="stroke"/>'
    page.write("wrong.xml", crane.replace(motor, '<position name="servo" joint="stroke" kp="9"/>'))
    page.write("wrong.yaml", models[0].replace("crane.xml", "wrong.xml"))
    assert page.run("symgen", "wrong.yaml", code=1).stderr.strip().endswith(mistake.strip())
    printed = page.run("sh", "-ec", commands).stdout
    (counted,) = re.findall(r"in place of (\d+)", page.text)
    assert re.search(rf"inverse_dynamics +{counted}\n", printed)
    assert page.run("python", "-c", python).stdout == shown
