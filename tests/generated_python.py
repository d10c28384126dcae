"""Generated Python modules, as their user imports them."""

from __future__ import annotations

import importlib.util
import sys
import tempfile
from functools import cache
from pathlib import Path
from types import ModuleType

import shipped


def load_generated(path: Path) -> ModuleType:
    """The module in a file, registered under a name of its own, which dataclasses and pickles look for."""
    own = f"generated_{path.stem}"
    spec = importlib.util.spec_from_file_location(own, path)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[own] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def generated_python(name: str) -> ModuleType:
    """The module of a shipped model."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.py"
        path.write_text(str(shipped.made(name, "python").files[f"python/{name}.py"]), encoding="utf-8")
        return load_generated(path)
