"""What stands behind a word of the command line: its options, and what it does with them."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Command:
    """`run` takes what `parser` makes of the words behind the command, and returns the exit code."""

    parser: Callable[[], argparse.ArgumentParser]
    run: Callable[[argparse.Namespace], int]

    def __call__(self, arguments: list[str]) -> int:
        """Does what the arguments ask for."""
        return self.run(self.parser().parse_args(arguments))
