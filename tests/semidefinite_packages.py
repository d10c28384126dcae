"""CVXPY and Clarabel (the extra `semidefinite`), or a reason to do without them: whoever imports this is skipped."""

from __future__ import annotations

import os
from importlib.util import find_spec

import pytest

for name in ("cvxpy", "clarabel"):
    if find_spec(name) is None:
        message = f"{name} (pip install symgen[semidefinite]) is not installed"
        if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
            pytest.fail(message, pytrace=False)
        pytest.skip(message, allow_module_level=True)
