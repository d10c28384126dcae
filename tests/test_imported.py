"""What code is made of: imports are followed, but for those that stand outside or are for type checking."""

from __future__ import annotations

from pathlib import Path

import pytest
from imported import imported

FILES = {
    "shop/__init__.py": "",
    "shop/till.py": "import json\nfrom shop import scales\nfrom shop.bread.oven import Oven\n",
    "shop/scales.py": "def weigh():\n    from shop.weights import grams\n    return grams\n",
    "shop/weights.py": "grams = 1\n",
    "shop/bread/__init__.py": "from shop.bread import flour\n",
    "shop/bread/oven.py": "if TYPE_CHECKING:\n    from shop import windows\nOven = 1\n",
    "shop/bread/flour.py": "",
    "shop/windows.py": "",
    "tests/till/test_till.py": "import drawer\nimport coins\nfrom shop.till import Oven\n",
    "tests/till/drawer.py": "",
    "tests/coins.py": "import counted\n",
    "tools/counted.py": "",
}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_imports_are_followed_through_functions_and_packages(root: Path) -> None:
    till = ("shop/__init__.py", "shop/bread/__init__.py", "shop/bread/flour.py", "shop/bread/oven.py")
    assert imported(root, ["shop/till.py"]) == (*till, "shop/scales.py", "shop/till.py", "shop/weights.py")


def test_what_stands_outside_is_not_entered(root: Path) -> None:
    files = imported(root, ["shop/till.py"], ["shop/bread", "shop/scales.py"])
    assert files == ("shop/__init__.py", "shop/till.py")


def test_helpers_of_tests_lie_beside_them_or_above_or_among_the_tools(root: Path) -> None:
    files = imported(root, ["tests/till"], ["shop"])
    assert files == ("tests/coins.py", "tests/till/drawer.py", "tests/till/test_till.py", "tools/counted.py")


def test_a_new_import_is_seen(root: Path) -> None:
    before = imported(root, ["shop/scales.py"])
    (root / "shop/weights.py").write_text("from shop import windows\n")
    assert {*imported(root, ["shop/scales.py"])} - {*before} == {"shop/windows.py"}
