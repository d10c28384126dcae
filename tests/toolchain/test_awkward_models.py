"""Models at the edge of what a user may write: names that C, C++, NumPy or Arduino know, and empty sizes."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from generated_python import load_generated

from symgen.generation.results import Options
from symgen.pipeline import generate

pytestmark = pytest.mark.toolchain
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
MACROS = """#include <complex.h>
#include <math.h>
#define F(text) text
#define B1 1
#define PI 3.1415926535897932384626433832795
#define HIGH 1
#define min(a, b) ((a) < (b) ? (a) : (b))
"""
NAMES = """model: awkward
coordinates:
  I: {}
  F: {}
  q: {}
  u: {}
parameters: {e: 2, N: 3, gamma: 4, lam: 5, y1: 6, B1: 7, PI: 3, HIGH: 1, min: 2, p: 1, rest: 1, np: 1, G: 1, status: 1}
definitions:
  entries: e*N
  sine: sin(I)*p + status
kinetic_energy: G*(I_dot**2*gamma + F_dot**2*lam + q_dot**2*y1*min + u_dot**2*np)/2
potential_energy: entries*cos(F)*B1 + HIGH*PI*rest*I*sine
constraints:
  nonholonomic:
    roll: sin(I)*F_dot - cos(I)*q_dot
inputs:
  qd: {acts_on: {I: 1, F: cos(I)}}
  qdd: {acts_on: {F: 1, q: sin(I)}}
outputs: all
"""
FREE = "model: free\ncoordinates: {x: {}}\nkinetic_energy: x_dot**2/2\noutputs: all\n"


def made(folder: Path, text: str) -> Path:
    """The folder with the generated files of a model text."""
    path = folder / "model.yaml"
    path.write_text(text)
    result = generate(path, Options(parts=("c", "python"), verify=False), lambda _: None)
    for name, content in result.files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(str(content))
    return folder


@pytest.mark.campaign
@pytest.mark.parametrize("compiler", ["gcc", "clang", "g++"])
@pytest.mark.parametrize("text", [NAMES, FREE], ids=["names", "free"])
def test_compiles_after_every_macro(tool: Callable[[str], str], tmp_path: Path, compiler: str, text: str) -> None:
    folder = made(tmp_path, text)
    (tmp_path / "macros.h").write_text(MACROS if compiler != "g++" else MACROS.split("\n", 2)[2])
    language = ["-xc++", "-std=c++11"] if compiler == "g++" else ["-std=c99"]
    for source in sorted((folder / "c").glob("*.c")):
        command = [
            tool(compiler),
            *STRICT,
            *language,
            "-include",
            str(tmp_path / "macros.h"),
            "-fsyntax-only",
            str(source),
        ]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr


def test_awkward_names_keep_their_python_spelling_and_their_bits(tool: Callable[[str], str], tmp_path: Path) -> None:
    tool("cc")
    module = load_generated(made(tmp_path, NAMES) / "python/awkward.py")
    compiled = module.compile()
    q = np.random.default_rng(3).normal(size=(20, 4))
    p = module.Parameters(PI=2.5, B1=0.5, np=3.0)
    for name in ("mass_matrix", "potential_force"):
        ours = getattr(module, name)(q, p)
        assert ours.tobytes() == getattr(compiled, name)(q, p).tobytes()
        assert np.isfinite(ours).all()
    ours = module.inverse_dynamics(q, q, q, p)
    assert ours.tobytes() == compiled.inverse_dynamics(q, q, q, p).tobytes()
    header = (tmp_path / "c/awkward.h").read_text()
    for old in ("B1", "PI", "HIGH", "min", "gamma", "y1"):
        assert f"   {old} is {old}_\n" in header


def test_no_input_no_constraint_no_parameter(tmp_path: Path) -> None:
    folder = made(tmp_path, FREE)
    header = (folder / "c/free.h").read_text()
    assert (
        "free_forward_dynamics(const double q[1], const double qd[1], const free_params *p, double qdd[1]);" in header
    )
    assert "double unused;" in header
    assert "inverse_dynamics(" not in header
    module = load_generated(folder / "python/free.py")
    assert module.forward_dynamics([0.5], [1.0]).tolist() == [0.0]
    assert module.mass_matrix(np.zeros((3, 1))).shape == (3, 1, 1)
