"""docs/architecture.md: the packages, what each is for and may import, and a picture of it, drawn from the code.

    python tools/architecture_page.py [--check]
"""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE, PICTURE = ROOT / "docs/architecture.md", ROOT / "docs/architecture.svg"
# Single modules that stand for themselves.
LEFT_OUT = {"", "__main__", "records", "diagnostics", "naming", "registered"}
WIDTH, HEIGHT, ROW, GAP, MARGIN = 128, 40, 84, 20, 24


def imports() -> dict[str, set[str]]:
    """Which packages, or modules of the top, each of them imports; imports for type checkers alone do not count."""
    needs: dict[str, set[str]] = defaultdict(set)
    for path in sorted((ROOT / "symgen").rglob("*.py")):
        own = _package(".".join(path.relative_to(ROOT).with_suffix("").parts))
        for node in _nodes(ast.parse(path.read_text(encoding="utf-8"))):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
            if names == ["symgen"]:
                names = [f"symgen.{alias.name}" for alias in node.names]
            needs[own] |= {_package(name) for name in names if name.startswith("symgen.")} - {own}
    return {name: {other for other in others if other in needs} for name, others in needs.items()}


def _package(module: str) -> str:
    """The package below symgen, or the module of the top; nothing for symgen itself."""
    name = module.split(".")[1] if "." in module else ""
    return "" if name == "__init__" else name


def _nodes(tree: ast.AST) -> list[ast.Import | ast.ImportFrom]:
    nodes: list[ast.Import | ast.ImportFrom] = []
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            continue
        if isinstance(node, ast.Import | ast.ImportFrom):
            nodes.append(node)
        nodes += _nodes(node)
    return nodes


def levels(needs: dict[str, set[str]]) -> dict[str, int]:
    """How high each package stands: one above the highest that it imports."""
    heights: dict[str, int] = {}

    def level(name: str) -> int:
        if name not in heights:
            heights[name] = 1 + max((level(other) for other in needs[name]), default=-1)
        return heights[name]

    for name in sorted(needs):
        level(name)
    return heights


def direct(needs: dict[str, set[str]]) -> dict[str, set[str]]:
    """The imports that do not follow from others."""

    def below(name: str) -> set[str]:
        return needs[name] | {far for other in needs[name] for far in below(other)}

    return {
        name: {other for other in others if not any(other in below(third) for third in others - {other})}
        for name, others in needs.items()
    }


def picture(needs: dict[str, set[str]]) -> str:
    """Packages in rows, what they import below them; attributes stand at each part, which every viewer knows."""
    height, lines_of = levels(needs), direct(needs)
    rows = [sorted(name for name in needs if height[name] == row) for row in range(max(height.values()) + 1)]
    across = max(map(len, rows)) * (WIDTH + GAP) - GAP + 2 * MARGIN
    down = len(rows) * ROW - (ROW - HEIGHT) + 2 * MARGIN
    place: dict[str, tuple[float, float]] = {}
    for row, names in reversed(list(enumerate(rows))):
        # below the middle of those that import it
        above = {name: [place[other][0] for other in place if name in lines_of[other]] for name in names}
        below = {name: sum(places) / len(places) if places else across for name, places in above.items()}
        names.sort(key=lambda name: (below[name], name))
        left = (across - len(names) * (WIDTH + GAP) + GAP) / 2
        for index, name in enumerate(names):
            place[name] = left + index * (WIDTH + GAP), down - MARGIN - HEIGHT - row * ROW
    lines, boxes = [], []
    for name, others in sorted(lines_of.items()):
        x, y = place[name]
        for other in sorted(others):
            u, v = place[other]
            a, b, c, d = x + WIDTH / 2, y + HEIGHT, u + WIDTH / 2, v
            curve = f"M{a:g} {b:g}C{a:g} {b + 26:g} {c:g} {d - 26:g} {c:g} {d:g}"
            lines.append(f'<path d="{curve}" fill="none" stroke="#9fb0c2" stroke-width="1.2"/>')
        files = len(list((ROOT / "symgen" / name).rglob("*.py"))) or 1
        count = f"{files} file{'s' if files > 1 else ''}"
        middle = f'x="{x + WIDTH / 2:g}" text-anchor="middle" font-family="sans-serif"'
        boxes.append(
            f'<rect x="{x:g}" y="{y:g}" width="{WIDTH}" height="{HEIGHT}" rx="5" fill="#eef3f8" stroke="#7b8ea3"/>'
            f'<text {middle} y="{y + 17:g}" font-size="13" fill="#1d2733">{name}</text>'
            f'<text {middle} y="{y + 32:g}" font-size="10" fill="#5b6b7b">{count}</text>'
        )
    size = f'viewBox="0 0 {across:g} {down:g}" width="{across:g}" height="{down:g}"'
    ground = '<rect width="100%" height="100%" fill="white"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n' + "\n".join((ground, *lines, *boxes)) + "\n</svg>\n"


def page(needs: dict[str, set[str]]) -> str:
    """The table of packages, the highest first."""
    height = levels(needs)
    rows = []
    for name in sorted(needs, key=lambda name: (-height[name], name)):
        path = ROOT / "symgen" / name / "__init__.py"
        below = ", ".join(sorted(direct(needs)[name])) or "nothing"
        rows.append(f"| `{name}` | {_meaning(path if path.exists() else path.parent.with_suffix('.py'))} | {below} |\n")
    return TOP + "".join(rows) + INSIDE + "".join(_folders()) + BOTTOM


def _folders() -> list[str]:
    """A row for each folder inside a package."""
    paths = sorted((ROOT / "symgen").glob("*/**/__init__.py"))
    inside = [(path.parent.relative_to(ROOT / "symgen").as_posix(), path) for path in paths]
    return [f"| `{place}` | {_meaning(path)} |\n" for place, path in inside if "/" in place]


def _meaning(path: Path) -> str:
    """The first paragraph of a module."""
    documented = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return documented.split("\n\n")[0].replace("\n", " ")


TOP = """# Architecture

Written by `tools/architecture_page.py` from the code.

A model file becomes a *model* (frozen data, every name known, every mistake told with its place); the model a *system*
on a graph of scalars; each *quantity* takes the *method* that is valid and counts least; its scalars become a
straight-line *kernel*, which C, Python and an interpreter print or run with the same bits. Verification and report read
what was made, and never steer it: what verification rejects is taken up by `generation`, which tries the next method.
`symgen/pipeline.py` is that way on one page.

An import points downwards only (`lint-imports`, part of `make test`). The reference in `symgen/verify/reference` shares
nothing with the derivation but the parsed model; the zoo knows the command line only.

![Packages, and what they import](architecture.svg)

*Lines that follow from others are left out; `diagnostics`, `records`, `naming` and `registered` stand below all.*

| package | what it is for | imports, beside what these import |
|---|---|---|
"""
INSIDE = """
Folders inside packages, each of one idea:

| folder | what it is for |
|---|---|
"""

BOTTOM = """
## How to add a backend

A backend prints finished kernels in one language, as `--only` names it. It is one folder `symgen/backends/<name>`, with
its templates in `templates/<name>`, and its name in `symgen/registered.py`. The folder has three modules:

- `reserved`: `WORDS`, which are the keywords of the language, refused as names in model files; what else is taken
  there, so that identifiers get an ending; names and endings that a model's files must not have. This is data.
- `statements`: how the language spells an operation, a choice, a sine and cosine, a check. The walk over the statements
  is that of `symgen/backends/statements.py`.
- `backend`: `BACKEND`, which are the functions that make files of a program (its *variants*, such as kernels for many
  states), what these files are called, for which scalar types they are made, what stands once around all of them, and
  the backend whose files verification runs for it.

Names of values come from `symgen/backends/locals.py`, numbers from `literals.py`, what is said of a model and of its
kernels from `about.py` and `quantities.py` there. `tests/backends/test_registered.py` holds every registered backend
against this.

How to add a quantity, a joint, a method or a pass is in [CONTRIBUTING.md](../CONTRIBUTING.md); what is computed in
[theory.md](theory.md).
"""


def main(check: bool) -> int:
    """Writes page and picture, or says whether they are current."""
    needs = {name: others - LEFT_OUT for name, others in imports().items() if name not in LEFT_OUT}
    made = {PAGE: page(needs), PICTURE: picture(needs)}
    stale = [path for path, text in made.items() if not path.exists() or path.read_text(encoding="utf-8") != text]
    if check:
        for path in stale:
            print(f"{path.relative_to(ROOT)}: run `python tools/architecture_page.py`")
        return int(bool(stale))
    for path, text in made.items():
        path.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv[1:]))
