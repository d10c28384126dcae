"""A motion as one self-contained HTML page: drawn on a canvas, played in real time, turned with the mouse."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
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
    every = [place for frame in shown.places for place in frame]
    lower = [min(place[k] for place in every) for k in range(3)]
    upper = [max(place[k] for place in every) for k in range(3)]
    centre = [(a + b) / 2 for a, b in zip(lower, upper, strict=True)]
    radius = max(SMALLEST_RADIUS, math.dist(lower, upper) / 2)
    data = {
        "names": shown.names,
        "lines": shown.lines,
        "times": [round(time, 6) for time in times],
        "places": [[[round(x, 5) for x in place] for place in frame] for frame in shown.places],
        "planar": upper[2] - lower[2] < SMALLEST_RADIUS,
        "centre": centre,
        "radius": radius,
    }
    view = AnimationView(
        title=escape(title),
        caption="Origins of frames and points, joined to the frame they hang on; the ring is the world's origin.",
        last=len(times) - 1,
        data=json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"),
    )
    return render("simulate/animation.html.jinja", view)
