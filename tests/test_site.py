"""`make site` makes a site of all pages, in which every link leads somewhere and nothing comes from elsewhere."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path

import pytest
import site_pages

import symgen

ROOT = Path(__file__).parent.parent
# Of a small site: the settings of the project's own, one page beside those that are made.
NAVIGATION = "nav:\n  - Home: README.md\n  - One: docs/one.md\n  - Reference: api.md\n"


@pytest.fixture
def mkdocs() -> None:
    """Skips without it, or fails where SYMGEN_REQUIRE_TOOLS is set (CI)."""
    if find_spec("mkdocs") is None:
        if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
            pytest.fail("mkdocs is not installed")
        pytest.skip("mkdocs is not installed: make site installs it")


class Loaded(HTMLParser):
    """What a page loads, and what it links to."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: set[str] = set()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.sources |= {given["src"] or ""} if "src" in given else set()
        if tag == "link" and given.get("rel") == "stylesheet":
            self.sources.add(given["href"] or "")


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.usefixtures("mkdocs")
def test_all_pages_become_a_site_that_loads_nothing_from_elsewhere(tmp_path: Path) -> None:
    made = subprocess.run(
        [sys.executable, "tools/site_pages.py", str(tmp_path)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (made.returncode, made.stdout, made.stderr) == (0, "", "")
    html = tmp_path / "html"
    pages = [path.relative_to(ROOT / "docs").with_suffix(".html") for path in (ROOT / "docs").rglob("*.md")]
    assert len(pages) > 80
    for page in pages:
        there = html / "docs" / (page.with_name("index.html") if page.stem == "README" else page)
        assert there.is_file(), page
        loaded = Loaded()
        loaded.feed(there.read_text(encoding="utf-8"))
        assert loaded.sources
        assert not [source for source in loaded.sources if re.match(r"\w+:|//", source)], page
    reference = (html / "api.html").read_text(encoding="utf-8")
    for name in set(symgen.__all__) - {"__version__"}:
        assert f'id="symgen{name.lower()}"' in reference, name
    assert "begins one" in reference
    assert (html / "models/delta.yaml").read_bytes() == (ROOT / "models/delta.yaml").read_bytes()
    assert not list(html.rglob("*.lock"))


def small(folder: Path, text: str) -> Path:
    """The root of a project with one page of its own."""
    (folder / "docs").mkdir(parents=True)
    for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md"):
        (folder / name).write_text(f"# {name}\n")
    (folder / "docs/one.md").write_text(text)
    (folder / "docs/site.css").write_text("")
    settings = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("# Reached from their index")[0]
    (folder / "mkdocs.yml").write_text(f"{settings}not_in_nav: |\n  C*.md\n{NAVIGATION}")
    (folder / "symgen").symlink_to(ROOT / "symgen")
    return folder


@pytest.mark.campaign
@pytest.mark.toolchain
@pytest.mark.slow
@pytest.mark.usefixtures("mkdocs")
def test_links_that_lead_nowhere_fail(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    good, lost = ("two.yaml", "../README.md", "#one"), ("missing.md", "../missing.yaml", "#missing")
    root = small(tmp_path / "project", "# One\n\n" + " ".join(f"[to]({link})" for link in (*good, *lost)))
    (root / "docs/two.yaml").write_text("model: two\n")
    assert site_pages.build(root, tmp_path / "site") == 1
    warnings = [line for line in capfd.readouterr().err.splitlines() if line.startswith("WARNING")]
    assert len(warnings) == len(lost)
    assert all(any(f"'{link}'" in warning for warning in warnings) for link in lost)


def test_what_pages_link_to_goes_along(tmp_path: Path) -> None:
    root = small(tmp_path / "project", "[model](../models/a.yaml), [itself](one.md), [other](https://example.org/a.yaml)\n")
    (root / "models").mkdir()
    (root / "models/a.yaml").write_text("model: a\n")
    (root / "models/b.yaml").write_text("model: b\n")
    pages = tmp_path / "pages"
    site_pages.gather(root, pages)
    assert {path.relative_to(pages).as_posix() for path in pages.rglob("*") if path.is_file()} == {
        "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "api.md", "docs/one.md", "docs/site.css", "models/a.yaml",
    }  # fmt: skip
