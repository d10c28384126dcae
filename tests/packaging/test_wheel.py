"""A wheel built from the tree, installed elsewhere, generates the same files: templates travel with it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

from symgen import __version__

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stdout + made.stderr
    (built,) = folder.glob("*.whl")
    return built


def test_the_version_stands_in_one_place(wheel: Path) -> None:
    """The build reads it from the package, and what cites symgen says the same."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert "version" not in project
    assert wheel.name == f"symgen-{__version__}-py3-none-any.whl"
    assert re.findall(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.M) == [__version__]
    assert f"\n## {__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.campaign
def test_wheel_holds_the_templates_and_no_tests(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    templates = {path.relative_to(ROOT).as_posix() for path in (ROOT / "templates").rglob("*") if path.is_file()}
    assert templates
    assert {f"symgen/{path}" for path in templates} <= set(names)
    assert not [name for name in names if name.startswith(("tests/", "generated/", "models/"))]


def test_generates_from_an_installed_wheel(wheel: Path, tmp_path: Path) -> None:
    """The dependencies come from this environment through a path file; symgen itself only from the wheel."""
    home = tmp_path / "venv"
    venv.create(home, with_pip=False)
    python = home / "bin/python"
    site = next(home.glob("lib/python3*/site-packages"))
    zipfile.ZipFile(wheel).extractall(site)
    # Only its folder is added, so the path files of an editable install there are not read.
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}

    def run(interpreter: str | Path, *arguments: str, path: str = "") -> str:
        given = environment | ({"PYTHONPATH": path} if path else {})
        command = [str(interpreter), *arguments]
        made = subprocess.run(command, cwd=elsewhere, env=given, capture_output=True, text=True, check=False)
        assert made.returncode == 0, made.stdout + made.stderr
        return made.stdout

    assert run(python, "-c", "import symgen; print(symgen.__file__)").startswith(str(site))
    model = str(ROOT / "models/skate.yaml")
    run(python, "-m", "symgen", model, "--no-verify")
    run(sys.executable, "-m", "symgen", model, "--check", path=str(ROOT))
