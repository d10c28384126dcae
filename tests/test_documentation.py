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


PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]


def test_links_lead_to_files() -> None:
    dead = []
    for page in PAGES:
        text = re.sub(r"^```.*?^```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
            if not (page.parent / target).exists():
                dead.append(f"{page.relative_to(ROOT)}: {target}")
    assert dead == []


def test_pages_of_today_name_modules_that_exist() -> None:
    """Decisions and the log of changes may speak of what is gone."""
    today = [page for page in PAGES if page.parent.name != "decisions" and page.name != "CHANGELOG.md"]
    named = {path for page in today for path in re.findall(r"`((?:symgen|tests|tools)/[\w/.]+)`", page.read_text())}
    assert [path for path in sorted(named) if not (ROOT / path).exists()] == []


def test_the_index_lists_every_decision() -> None:
    decisions = sorted(path for path in (ROOT / "docs/decisions").glob("*.md") if path.name != "README.md")
    listed = re.findall(r"\]\((\d{4}-[^)]+)\)", (ROOT / "docs/decisions/README.md").read_text())
    assert listed == [path.name for path in decisions]
