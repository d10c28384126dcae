"""Fixtures shared by all tests."""

from __future__ import annotations

import gc
import os
import shutil
import sys
import tomllib
from collections.abc import Callable, Generator
from functools import cache
from pathlib import Path

import pytest
from hypothesis import settings

from symgen.runtime import garbage

# The same examples in every run: what is new and random is drawn by `make zoo` and `make fuzz`.
settings.register_profile("same examples", derandomize=True)
settings.load_profile("same examples")

TESTS = Path(__file__).parent
# Blocks of memory that nobody may hold any more, 200 MB of them.
MUCH = 2_500_000
# Seconds of a processor that a test without the mark `slow` may take, some times what it takes: machines differ.
QUICK = 5.0


class _Kept:
    """How many blocks of memory the last look for cycles has left in use."""

    blocks = 0


def pytest_configure() -> None:
    """Without the collector of cycles, as commands run: looking for them all the time takes a third of the tests.

    A run that is through its trials looks once more through all that was kept before.  Here that is what all tests
    before hold as well, and took longer than what it is after; here only what is new is looked through.
    """
    gc.disable()
    garbage.let_go_of_all = garbage.let_go_and_keep


def pytest_collection_finish() -> None:
    """Nobody looks again through the modules."""
    gc.freeze()
    _Kept.blocks = sys.getallocatedblocks()


def pytest_runtest_teardown() -> None:
    """What tests leave behind goes once it is much; nobody looks again through what they cache."""
    if sys.getallocatedblocks() > _Kept.blocks + MUCH:
        gc.collect()
        gc.freeze()
        _Kept.blocks = sys.getallocatedblocks()


def pytest_addoption(parser: pytest.Parser) -> None:
    """What `make quick` asks for."""
    parser.addoption("--unit", action="store_true", help="the quick tests of packages on the way to C")


@cache
def unit_folders() -> frozenset[Path]:
    """The folders of tests named after the packages that the import contract has on the way from model to C."""
    settings = tomllib.loads((TESTS.parent / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    (way,) = (one for one in contracts if one["name"].startswith("The way from model to C"))
    return frozenset(TESTS / package.removeprefix("symgen.") for package in way["source_modules"])


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Other folders are not even imported."""
    if not config.getoption("--unit") or collection_path == TESTS:
        return None
    return None if unit_folders() & {collection_path, *collection_path.parents} else True


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Unit tests take milliseconds and no tools of the system."""
    if config.getoption("--unit"):
        others = [item for item in items if not _is_unit(item)]
        config.hook.pytest_deselected(items=others)
        items[:] = [item for item in items if item not in set(others)]


def _is_unit(item: pytest.Item) -> bool:
    marked = any(map(item.get_closest_marker, ("slow", "toolchain")))
    return not marked and "tool" not in getattr(item, "fixturenames", ())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, object, object]:
    """Among unit tests, one that takes seconds fails: it lacks its mark."""
    before = os.times()
    result = yield
    spent = sum(os.times()[:4]) - sum(before[:4])
    if item.config.getoption("--unit") and spent > QUICK:
        pytest.fail(f"took {spent:.1f} s of a processor: to be marked slow, or made quicker", pytrace=False)
    return result


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
