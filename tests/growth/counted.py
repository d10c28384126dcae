"""Work counted in calls of Python functions, which no clock and no other process disturbs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType


class TooMuchWorkError(Exception):
    """More calls than were allowed."""


def calls(work: Callable[[], object], most: int) -> int:
    """How many Python functions are called; TooMuchWorkError beyond `most`, so that what explodes ends."""
    count = 0

    def count_call(_frame: FrameType, event: str, _argument: object) -> None:
        nonlocal count
        if event == "call":
            count += 1
            if count > most:
                raise TooMuchWorkError(f"more than {most} calls")

    before = sys.getprofile()
    sys.setprofile(count_call)
    try:
        work()
    finally:
        sys.setprofile(before)
    return count
