"""Dask, xarray and Zarr (the extra `study`), or a reason to do without them: whoever imports this is skipped then."""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any

import pytest


def _needed(name: str) -> Any:
    """The module; without it the asking module is skipped, or fails where SYMGEN_REQUIRE_TOOLS is set (CI)."""
    try:
        return import_module(name)
    except ModuleNotFoundError:
        message = f"{name} (pip install symgen[study]) is not installed"
        if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
            pytest.fail(message, pytrace=False)
        pytest.skip(message, allow_module_level=True)


dask, distributed, xarray, zarr = map(_needed, ("dask", "distributed", "xarray", "zarr"))
