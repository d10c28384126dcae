"""Generated Python modules, as their user imports them."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

from shipped import ROOT


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
    return load_generated(ROOT / "generated" / name / "python" / f"{name}.py")
