"""Where names stand in a picture: beside their place, clear of bars, joints and each other.

Each name is tried in directions around its place, near it and farther away; it takes the one where it covers least, and
of those that cover as little the one that is turned least from where it would stand alone.  All is in pixels, y
downwards.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from symgen.drawing.view import Flat

Anchor: TypeAlias = str
"""`start`, `middle` or `end`: which part of a name stands at its place."""
# Beyond this share of a direction names stand beside their place, not above or below.
ASLANT = 0.4
# How far above its baseline a name reaches, and below it, of the height of its letters.
ASCENT, DESCENT = 0.72, 0.3
# Directions that are tried, and how many times as far as a name would like to stand.
DIRECTIONS, DISTANCES = 16, (1.0, 1.35, 1.9)
# Pixels of a covered line that a turn by half a circle is worth, and standing twice as far away.
TURNED, FARTHER = 9.0, 12.0
# Pixels that names keep clear of each other and of what is drawn.
NAME_CLEARANCE = 1.5
# How much worse it is to cover a name than a line.
UNREADABLE = 10.0
# What a name beyond the upper or lower edge is worth, in pixels of a covered line.
BEYOND_EDGE = 1e3


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle by its edges."""

    left: float
    top: float
    right: float
    bottom: float

    def grown(self, by: float) -> Box:
        """The same with its edges moved out."""
        return Box(self.left - by, self.top - by, self.right + by, self.bottom + by)

    def common(self, other: Box) -> float:
        """The area that two have in common."""
        wide = min(self.right, other.right) - max(self.left, other.left)
        high = min(self.bottom, other.bottom) - max(self.top, other.top)
        return wide * high if wide > 0 and high > 0 else 0.0

    def covers(self, start: Flat, end: Flat) -> float:
        """The length of a line between two places that lies inside (clipped as by Liang and Barsky, 1984)."""
        (x, y), (u, v) = start, end
        first, last = 0.0, 1.0
        for step, below, above in ((u - x, self.left - x, self.right - x), (v - y, self.top - y, self.bottom - y)):
            if step == 0:
                if below > 0 or above < 0:
                    return 0.0
                continue
            entry, leaving = sorted((below / step, above / step))
            first, last = max(first, entry), min(last, leaving)
        return max(0.0, last - first) * math.dist(start, end)


@dataclass(frozen=True, slots=True)
class Bar:
    """A drawn line: its ends, and half of its width."""

    start: Flat
    end: Flat
    half: float


@dataclass(frozen=True, slots=True)
class Wanted:
    """A name that is to stand at a place: how wide and high it is, and the direction and distances it would like.

    `beside` is the distance where it stands to the left or right of its place, `above` where above or below.
    """

    place: Flat
    away: Flat
    width: float
    size: float
    beside: float
    above: float


@dataclass(frozen=True, slots=True)
class Standing:
    """Where a name stands: its anchor on the baseline, and the rectangle that it takes."""

    x: float
    y: float
    anchor: Anchor
    box: Box


def placed(wanted: Sequence[Wanted], bars: Sequence[Bar], marks: Sequence[Box], height: float) -> list[Standing]:
    """Where names stand in a picture of this height, those first that come first."""
    taken: list[Standing] = []
    for name in wanted:
        names = [one.box for one in taken]
        tried = list(_candidates(name))
        costs = [cost + _covered(one.box, bars, marks, names, height) for one, cost in tried]
        taken.append(tried[costs.index(min(costs))][0])
    return taken


def _candidates(name: Wanted) -> Iterator[tuple[Standing, float]]:
    """Where a name might stand, and what that costs; the direction that it would like first, then beside that."""
    for distance in DISTANCES:
        for step in range(DIRECTIONS):
            turn = (step + 1) // 2 * (1 if step % 2 else -1)
            angle = 2 * math.pi * turn / DIRECTIONS
            c, s = math.cos(angle), math.sin(angle)
            away = c * name.away[0] - s * name.away[1], s * name.away[0] + c * name.away[1]
            cost = TURNED * abs(angle) / math.pi + FARTHER * (distance - 1)
            yield _standing(name, away, distance), cost


def _standing(name: Wanted, away: Flat, distance: float) -> Standing:
    """A name in that direction (y upwards) of its place."""
    right, up = away
    aside = abs(right) > ASLANT
    anchor = "middle" if not aside else "start" if right > 0 else "end"
    x = name.place[0] + distance * (name.beside if aside else name.above) * right
    # letters rise above their baseline, so that it is lower than the place
    y = name.place[1] - distance * name.above * up + (ASCENT - DESCENT) / 2 * name.size
    left = x - {"start": 0.0, "middle": name.width / 2, "end": name.width}[anchor]
    return Standing(x, y, anchor, Box(left, y - ASCENT * name.size, left + name.width, y + DESCENT * name.size))


def _covered(
    box: Box, bars: Sequence[Bar], marks: Sequence[Box], names: Sequence[Box], height: float
) -> float:
    """Lengths of lines, marks and names under a name, and edges that it crosses."""
    lines = sum(box.grown(bar.half + NAME_CLEARANCE).covers(bar.start, bar.end) for bar in bars)
    clear = box.grown(NAME_CLEARANCE)
    # an area as the length of a line that is as high as the name
    areas = sum(map(clear.common, marks)) + UNREADABLE * sum(map(clear.common, names))
    edges = 0.0 if box.top >= 0 and box.bottom <= height else BEYOND_EDGE
    return lines + areas / (box.bottom - box.top) + edges
