"""A motion as one self-contained HTML page: drawn on a canvas, played in real time, turned with the mouse."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from html import escape
from typing import TypeAlias

from symgen.backends.render import render
from symgen.drawing.pose import Place
from symgen.drawing.scene import IN_WORLD, Scene

# Lengths up to which a machine is a point.
SMALLEST_RADIUS = 1e-6
# Times the machine at the start, beyond which the view follows it.
FAR = 6

Box: TypeAlias = tuple[Place, Place]


@dataclass(frozen=True, slots=True)
class AnimationView:
    """What the template prints, escaped; `data` is JSON that cannot end its script element."""

    title: str
    caption: str
    last: int
    data: str


def animation(title: str, times: tuple[float, ...], shown: Scene, planned: Scene | None = None) -> str:
    """The page: a machine that stays in a plane is looked at straight on, others may be turned.

    Of a motion that follows a `planned` one the planned ways of what has a name and moves are drawn as lines.
    """
    room = max((hoop.radius for hoop in shown.hoops), default=0.0)
    boxes = [
        _box((*places, *_of_links(shown, places, axes)), room)
        for places, axes in zip(shown.places, shown.axes, strict=True)
    ]
    whole = _box([corner for box in boxes for corner in box], 0)
    centres, radius = _view(boxes, whole)
    data = asdict(shown) | {
        "times": [round(time, 6) for time in times],
        "places": [[[round(x, 5) for x in place] for place in moment] for moment in shown.places],
        "axes": [[[round(x, 4) for x in rows] for rows in moment] for moment in shown.axes],
        "centres": [[round(x, 5) for x in centre] for centre in centres],
        "radius": radius,
        "base": _has_base(shown),
        "frames": len(shown.names) - shown.points,
        "trails": [] if planned is None else _trails(planned),
    }
    view = AnimationView(
        title=escape(title),
        caption=_caption(shown, planned is not None),
        last=len(times) - 1,
        data=json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"),
    )
    return render("simulate/animation.html.jinja", view)


def _of_links(
    shown: Scene, places: Sequence[Place], axes: Sequence[tuple[float, ...]]
) -> Iterator[Place]:
    """The places of links at a moment, and the origin of the world where a base stands on it."""
    if _has_base(shown):
        yield 0.0, 0.0, 0.0
    for link in shown.links:
        if link.frame == IN_WORLD:
            yield from link.places
            continue
        rows, (x, y, z) = axes[shown.turned.index(link.frame)], places[link.frame]
        for place in link.places:
            across, up, along = (sum(a * b for a, b in zip(rows[k : k + 3], place, strict=True)) for k in (0, 3, 6))
            yield x + across, y + up, z + along


def _has_base(shown: Scene) -> bool:
    """Whether a machine in space stands on one place, to which a base leads from the origin of the world."""
    stands = [len(link.places) for link in shown.links if link.frame == IN_WORLD and link.shown]
    return not shown.stand.planar and stands == [1]


def _box(places: Sequence[Place], room: float) -> Box:
    """The lower and the upper corner around some places."""
    lower = tuple(min(place[k] for place in places) - room for k in range(3))
    upper = tuple(max(place[k] for place in places) + room for k in range(3))
    return (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2])


def _view(boxes: Sequence[Box], whole: Box) -> tuple[list[Place], float]:
    """The place in the middle of the picture at each moment, and half its width.

    All of the motion, unless the machine would be a dot in it: a machine that goes far is followed, of one that falls
    apart the beginning is shown.
    """
    middles = [(_middle(box), math.dist(*box) / 2) for box in boxes]
    (middle, start), largest = middles[0], max(size for _, size in middles)
    radius = max(SMALLEST_RADIUS, math.dist(*whole) / 2)
    if radius <= FAR * start or start < SMALLEST_RADIUS:
        return [_middle(whole)] * len(boxes), radius
    if largest <= FAR / 2 * start:
        return [place for place, _ in middles], largest * FAR / 2
    return [middle] * len(boxes), start * FAR / 2


def _middle(box: Box) -> Place:
    (a, b, c), (d, e, f) = box
    return (a + d) / 2, (b + e) / 2, (c + f) / 2


def _trails(planned: Scene) -> list[list[list[float]]]:
    """The ways of the last points of chains: of places that nothing else hangs on."""
    carrying = {start for start, _ in planned.chains}
    ends = [k for k in range(len(planned.names)) if k not in carrying]
    ways = [[[round(x, 5) for x in moment[k]] for moment in planned.places] for k in ends]
    return [way for way in ways if any(place != way[0] for place in way)]


def _caption(shown: Scene, planned: bool) -> str:
    """What the lines and colours are."""
    parts = ["Links as the URDF shows them, or else as bars and plates" if shown.solids else "Links as bars and plates"]
    if any(joint.driven for joint in shown.joints):
        parts.append("driven joints filled")
    if shown.balls:
        parts.append("balls at the centres of mass, as large as their masses")
    parts.append("axes of frames x red, y green, z blue")
    if shown.hoops:
        parts.append("wheels, and the plane z = 0")
    if planned:
        parts.append("planned ways green")
    turning = "The" if shown.stand.planar else "Drag turns, the"
    return f"{'; '.join(parts)}. {turning} wheel of the mouse zooms."
