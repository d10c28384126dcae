"""FMI: what is written, valid to FMPy and to the standard's headers, built alike; the page."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import handmade
import numpy as np
import pytest
import shipped
from fmi_units import (
    DYNAMICS,
    FMPY,
    HOLDING,
    ROLES,
    SIMULATE,
    SIMULATED,
    VERSIONS,
    archive,
    built,
    files_of,
    needs_fmpy,
    program,
    program_of,
    under_fmpy,
    units_of_shipped,
    written,
)

from symgen.model.load import load_text

# Names that importers or FMI have themselves, text that is no XML, no parameter and no input.
CLASHING = """\
model: fmi3
description: arms < legs & "springs"
coordinates: {time: {unit: m, description: <up>}, step_size: {}}
kinetic_energy: time_dot**2/2 + step_size_dot**2
potential_energy: time**2 - 2*step_size
"""
# Names of the units' own sources, which hold parameters too.
OF_SOURCES = """\
model: unit
coordinates: {place: {}, states: {}}
parameters: {STATES: {value: 2}, VARIABLES: {value: 3}, return_rate: {value: 1}, content: {value: 4}, now: {value: 1}}
kinetic_energy: now*STATES*place_dot**2/2 + VARIABLES*states_dot**2
potential_energy: return_rate*place + content*states
inputs: {variables: {acts_on: {place: 1}}, slope: {acts_on: {states: 1}}}
"""
# A closed loop and wheels.
VALIDATED = ("slider_crank", "front_car")
VALIDATE = """\
from fmpy.validation import validate_fmu
answer = [validate_fmu(path) for path in given]
"""


@pytest.fixture(scope="module")
def units(tool: Callable[[str], str], tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    return units_of_shipped(tool, tmp_path_factory)


@pytest.mark.toolchain
@pytest.mark.slow
def test_descriptions_are_valid(units: Callable[[str], Path], tool: Callable[[str], str], tmp_path: Path) -> None:
    """Those of all roles, and of a model whose names importers have themselves."""
    model = load_text(CLASHING, "clashing.yaml")
    assert model.c_name == "fmi3_model"
    clashing = built(tool, model, program_of(model, ("forward_dynamics",)), tmp_path)
    archives = [path for folder in (clashing, *map(units, VALIDATED)) for path in sorted(folder.glob("fmi?/*.fmu"))]
    assert len(archives) == 2 + 4 * len(VALIDATED)
    assert under_fmpy(VALIDATE, [str(path) for path in archives]) == [[] for _ in archives]
    names = ["time_", "step_size", "time", "step_size_"]
    about = ElementTree.parse(clashing / "fmi3/fmi3_model_plant/modelDescription.xml").getroot()
    known = {one.get("name"): one for one in about.iter("Float64")}
    assert [known[name].get("causality") for name in names] == ["output", "output", "independent", "parameter"]
    assert known["time_"].get("description") == "<up>"
    assert "arms < legs & \"springs\"" in str(about.get("description"))
    # it falls along step_size with 1, and oscillates along time
    work = [
        [archive(clashing, "fmi3_model", "plant", version), kind, {"time_": 0.5}, ["time_", "step_size"], 1.0, further]
        for version in VERSIONS
        for kind, further in (("CoSimulation", {}), ("ModelExchange", {"relative_tolerance": 1e-8}))
    ]
    for rows in under_fmpy(SIMULATE, work):
        assert rows[-1] == pytest.approx([0.5 * np.cos(np.sqrt(2)), rows[0][1] + 0.5], abs=1e-6)


@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.parametrize("version", VERSIONS)
def test_interfaces_are_those_of_the_standard(tool: Callable[[str], str], version: int, tmp_path: Path) -> None:
    """The same sources against the standard's headers, where FMPy has them: every function has its prototype."""
    needs_fmpy()
    (tmp_path / "standard").mkdir()
    (tmp_path / f"standard/fmi{version}.h").write_text(f'#include "fmi{version}Functions.h"\n', encoding="utf-8")
    flags = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-Wmissing-prototypes", "-fsyntax-only"]
    standard = [f"-I{tmp_path}/standard", f"-isystem{FMPY}/fmpy/c-code"]
    parts = [("front_car", SIMULATED), *(("slider_crank", (*DYNAMICS, *held)) for held in ((), *zip(HOLDING), HOLDING))]
    for number, (name, quantities) in enumerate(parts):
        folder = written(shipped.model(name), program(name, quantities), tmp_path / str(number))
        for role in ROLES:
            (source,) = folder.glob(f"fmi{version}/{name}_{role}/sources/*.c")
            for headers in (standard, ["-Wno-missing-prototypes"]):
                command = [tool("gcc"), *flags, *headers, f"-I{folder}/sources", str(source)]
                result = subprocess.run(command, capture_output=True, text=True, check=False)
                assert (result.returncode, result.stderr) == (0, "")


@pytest.mark.toolchain
def test_builds_alike_and_says_what_is_missing(tool: Callable[[str], str], tmp_path: Path) -> None:
    folders = [built(tool, shipped.model("skate"), program("skate"), tmp_path / name) for name in "ab"]
    first, second = ({path.name + path.parent.name: path.read_bytes() for path in f.glob("*/*.fmu")} for f in folders)
    assert first == second
    assert len(first) == len(ROLES) * len(VERSIONS)
    environment = {key: value for key, value in os.environ.items() if key != "CC"} | {"PATH": str(tmp_path)}
    command = [sys.executable, str(folders[0] / "build.py")]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert result.stderr.startswith("no C compiler: cc, gcc and clang not found; install gcc or clang")


@pytest.mark.toolchain
def test_parameters_may_be_called_like_parts_of_a_unit(tool: Callable[[str], str], tmp_path: Path) -> None:
    model = load_text(OF_SOURCES, "unit.yaml")
    folder = built(tool, model, program_of(model, DYNAMICS), tmp_path)
    assert len([*folder.glob("*/*.fmu")]) == len(ROLES) * len(VERSIONS)


@pytest.mark.slow
def test_two_runs_write_the_same_bytes(tmp_path: Path) -> None:
    """Through the command line, under two hash seeds."""
    made = []
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(shipped.ROOT)}
        options = ["--only", "fmi", "--recorded", str(shipped.ROOT / "generated"), "--out", str(tmp_path / seed)]
        command = [sys.executable, "-m", "symgen", str(shipped.ROOT / "models/skate.yaml"), *options, "--quiet"]
        subprocess.run(command, env=environment, check=True, capture_output=True)
        paths = sorted(path for path in (tmp_path / seed / "skate/fmi").rglob("*") if path.is_file())
        made.append([(str(p.relative_to(tmp_path / seed)), hashlib.sha256(p.read_bytes()).hexdigest()) for p in paths])
    assert made[0] == made[1]
    assert len(made[0]) == 15


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.slow
def test_the_documentations_example(units: Callable[[str], Path], tmp_path: Path) -> None:
    page = (shipped.ROOT / "docs/fmi.md").read_text(encoding="utf-8")
    (script,), (shown,) = (re.findall(rf"^```{kind}\n(.*?)^```$", page, re.M | re.S) for kind in ("python", "text"))
    (tmp_path / "generated/slider_crank").mkdir(parents=True)
    (tmp_path / "generated/slider_crank/fmi").symlink_to(units("slider_crank"))
    environment = {**os.environ, "PYTHONPATH": str(FMPY)}
    command = [sys.executable, "-c", script]
    made = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert (made.returncode, made.stdout) == (0, shown), made.stderr


def test_a_unit_is_made_of_what_it_works_out() -> None:
    model, made = handmade.model(), handmade.program()
    files = files_of(model, made)
    assert {path.split("/")[2] for path in files if path.endswith("modelDescription.xml")} == {"toy_controller"}
    # what the C calls otherwise has its name here, and the token is that of the description
    description = files["fmi/fmi2/toy_controller/modelDescription.xml"]
    assert '<ScalarVariable name="I" ' in description
    (token,) = re.findall(r'guid="(\{[0-9a-f-]{36}\})"', description)
    source = files["fmi/fmi2/toy_controller/sources/toy_controller.c"]
    assert f'"{token}"' in source
    assert "offsetof(content, p.I_)" in source
    other = files_of(replace(model, text_hash="other"), made)
    assert token not in other["fmi/fmi2/toy_controller/modelDescription.xml"]
    alone = files_of(model, replace(made, kernels=()))
    assert all(path.startswith("fmi/sources/toy.") for path in alone)
