"""Units of FMI, built by the script that lies beside them, and FMPy in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import shipped

from symgen.backends.fmi.backend import BACKEND
from symgen.ir.kernel import Program
from symgen.lowering.schedule import schedule
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities

# Where `make fmpy` puts it: beside the environment, where nothing else meets it.
FMPY = shipped.ROOT / "build/fmpy"
DYNAMICS = ("forward_dynamics", "inverse_dynamics")
HOLDING = ("projected_configuration", "admissible_velocity")
SIMULATED = (*DYNAMICS, *HOLDING, "constraint_residual", "energy")
ROLES, VERSIONS = ("plant", "controller"), (2, 3)

# Reads work on standard input and prints what comes of it; what FMPy says of itself goes to standard error.
BEGINNING = """\
import contextlib, json, sys
with contextlib.redirect_stdout(sys.stderr):
    import fmpy
    import numpy as np
    given = json.load(sys.stdin)
    answer = []
"""
ENDING = """
print(json.dumps(answer))
"""
# Work: motions of units, as rows of some outputs.
SIMULATE = """\
for unit, kind, values, outputs, stop, further in given:
    rows = fmpy.simulate_fmu(unit, validate=True, fmi_type=kind, stop_time=stop, output_interval=0.02,
                             start_values=values, output=outputs, **further)
    answer.append([[float(row[name]) for name in outputs] for row in rows])
"""


def program_of(model: Model, quantities: tuple[str, ...]) -> Program:
    """The kernels of some quantities, as derived: no verification."""
    derived = derive_quantities(model, quantities)
    return schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]


@cache
def program(name: str, quantities: tuple[str, ...] = SIMULATED) -> Program:
    """That of a shipped model."""
    return program_of(shipped.model(name), quantities)


def files_of(model: Model, made: Program) -> dict[str, str]:
    """Everything that a run writes for FMI."""
    assert BACKEND.around is not None
    files = BACKEND.around(model, [made])
    for variant in BACKEND.variants:
        files |= variant.emit(model, made)
    return files


def written(model: Model, made: Program, folder: Path) -> Path:
    """The folder `fmi` of a model under `folder`."""
    for path, text in files_of(model, made).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return folder / "fmi"


def built(tool: Callable[[str], str], model: Model, made: Program, folder: Path) -> Path:
    """The same with the archives of all units."""
    units = written(model, made, folder)
    environment = {**os.environ, "CC": tool("gcc")}
    command = [sys.executable, str(units / "build.py")]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stderr) == (0, "")
    assert len(result.stdout.splitlines()) == len(list(units.glob("fmi?/*.fmu")))
    return units


def needs_fmpy() -> None:
    """Skips a test where FMPy is missing, or fails it in CI."""
    if FMPY.is_dir() or find_spec("fmpy") is not None:
        return
    message = "FMPy (make fmpy) is not installed"
    if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
        pytest.fail(message)
    pytest.skip(message)


def under_fmpy(work: str, given: object) -> Any:
    """What `work`, which finds `given` and fills `answer`, comes to."""
    needs_fmpy()
    indented = "".join(f"    {line}\n" for line in work.splitlines())
    command = [sys.executable, "-c", BEGINNING + indented + ENDING]
    # FMPy leaves there what it unpacks
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "PYTHONPATH": str(FMPY), "TMPDIR": folder}
        result = subprocess.run(
            command, input=json.dumps(given), env=environment, capture_output=True, text=True, check=False
        )
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def archive(folder: Path, name: str, role: str, version: int) -> str:
    """Where a unit of a model is."""
    return str(folder / f"fmi{version}" / f"{name}_{role}.fmu")


def units_of_shipped(tool: Callable[[str], str], folders: pytest.TempPathFactory) -> Callable[[str], Path]:
    """What builds the units of a shipped model, once."""

    @cache
    def of(name: str) -> Path:
        needs_fmpy()
        return built(tool, shipped.model(name), program(name), folders.mktemp(name))

    return of
