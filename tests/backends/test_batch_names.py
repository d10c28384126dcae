"""Names of a model that the batch and prepared files use themselves are renamed inside, not in the parameter struct."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from symgen.backends.c.batch import emit_c_batch
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.lowering.schedule import schedule
from symgen.model.load import load_model
from symgen.quantities.select import derive_quantities

MODEL = """model: awkward
coordinates:
  x:
  k:
parameters: {count: 2, stride: 3, rest: 1, flag: 1, i: 3, LANES: 2, q_one: 1, y: 2, v1: 2, value: 1, prepared: 2}
kinetic_energy: (count + stride*rest)/2*x_dot**2 + (flag + i*LANES*y)*k_dot**2 + v1*prepared*x_dot*k_dot/9*sin(k)
potential_energy: q_one*cos(k)*value
inputs:
  u: {acts_on: {x: 1}}
  status: {acts_on: {k: 1}}
"""
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-fsyntax-only"]


@pytest.mark.toolchain
@pytest.mark.parametrize("language", [["-std=c99"], ["-xc++", "-std=c++11"]], ids=["C", "C++"])
def test_awkward_names_compile(tool: Callable[[str], str], tmp_path: Path, language: list[str]) -> None:
    path = tmp_path / "awkward.yaml"
    path.write_text(MODEL)
    model = load_model(path)
    derivations = derive_quantities(model, ("inverse_dynamics", "forward_dynamics"))
    for program in schedule(derivations.mechanics, derivations.quantities, ("float64", "float32")).values():
        files = emit_c(model, program) | emit_c_batch(model, program) | emit_c_prepared(model, program)
        assert len(files) == 6
        for name, text in files.items():
            (tmp_path / Path(name).name).write_text(text)
    sources = sorted(map(str, tmp_path.glob("*.c")))
    made = subprocess.run([tool("gcc"), *language, *STRICT, *sources], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    assert "= p->count;" in (tmp_path / "awkward_batch.c").read_text()
