"""One class, one name: whoever reads a name in one module need not ask which of two classes it means there."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "symgen"


def classes(package: Path) -> dict[str, list[str]]:
    """Places of the classes of a package by name; a private class may not share a name with a public one either."""
    places = defaultdict(list)
    for path in sorted(package.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                places[node.name.lstrip("_")].append(f"{path.relative_to(package)}:{node.lineno} {node.name}")
    return places


def shared_names(package: Path) -> list[str]:
    return [", ".join(places) for places in classes(package).values() if len(places) > 1]


def test_no_two_classes_have_one_name() -> None:
    assert shared_names(PACKAGE) == []


def test_a_name_is_shared_across_modules_and_underscores(tmp_path: Path) -> None:
    (tmp_path / "gears.py").write_text("class Wheel: ...\nclass Shaft: ...\n", encoding="utf-8")
    (tmp_path / "belts.py").write_text("def drive() -> None:\n    class _Wheel: ...\n", encoding="utf-8")
    assert shared_names(tmp_path) == ["belts.py:2 _Wheel, gears.py:1 Wheel"]
