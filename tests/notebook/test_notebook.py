"""`derive` for notebooks: SymPy matrices and CasADi functions that agree, made only when asked for."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sympy

from symgen.diagnostics import ModelError
from symgen.model.load import load_model
from symgen.notebook.quantities import NotebookModel, derive

MODELS = Path(__file__).parents[2] / "models"


@pytest.fixture(scope="module")
def car() -> NotebookModel:
    return derive(MODELS / "front_car.yaml")


def test_sympy_closed_form_of_the_paper(car: NotebookModel) -> None:
    theta, phi, L = sympy.symbols("theta phi L")
    c, s = sympy.cos(theta) * sympy.cos(phi), sympy.sin(theta) * sympy.cos(phi)
    expected = sympy.Matrix([[c, s, sympy.sin(phi) / L, 0], [0, 0, 0, 1]])
    assert car.sympy["projected_control_pseudoinverse"] == expected


def test_casadi_function_gives_the_same_numbers(car: NotebookModel) -> None:
    q = [0.1, -0.2, 0.7, 0.4]
    names = [coordinate.name for coordinate in car.model.coordinates]
    values = dict(zip(names, q, strict=True)) | {"L": float(car.parameters[0])}
    assert car.model.parameters[0].name == "L"
    number = np.array(car.sympy["nullspace_projector"].subs(values).tolist(), dtype=float)
    assert car.casadi["nullspace_projector"](q, car.parameters).full() == pytest.approx(number, abs=1e-14)


def test_intermediates_are_written_out() -> None:
    crank = derive(load_model(MODELS / "slider_crank.yaml"))
    assert crank.closed_forms.forms["nullspace_projector"].intermediates
    known = {c.name for c in crank.model.coordinates} | {p.name for p in crank.model.parameters}
    assert {symbol.name for symbol in crank.sympy["nullspace_projector"].free_symbols} <= known


def test_a_missing_quantity_says_why(car: NotebookModel) -> None:
    with pytest.raises(KeyError, match="no_such_thing is none of mass_matrix"):
        car.casadi["no_such_thing"]
    with pytest.raises(KeyError, match="constraint_pseudoinverse: not written out"):
        derive(MODELS / "rapkm_2rrr_rr.yaml").sympy["constraint_pseudoinverse"]


def test_repr_lists_what_there_is(car: NotebookModel) -> None:
    assert repr(car).startswith("front_car: 4 coordinates (x, y, theta, phi), 2 constraints, 2 inputs")
    assert "nullspace_projector " in repr(car.casadi)
    assert "N_B, orthogonal projector" in repr(car.sympy)


def test_mistakes_are_the_models() -> None:
    with pytest.raises(FileNotFoundError):
        derive("no_such_model.yaml")


def test_mistakes_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text("model: m\ncoordinates: {x: {}}\nkinetic_energy: y_dot**2\n")
    with pytest.raises(ModelError, match="y_dot"):
        derive(tmp_path / "m.yaml")


def test_heavy_libraries_are_imported_when_used() -> None:
    code = (
        "import sys; from symgen.notebook.quantities import derive; derive(sys.argv[1]); "
        "print([name for name in ('sympy', 'casadi', 'numpy') if name in sys.modules])"
    )
    root = Path(__file__).parents[2]
    command = [sys.executable, "-c", code, str(MODELS / "skate.yaml")]
    assert subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout.strip() == "[]"
