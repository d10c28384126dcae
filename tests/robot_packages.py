"""Pinocchio, its robot descriptions and MuJoCo (the extra `robots`), or a reason to do without them."""

from __future__ import annotations

import os
from importlib import import_module, metadata
from pathlib import Path
from typing import Any, NoReturn

import pytest


def pinocchio() -> Any:
    """The module; without it the asking module is skipped, or fails where SYMGEN_REQUIRE_TOOLS is set (CI)."""
    try:
        return import_module("pinocchio")
    except ModuleNotFoundError:
        _absent("Pinocchio")


def mujoco() -> Any:
    """The module of that name, under the same terms."""
    try:
        return import_module("mujoco")
    except ModuleNotFoundError:
        _absent("MuJoCo")


def robot_description(name: str) -> Path:
    """A URDF of the package example-robot-data, by its file name."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        _absent("example-robot-data")
    return Path(str(next(file.locate() for file in files if file.name == name)))


def _absent(what: str) -> NoReturn:
    message = f"{what} (pip install symgen[robots]) is not installed"
    if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
        pytest.fail(message)
    pytest.skip(message, allow_module_level=True)
