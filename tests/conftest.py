"""Fixtures shared by all tests."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable

import pytest
from hypothesis import settings

# The same examples in every run: what is new and random is drawn by `make zoo` and `make fuzz`.
settings.register_profile("same examples", derandomize=True)
settings.load_profile("same examples")


@pytest.fixture(scope="session")
def tool() -> Callable[[str], str]:
    """Finds a system tool; a missing one skips the test, or fails it where SYMGEN_REQUIRE_TOOLS is set (CI)."""

    def find(name: str) -> str:
        path = shutil.which(name)
        if path is None:
            message = f"{name} is not installed"
            if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
                pytest.fail(message)
            pytest.skip(message)
        return path

    return find
