"""One run of a campaign: what is run, what goes in, what is kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class Member:
    """One run of a campaign: commands one after the other, the files that go in, and what is kept of the result.

    A command that begins with `python` is run by this interpreter, so that hashes do not depend on where it is.
    `checksums` are files of checksums of a model's generated files that go in, all but its report.
    """

    campaign: str
    name: str
    commands: tuple[tuple[str, ...], ...]
    files: tuple[str, ...]
    tools: tuple[str, ...] = ()
    result: Callable[[Path], Any] = lambda _: "passed"
    alone: bool = False
    environment: tuple[tuple[str, str], ...] = ()
    checksums: tuple[str, ...] = ()
