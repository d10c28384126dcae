"""The reference imports the parsed model, the table of quantities, python-flint and the standard library."""

from __future__ import annotations

import ast
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
REFERENCE = ROOT / "symgen" / "verify" / "reference"
MODULES = sorted(REFERENCE.glob("*.py"))
ALLOWED = {
    "symgen.model.availability",
    "symgen.model.expressions.expression",
    "symgen.model.mechanism",
    "symgen.model.model",
    "symgen.model.quantities",
    "symgen.diagnostics",
    "flint",
}
CONTRACT = "The reference reads the parsed model and shares nothing with the derivation"


def imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            yield str(node.module)


def test_the_reference_imports_nothing_else() -> None:
    assert len(MODULES) > 5
    for path in MODULES:
        for name in imports(path):
            standard = name.split(".")[0] in sys.stdlib_module_names
            assert standard or name in ALLOWED or name.startswith("symgen.verify.reference."), f"{path.name}: {name}"


def test_the_contract_names_the_reference_and_every_other_package() -> None:
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (contract,) = [contract for contract in contracts if contract["name"] == CONTRACT]
    assert contract["source_modules"] == ["symgen.verify.reference"]
    packages = {f"symgen.{path.parent.name}" for path in (ROOT / "symgen").glob("*/__init__.py")}
    assert packages - {"symgen.verify"} <= set(contract["forbidden_modules"])


def test_the_contract_holds() -> None:
    tool = Path(sys.executable).with_name("lint-imports")
    run = subprocess.run(
        [tool, "--no-cache", "--no-logo"], cwd=ROOT, capture_output=True, text=True, check=False, timeout=120
    )
    assert f"{CONTRACT} KEPT" in run.stdout, run.stdout
