"""README.md and docs/ say what symgen does now."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_marked_blocks_and_generated_pages_are_current() -> None:
    command = [sys.executable, "tools/fill_readme.py", "--check"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_architecture_is_that_of_the_code() -> None:
    command = [sys.executable, "tools/architecture_page.py", "--check"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_gallery_is_that_of_the_models() -> None:
    command = [sys.executable, "tools/gallery_page.py", "--check"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]


def test_links_lead_to_files() -> None:
    dead = []
    for page in PAGES:
        text = re.sub(r"^```.*?^```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
            if not (page.parent / target).exists():
                dead.append(f"{page.relative_to(ROOT)}: {target}")
    assert dead == []


# What is gone is struck out, ~~`like/this.py`~~.
GONE = re.compile(r"~~.*?~~", re.S)
PLACE = re.compile(r"`((?:symgen|tests|tools|templates)/[\w/.]+|(?:[A-Za-z_]\w*/)+[A-Za-z_]\w*(?:\.py)?)`")


def test_pages_name_modules_that_exist() -> None:
    """By their path in the project or in `symgen`, with or without the ending; the log of changes is of its time."""
    missing = []
    for page in PAGES:
        if page.name != "CHANGELOG.md":
            named = PLACE.findall(GONE.sub("", page.read_text(encoding="utf-8")))
            missing += [f"{page.relative_to(ROOT)}: {path}" for path in named if not _exists(path)]
    assert missing == []


def _exists(path: str) -> bool:
    return any((base / f"{path}{ending}").exists() for base in (ROOT, ROOT / "symgen") for ending in ("", ".py"))


def test_the_index_lists_every_decision() -> None:
    decisions = sorted((ROOT / "docs/decisions").glob("[0-9]*.md"))
    listed = re.findall(r"\]\((\d{4}-[^)]+)\)", (ROOT / "docs/decisions/README.md").read_text())
    assert listed == [path.name for path in decisions]
