"""Why nothing can be identified."""

from __future__ import annotations


class NotIdentifiedError(Exception):
    """Nothing can be identified; the text says why and what to do, `place` where in the log, if it is there."""

    def __init__(self, reason: str, place: str = "") -> None:
        super().__init__(reason)
        self.place = place
