"""build/site: the documentation as a site, built by mkdocs from the pages as they lie in the repository.

    python tools/site_pages.py           gathers the pages under build/site/pages and builds build/site/html
    python tools/site_pages.py FOLDER    the same under another folder

Pages keep their places, so that links between them stay as they are; what they link to beside pages goes along.  The
page of the Python interface is made here, of the names that `symgen` has for its users, and the gallery gets the
equations and a motion of each machine.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path

from gallery_extras import add_extras

from symgen import _PLACES

ROOT = Path(__file__).resolve().parent.parent
CONFIG = "mkdocs.yml"
# Pages, and folders of pages with their pictures.
GATHERED = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs")
LINK = re.compile(r"\]\(([^)#\s:]+)(?:#[^)\s]*)?\)")
TO_INSTALL = "the site needs mkdocs: make site installs it"


def gather(root: Path, pages: Path) -> None:
    """Copies all pages, and what they link to."""
    shutil.rmtree(pages, ignore_errors=True)
    pages.mkdir(parents=True)
    for name in GATHERED:
        if (root / name).is_dir():
            shutil.copytree(root / name, pages / name, ignore=shutil.ignore_patterns("*.lock"))
        else:
            shutil.copy(root / name, pages / name)
    for target in sorted(linked(root, pages)):
        made = pages / target.relative_to(root)
        made.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(target, made)
    (pages / "api.md").write_text(interface(), encoding="utf-8")
    add_extras(pages, root / "models")


def linked(root: Path, pages: Path) -> Iterator[Path]:
    """Files of the repository that pages link to and that are no pages."""
    for page in pages.rglob("*.md"):
        for link in LINK.findall(page.read_text(encoding="utf-8")):
            target = (root / page.relative_to(pages).parent / link).resolve()
            if target.is_file() and target.is_relative_to(root) and not (pages / target.relative_to(root)).exists():
                yield target


def interface() -> str:
    """The page of the Python interface: a heading and a place for the docstrings of each name."""
    lines = ["# Python interface", "", "::: symgen", "    options:", "      members: false", ""]
    for name, (module, there) in sorted(_PLACES.items()):
        lines += [f"## symgen.{name}", "", f"::: symgen.{module}.{there}", ""]
    return "\n".join(lines)


def build(root: Path, folder: Path) -> int:
    """Gathers and builds; a link that leads nowhere is an error."""
    gather(root, folder / "pages")
    config = (root / CONFIG).read_text(encoding="utf-8")
    for kind, place in (("docs_dir", "pages"), ("site_dir", "html")):
        config = re.sub(rf"^{kind}: .*$", f"{kind}: {(folder / place).as_posix()}", config, flags=re.M)
    config = config.replace("paths: [.]", f"paths: [{root.as_posix()}]")
    (folder / CONFIG).write_text(config, encoding="utf-8")
    # quiet, it would count no warning
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--config-file", str(folder / CONFIG)]
    # which else praises another tool at each build
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    made = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=False)
    if made.returncode:
        print(made.stdout + made.stderr, file=sys.stderr)
    return made.returncode


def main(arguments: Sequence[str]) -> int:
    """The command line; see the top of this file."""
    if find_spec("mkdocs") is None:
        print(TO_INSTALL, file=sys.stderr)
        return 2
    return build(ROOT, Path(*arguments[:1]).resolve() if arguments else ROOT / "build/site")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
