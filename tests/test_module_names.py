"""Each module of the tests has a name of its own: they import each other by it, whatever folder they lie in."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

FOLDERS_OF_TOOLS = ("tests", "tools")


def shared_names(root: Path) -> set[str]:
    """Modules of the tests and the tools that two files would be imported as."""
    names = Counter(path.name for folder in FOLDERS_OF_TOOLS for path in (root / folder).rglob("*.py"))
    return {name for name, count in names.items() if count > 1}


def test_no_two_modules_of_the_tests_have_one_name() -> None:
    assert shared_names(Path(__file__).parents[1]) == set()


def test_a_name_is_shared_across_folders(tmp_path: Path) -> None:
    for place in ("tests/study", "tests/verify", "tools"):
        (tmp_path / place).mkdir(parents=True)
    for place in ("tests/study/test_modes.py", "tests/verify/test_modes.py", "tests/verify/pages.py", "tools/chart.py"):
        (tmp_path / place).touch()
    assert shared_names(tmp_path) == {"test_modes.py"}
    (tmp_path / "tools/pages.py").touch()
    assert shared_names(tmp_path) == {"test_modes.py", "pages.py"}
