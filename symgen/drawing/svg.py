"""A sketch as SVG."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from html import escape

from symgen.drawing.pose import MachinePose
from symgen.drawing.sketch import MachineLabel, MachineSketch, Role, Symbol, sketch
from symgen.drawing.view import Flat
from symgen.mechanics.genericity import assembly_of
from symgen.model.model import Model
from symgen.naming import GREEK

# Pixels: the picture's width and greatest height, and room around the machine for symbols and names.
PICTURE_WIDTH, PICTURE_HEIGHT, BORDER = 460, 400, 54
# Pixels: half of a bar, the radius of a joint, the half sides of a slider, from a joint to its names
# above or below and beside it.
BAR, JOINT, SLIDER, APART, NEAR = 5.0, 6.0, (11.0, 7.0), 19.0, 12.0
# Beyond this share of a direction names stand beside their joint, not above or below.
ASLANT = 0.4
# A letter's width, of its height; pixels around names at the edge.
LETTER, EDGE = 0.5, 6.0
INK, LIGHT, DRIVEN, PALE = "#2b2f36", "#dfe5ee", "#d1432f", "#8a93a3"
# How strokes look: colour, width, filling, dashes.
LOOKS: dict[Role, tuple[str, float, str, str]] = {
    "link": (LIGHT, 2 * BAR, LIGHT, ""),
    "base": (PALE, 5.0, "none", ""),
    "tie": (INK, 3.0, "none", ""),
    "spring": (INK, 1.4, "none", ""),
    "cable": (INK, 1.2, "none", ""),
    "rail": (PALE, 2.0, "none", "5 3"),
    "wheel": (INK, 2.0, "#eef1f6", ""),
    "axis": (PALE, 1.2, "none", ""),
}


def drawing(model: Model) -> str | None:
    """The picture of a model's machine where its start leads; None for a model without frames, or without places."""
    if not model.mechanism.frames or not assembly_of(model).places:
        return None
    try:
        pose = MachinePose(model)
        joints = pose.joints
    except (ArithmeticError, ValueError):  # a slide at 0 may have no place
        return None
    places = [*pose.places.values(), *(joint.foot for joint in joints)]
    return _Paper(sketch(pose)).svg() if all(math.isfinite(x) for place in places for x in place) else None


class _Paper:
    """A sketch at the scale at which it fits."""

    def __init__(self, shown: MachineSketch) -> None:
        self._sketch = shown
        places = [place for stroke in shown.strokes for place in stroke.places]
        places += [symbol.place for symbol in shown.symbols]
        self._left, self._top = min(x for x, _ in places), max(y for _, y in places)
        wide, high = max(x for x, _ in places) - self._left, self._top - min(y for _, y in places)
        across, down = PICTURE_WIDTH - 2 * BORDER, PICTURE_HEIGHT - 2 * BORDER
        self._scale = min(across / (wide or 1.0), down / (high or 1.0))
        self._shift = (across - self._scale * wide) / 2
        self._height = round(self._scale * high + 2 * BORDER)

    def svg(self) -> str:
        """The text of the file, as wide as names beside the machine ask for."""
        labels = [*self._labels()]
        parts = [*self._strokes(), *map(self._symbol, self._sketch.symbols)]
        left = min([0.0, *(label.left - EDGE for label in labels)])
        width = max([float(PICTURE_WIDTH), *(label.left + label.wide + EDGE for label in labels)]) - left
        size = f'width="{width:.0f}" height="{self._height}" viewBox="{left:.0f} 0 {width:.0f} {self._height}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="Libertinus Serif, Georgia, serif">'
        return "\n".join([head, *parts, *(label.text for label in labels), "</svg>"])

    def _at(self, place: Flat) -> Flat:
        x = BORDER + self._shift + self._scale * (place[0] - self._left)
        return x, BORDER + self._scale * (self._top - place[1])

    def _path(self, places: Iterable[Flat], closed: bool) -> str:
        points = " L".join(f"{x:.1f} {y:.1f}" for x, y in map(self._at, places))
        return f"M{points}{' Z' if closed else ''}"

    def _strokes(self) -> Iterator[str]:
        for stroke in self._sketch.strokes:
            colour, width, fill, dashes = LOOKS[stroke.role]
            path = self._path(stroke.places, stroke.closed)
            look = 'stroke-linecap="round" stroke-linejoin="round"'
            filled = fill if stroke.closed else "none"
            if stroke.role == "link":
                # the outline is the same stroke, wider
                yield f'<path d="{path}" fill="{filled}" stroke="{INK}" stroke-width="{width + 2.4:g}" {look}/>'
            dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
            yield f'<path d="{path}" fill="{filled}" stroke="{colour}" stroke-width="{width:g}"{dashed} {look}/>'
        yield from self._axes()

    def _axes(self) -> Iterator[str]:
        """The names of the axes of the world at their tips."""
        for stroke in self._sketch.strokes:
            if stroke.name:
                (x, y), (u, v) = map(self._at, stroke.places)
                far = math.hypot(u - x, v - y)
                yield _text(u + 8 * (u - x) / far, v + 8 * (v - y) / far + 3, _name(stroke.name, PALE), 11)

    def _ground(self, x: float, y: float) -> str:
        if not self._sketch.planar:
            return f'<ellipse cx="{x:.1f}" cy="{y:.1f}" rx="12" ry="5" fill="{PALE}" fill-opacity="0.35"/>'
        base = y + 15
        ticks = " ".join(f"M{x + step:.1f} {base:.1f} l-5 5" for step in range(-8, 13, 5))
        return (
            f'<path d="M{x:.1f} {y:.1f} L{x - 9:.1f} {base:.1f} H{x + 9:.1f} Z" fill="white" stroke="{INK}"/>\n'
            f'<path d="M{x - 13:.1f} {base:.1f} H{x + 13:.1f} {ticks}" fill="none" stroke="{INK}"/>'
        )

    def _symbol(self, symbol: Symbol) -> str:
        x, y = self._at(symbol.place)
        circle = f'<circle cx="{x:.1f}" cy="{y:.1f}"'
        outlined = f'stroke="{INK}" stroke-width="1.5"'
        match symbol.mark:
            case "ground":
                return self._ground(x, y)
            case "slider" | "driven slider":
                angle = -math.degrees(math.atan2(symbol.along[1], symbol.along[0]))
                fill = DRIVEN if symbol.mark == "driven slider" else "white"
                wide, high = SLIDER
                box = f'x="{-wide:g}" y="{-high:g}" width="{2 * wide:g}" height="{2 * high:g}" rx="2"'
                place = f"translate({x:.1f} {y:.1f}) rotate({angle:.1f})"
                return f'<rect {box} transform="{place}" fill="{fill}" {outlined}/>'
            case "ball":
                return f'{circle} r="{JOINT + 1:g}" fill="{PALE}" {outlined}/>'
            case "pin":
                return f'{circle} r="{JOINT - 1.5:g}" fill="white" {outlined}/>'
            case "point":
                return f'{circle} r="2.6" fill="{INK}"/>'
            case "driven":
                return f'{circle} r="{JOINT:g}" fill="{DRIVEN}" {outlined}/>'
            case "joint":
                return f'{circle} r="{JOINT:g}" fill="white" {outlined}/>'

    def _labels(self) -> Iterator[_PlacedLabel]:
        for label in self._sketch.labels:
            x, y = self._at(label.place)
            right, up = label.away
            beside, size = abs(right) > ASLANT, 11 if label.point else 14
            anchor = "middle" if not beside else "start" if right > 0 else "end"
            # the picture's y goes down
            x, y = x + (NEAR if beside else APART) * right, y - APART * up + 4
            words = (label.point,) if label.point else (*label.coordinates, *label.inputs)
            wide = LETTER * size * len(", ".join(words))
            left = x - {"start": 0.0, "middle": wide / 2, "end": wide}[anchor]
            yield _PlacedLabel(left, wide, _text(x, y, _spelled(label), size, anchor))


@dataclass(frozen=True, slots=True)
class _PlacedLabel:
    """A label where it stands: its left end and about how wide it is, in pixels."""

    left: float
    wide: float
    text: str


def _spelled(label: MachineLabel) -> str:
    if label.point:
        return f'<tspan fill="{PALE}">{escape(label.point)}</tspan>'
    words = [_name(name, INK) for name in label.coordinates]
    words += [_name(name, DRIVEN) for name in label.inputs]
    return ", ".join(words)


def _name(name: str, colour: str) -> str:
    """A symbol in italics, what follows its first underscore lowered."""
    letter, _, index = name.partition("_")
    letter = GREEK.get(letter, letter)
    lowered = f'<tspan font-size="70%" dy="3">{escape(index)}</tspan><tspan dy="-3">&#8203;</tspan>' if index else ""
    return f'<tspan fill="{colour}" font-style="italic">{escape(letter)}{lowered}</tspan>'


def _text(x: float, y: float, content: str, size: int, anchor: str = "middle") -> str:
    # a white rim keeps names readable across links
    rim = 'paint-order="stroke" stroke="white" stroke-width="3" stroke-linejoin="round"'
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" {rim}>{content}</text>'
