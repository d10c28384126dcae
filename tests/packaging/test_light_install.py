"""symgen with what it depends on and nothing else: the main way works, the rest says in a line what it needs."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sysconfig
import tomllib
import venv
from importlib.metadata import distribution
from pathlib import Path

import pytest

from symgen.generation.packages import EXTRA_OF, to_install
from symgen.output.manifest import CHECKSUMS

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
pytestmark = pytest.mark.slow


def names(requirements: list[str]) -> list[str]:
    """Those of packages; an extra may take in others of symgen."""
    return [requirement.partition(">")[0] for requirement in requirements if not requirement.startswith("symgen[")]


@pytest.fixture(scope="module")
def light(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An interpreter that finds symgen and what it depends on, linked one by one."""
    home = tmp_path_factory.mktemp("light") / "venv"
    venv.create(home, with_pip=False)
    site = next(home.glob("lib/python3*/site-packages"))
    for name in (*names(PROJECT["dependencies"]), "markupsafe"):
        parts = {Path(file).parts[0] for file in distribution(name).files or () if ".." not in Path(file).parts}
        for part in parts - {"__pycache__"}:
            source = Path(sysconfig.get_path("purelib")) / part
            if source.exists() and not (site / part).exists():
                (site / part).symlink_to(source)
    (site / "symgen.pth").write_text(f"{ROOT}\n")
    return home / "bin" / "python"


def run(light: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.run([str(light), *arguments], env=environment, capture_output=True, text=True, check=False)


def test_what_it_brings_stays_below_120_megabytes() -> None:
    """With what Python compiles of it, which of symgen itself is twice as much as its sources."""
    size = 0
    for name in (*names(PROJECT["dependencies"]), "markupsafe"):
        files = [Path(str(distribution(name).locate_file(file))) for file in distribution(name).files or ()]
        size += sum(file.stat().st_size for file in files if file.is_file())
    own = [path for folder in ("symgen", "templates") for path in (ROOT / folder).rglob("*") if path.is_file()]
    size += sum(path.stat().st_size * (3 if path.suffix == ".py" else 1) for path in own if path.suffix != ".pyc")
    assert size < 120e6


def test_the_main_way_needs_no_more(light: Path, tmp_path: Path) -> None:
    made = run(light, "-m", "symgen", str(ROOT / "models/skate.yaml"), "--out", str(tmp_path))
    assert made.returncode == 0, made.stderr
    assert "notice: the report is left out: it needs sympy and typst, which are not installed: pip" in made.stderr
    recorded = (ROOT / "generated/skate" / CHECKSUMS).read_text(encoding="utf-8").splitlines()
    sources = [path for folder in ("c", "python") for path in sorted((tmp_path / "skate" / folder).iterdir())]
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.parent.name}/{path.name}" for path in sources]
    assert sums == [line for line in recorded if line.split()[1].startswith(("c/", "python/"))]
    assert not (tmp_path / "skate" / "report").exists()


@pytest.mark.campaign
def test_what_is_asked_for_says_what_it_needs(light: Path, tmp_path: Path) -> None:
    model = str(ROOT / "models/skate.yaml")
    for arguments, module in (
        ((model, "--only", "report"), "sympy"),
        (("simulate", model), "scipy"),
        (("explain", model), "sympy"),
    ):
        asked = run(light, "-m", "symgen", *arguments, "--out", str(tmp_path))
        assert asked.returncode == 2
        assert asked.stderr.splitlines()[-1].startswith("symgen: ")
        assert f"symgen[{EXTRA_OF[module]}" in asked.stderr.splitlines()[-1]
        assert "Traceback" not in asked.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.campaign
def test_python_compiles_without_more(light: Path) -> None:
    code = (
        "import symgen, sys; car = symgen.load(sys.argv[1]).compile(['inverse_dynamics']); "
        "print(car.inverse_dynamics([0, 0, 0], [1, 0, 0], [2, 0, 0]))"
    )
    made = run(light, "-c", code, str(ROOT / "models/skate.yaml"))
    assert made.returncode == 0, made.stderr


def test_every_package_beside_has_its_extra() -> None:
    extras = PROJECT["optional-dependencies"]
    for module, extra in EXTRA_OF.items():
        assert module in names(extras[extra])
    everything = {name for extra in set(EXTRA_OF.values()) for name in names(extras[extra])}
    assert everything == set(EXTRA_OF)
    # an extra of a command may bring what others bring, too; studies have a lock of their own
    assert set(extras["all"]) == {f"symgen[{extra}]" for extra in {*EXTRA_OF.values(), "identify"} - {"study"}}
    assert {*names(extras["identify"])} == {"matplotlib", "scipy", "typst"}
    # what has another way without it
    assert names(extras["semidefinite"]) == ["clarabel", "cvxpy-base"]
    assert to_install(("scipy",), "this").endswith("is not installed: pip install 'symgen[simulate]'")
