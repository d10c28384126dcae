"""The Python modules in generated/, as their user imports them."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from typing import Any

from shipped import ROOT


@cache
def generated_python(name: str) -> Any:
    """The shipped module of a model, under a name of its own."""
    own = f"generated_{name}"
    spec = importlib.util.spec_from_file_location(own, ROOT / "generated" / name / "python" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    sys.modules[own] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
