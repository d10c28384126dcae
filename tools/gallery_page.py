"""docs/gallery.md and the pictures in docs/gallery/: every shipped model with its drawing, sizes and operations.

`python tools/gallery_page.py` writes them; `--check` lists what differs and exits with 1.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from symgen.drawing.svg import drawing
from symgen.model.load import load_model
from symgen.model.model import Model

ROOT = Path(__file__).resolve().parent.parent
PAGE, FOLDER = "docs/gallery.md", "docs/gallery"
HEAD = """# Gallery

Written by `tools/gallery_page.py` from `models/` and `generated/`.

Machines are drawn where their start leads; driven joints are filled. A count of operations is that of
the kernel in `generated/`, a pair of sine and cosine being one and changes of sign not counted. On the site
(`make site`) each machine has the report with its equations here, and moves.

"""


def pages() -> dict[str, str]:
    """The text of every file by its path."""
    pictures, entries = dict[str, str](), []
    for path in sorted((ROOT / "models").glob("*.yaml")):
        model = load_model(path)
        picture = drawing(model)
        if picture is not None:
            pictures[f"{FOLDER}/{path.stem}.svg"] = picture + "\n"
        entries.append(_entry(path.stem, model, picture is not None))
    # machines with a picture first
    entries.sort(key=lambda entry: "![" not in entry)
    return {PAGE: HEAD + "\n".join(entries), **pictures}


def _entry(name: str, model: Model, drawn: bool) -> str:
    derivation = json.loads((ROOT / "generated" / name / "derivation.json").read_text(encoding="utf-8"))
    counts = [
        f"{symbol} {sum(derivation['kernels'][quantity]['operations'].values())}"
        for quantity, symbol in (("inverse_dynamics", "u"), ("forward_dynamics", "q̈"), ("multipliers", "λ"))
        if quantity in derivation["kernels"]
    ]
    sizes = f"{model.n} coordinates, {model.r} constraints, {model.m} inputs"
    operations = [f"operations: {', '.join(counts)}"] if counts else []
    lines = [f"## {name}", "", f"{model.description}.", "", "; ".join([sizes, *operations]) + ".", ""]
    lines += [f"[models/{name}.yaml](../models/{name}.yaml)", ""]
    if drawn:
        lines += [f"![{name}: the machine where its start leads](gallery/{name}.svg)", ""]
    return "\n".join(lines)


def main() -> int:
    """1 where a check finds a difference."""
    made = pages()
    known = {f"{FOLDER}/{path.name}" for path in (ROOT / FOLDER).glob("*")}
    if "--check" in sys.argv[1:]:
        differs = [path for path, text in made.items() if not _is_same(ROOT / path, text)]
        differs += sorted(known - set(made))
        print(*(f"{path}: run `python tools/gallery_page.py`" for path in differs), sep="\n", end="\n" * bool(differs))
        return int(bool(differs))
    (ROOT / FOLDER).mkdir(exist_ok=True)
    for path in known - set(made):
        (ROOT / path).unlink()
    for path, text in made.items():
        (ROOT / path).write_text(text, encoding="utf-8")
    return 0


def _is_same(path: Path, text: str) -> bool:
    return path.is_file() and path.read_text(encoding="utf-8") == text


if __name__ == "__main__":
    sys.exit(main())
