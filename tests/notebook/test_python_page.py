"""docs/python.md is true, and its notebook: the cells run from top to bottom and show what a notebook would show."""

from __future__ import annotations

import ast
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
import sympy
from notebook_page import NOTEBOOK, PAGE, notebook

from symgen.notebook.motions import SimulatedModel
from symgen.notebook.results import GeneratedModel

ROOT = Path(__file__).parents[2]


def run_cell(source: str, names: dict[str, object]) -> object:
    """Runs a cell as a notebook does: the value of an expression at its end is shown."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, NOTEBOOK, "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), NOTEBOOK, "eval"), names)


def cells() -> list[Mapping[str, Any]]:
    """Those of the notebook as it lies in the repository."""
    whole = json.loads((ROOT / NOTEBOOK).read_text(encoding="utf-8"))
    assert (whole["nbformat"], whole["nbformat_minor"]) == (4, 5)
    return list(whole["cells"])


def test_the_notebook_is_that_of_the_page() -> None:
    page = (ROOT / PAGE).read_text(encoding="utf-8")
    assert (ROOT / NOTEBOOK).read_text(encoding="utf-8") == notebook(page), "run `python tools/notebook_page.py`"
    assert len({cell["id"] for cell in cells()}) == len(cells())
    # words and code of the page, in their order
    again = [
        f"```python\n{''.join(cell['source'])}\n```" if cell["cell_type"] == "code" else "".join(cell["source"])
        for cell in cells()
    ]
    assert "".join("".join(again).split()) == "".join(page.split())


@pytest.mark.slow
@pytest.mark.toolchain
@pytest.mark.campaign
def test_the_cells_run_and_show_what_they_make(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    code = ["".join(cell["source"]) for cell in cells() if cell["cell_type"] == "code"]
    assert len(code) > 6
    names: dict[str, object] = {}
    shown = [run_cell(source, names) for source in code]
    printed = capsys.readouterr().out
    assert "unknown name `M_c` in the kinetic energy" in printed
    assert "forces act on coordinates; name one of them: x, a" in printed
    assert (tmp_path / "build" / "example" / "cart" / "c" / "cart.c").is_file()
    assert (tmp_path / "arm.svg").read_text(encoding="utf-8").startswith("<?xml")
    assert "<html" in (tmp_path / "arm.html").read_text(encoding="utf-8")
    matrix, made, motion = (one for one in shown if one is not None)
    assert isinstance(matrix, sympy.MatrixBase)
    assert isinstance(made, GeneratedModel)
    assert isinstance(motion, SimulatedModel)
    assert r"\begin{matrix}" in matrix._repr_latex_()
    assert "inverse_dynamics" in made._repr_html_()
    # a chart, and the animation in a frame of its own
    assert "<svg" in motion._repr_html_()
    assert "<iframe srcdoc=" in motion._repr_html_()
