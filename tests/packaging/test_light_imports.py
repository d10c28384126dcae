"""The way from a model to C loads no heavy library: the cold start has to stay short (python-flint costs 0.02 s)."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

MODELS = Path(__file__).resolve().parents[2] / "models"
HEAVY = ("sympy", "casadi", "numpy", "mpmath", "pydantic", "matplotlib", "rich", "pint", "typst", "typer")
HEAVY += ("http", "ssl")


def modules_after(*arguments: str) -> set[str]:
    script = "import sys; from symgen.cli.main import main; code = main(sys.argv[1:]); print(code, *sys.modules)"
    command = [sys.executable, "-c", script, *arguments]
    made = subprocess.run(command, capture_output=True, text=True, check=True)
    code, *modules = made.stdout.splitlines()[-1].split()
    assert code == "0"
    return {module.split(".")[0] for module in modules}


def test_model_to_c(tmp_path: Path) -> None:
    loaded = modules_after(
        str(MODELS / "front_car.yaml"), "--only", "c", "--no-verify", "--quiet", "--out", str(tmp_path)
    )
    assert (tmp_path / "front_car/c/front_car.h").exists()
    assert not loaded & set(HEAVY)


def test_a_report_leaves_its_libraries_to_the_process_that_makes_it(tmp_path: Path) -> None:
    loaded = modules_after(str(MODELS / "skate.yaml"), "--no-verify", "--quiet", "--out", str(tmp_path))
    assert (tmp_path / "skate/report/skate.html").exists()
    assert not loaded & set(HEAVY)


def test_the_command_line_itself_loads_no_template_engine_and_no_yaml() -> None:
    script = "import sys, symgen.cli.main; print(*sys.modules)"
    made = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert not {"jinja2", "yaml"} & {module.split(".")[0] for module in made.stdout.split()}
