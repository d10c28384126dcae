"""build/api: the reference of every public name of symgen, made from the docstrings by pdoc.

`python tools/api_reference.py build/api` writes all of it; with packages named behind the folder, those alone.
"""

from __future__ import annotations

import pkgutil
import re
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from unittest import mock

import pdoc
from markupsafe import Markup
from pdoc.render_helpers import to_html

import symgen

# What the extras `bench` and `study` bring is stood in for where it is missing: modules name it, and call nothing yet.
PEERS = (
    "jax", "jax.numpy", "jax.scipy", "jax.scipy.linalg", "symforce", "symforce.codegen", "symforce.symbolic",
    "symforce.values", "wrenfold", "zarr",
)  # fmt: skip
BESIDE_CODE = re.compile(r"(`[^`]*`)|<")


def packages() -> list[str]:
    """What lies in symgen, but for the module that runs the command line when it is imported."""
    return ["symgen", *(f"symgen.{part.name}" for part in pkgutil.iter_modules(symgen.__path__) if part.name[0] != "_")]


def shown(docstring: str) -> Markup:
    """A docstring as HTML: Markdown in which < stands for itself, as in OUT/<model>."""
    return Markup(to_html(BESIDE_CODE.sub(lambda match: match[1] or "&lt;", docstring)))


def write(folder: Path, names: Sequence[str]) -> None:
    """HTML of packages and all below them: a page a module, an index and a search, with nothing from elsewhere."""
    missing = [name for name in PEERS if find_spec(name.partition(".")[0]) is None]
    for name in symgen.__all__:
        vars(symgen)[name] = getattr(symgen, name)  # which is imported when first asked for
    pdoc.render.configure(docformat="markdown", show_source=False)
    pdoc.render.env.filters["to_html"] = shown
    with mock.patch.dict(sys.modules, {name: mock.MagicMock() for name in missing}):
        pdoc.pdoc(*names, output_directory=folder)


if __name__ == "__main__":
    write(Path(sys.argv[1]), sys.argv[2:] or packages())
