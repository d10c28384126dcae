"""A motion as one self-contained HTML page: drawn on a canvas, played in real time, turned with the mouse."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from html import escape

from symgen.emit.render import render
from symgen.simulate.scene import Scene

SMALLEST_RADIUS = 1e-6


@dataclass(frozen=True, slots=True)
class AnimationView:
    """What the template prints, escaped; `data` is JSON that cannot end its script element."""

    title: str
    caption: str
    last: int
    data: str


def animation(title: str, times: tuple[float, ...], shown: Scene) -> str:
    """The page; a scene that stays in one plane z = constant is drawn in that plane."""
    room = max((hoop.radius for hoop in shown.hoops), default=0.0)
    every = [place for moment in shown.places for place in moment]
    lower = [min(place[k] for place in every) - room for k in range(3)]
    upper = [max(place[k] for place in every) + room for k in range(3)]
    centre = [(a + b) / 2 for a, b in zip(lower, upper, strict=True)]
    radius = max(SMALLEST_RADIUS, math.dist(lower, upper) / 2)
    data = asdict(shown) | {
        "times": [round(time, 6) for time in times],
        "places": [[[round(x, 5) for x in place] for place in moment] for moment in shown.places],
        "axes": [[[round(x, 4) for x in rows] for rows in moment] for moment in shown.axes],
        "planar": upper[2] - lower[2] < SMALLEST_RADIUS,
        "centre": centre,
        "radius": radius,
    }
    view = AnimationView(
        title=escape(title),
        caption=_caption(shown),
        last=len(times) - 1,
        data=json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"),
    )
    return render("simulate/animation.html.jinja", view)


def _caption(shown: Scene) -> str:
    """What the lines and colours are."""
    parts = ["Frames and points joined to the frame they hang on", "axes x red, y green, z blue"]
    if shown.balls:
        parts.append("grey balls at the centres of mass, as large as their masses")
    if shown.ties:
        parts.append("rods, springs and cables dashed")
    if shown.hoops:
        parts.append("wheels on the plane z = 0")
    return "; ".join(parts) + ". Drag turns, the wheel of the mouse zooms."
