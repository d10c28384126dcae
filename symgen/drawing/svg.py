"""A sketch as SVG."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from html import escape

from symgen.drawing.names import Bar, Box, Standing, Wanted, placed
from symgen.drawing.pose import MachinePose
from symgen.drawing.sketch import MachineLabel, MachineSketch, Mark, Role, Symbol, sketch
from symgen.drawing.view import Flat
from symgen.mechanics.genericity import assembly_of
from symgen.model.model import Model
from symgen.naming import GREEK

# Pixels: the picture's width and greatest height, and room around the machine for symbols and names.
PICTURE_WIDTH, PICTURE_HEIGHT, BORDER = 460, 400, 54
# Pixels: half of a bar, the radius of a joint, the half sides of a slider, from a joint to its names
# above or below and beside it.
BAR, JOINT, SLIDER, APART, NEAR = 5.0, 6.0, (11.0, 7.0), 19.0, 12.0
# Pixels: the heights of letters of coordinates and inputs, and of points and axes; from the tip of an axis to its name.
NAME_HEIGHT, NOTE_HEIGHT, TIP_GAP = 14, 11, 8.0
# A letter's width, of its height; how large lowered letters are; pixels around names at the edge.
LETTER, INDEX_SHARE, EDGE = 0.5, 0.7, 6.0
# Pixels that a mark takes to the left and right of its place, above and below it.
MARKED: dict[Mark, tuple[float, float, float]] = {
    "ground": (13, 0, 20),
    "slider": (11, 9, 9),
    "driven slider": (11, 9, 9),
    "ball": (JOINT + 1, JOINT + 1, JOINT + 1),
    "joint": (JOINT, JOINT, JOINT),
    "driven": (JOINT, JOINT, JOINT),
    "pin": (JOINT - 1.5, JOINT - 1.5, JOINT - 1.5),
    "point": (2.6, 2.6, 2.6),
}
# Half the length of the wall of a guide, and how far it is from the middle of its slider.
GUIDE = (17, 9)
# Of the ellipse that stands for the ground in space.
FOOT = (12, 5)
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
    "tyre": (INK, 9.0, "none", ""),
    "axis": (PALE, 1.2, "none", ""),
    "force": (DRIVEN, 1.8, DRIVEN, ""),
}


def drawing(model: Model) -> str | None:
    """The picture of a model's machine where its start leads; None without frames and points, or without places."""
    mechanism = model.pictured
    if not (mechanism.frames or mechanism.points) or not assembly_of(model).places:
        return None
    try:
        pose = MachinePose(model)
    except (ArithmeticError, ValueError):
        return None
    places = [*pose.places.values(), *(joint.foot for joint in pose.joints)]
    return Paper(sketch(pose)).svg() if all(math.isfinite(x) for place in places for x in place) else None


class Paper:
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
        standing = self.standing()
        parts = [*self._strokes(), *map(self._symbol, self._sketch.symbols)]
        texts = (look for _, look in self._words())
        parts += [_text(there, text, size) for there, (text, size) in zip(standing, texts, strict=True)]
        left = min([0.0, *(one.box.left - EDGE for one in standing)])
        width = max([float(PICTURE_WIDTH), *(one.box.right + EDGE for one in standing)]) - left
        size = f'width="{width:.0f}" height="{self._height}" viewBox="{left:.0f} 0 {width:.0f} {self._height}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="Libertinus Serif, Georgia, serif">'
        return "\n".join([head, *parts, "</svg>"])

    def standing(self) -> list[Standing]:
        """Where the names stand."""
        wanted = [name for name, _ in self._words()]
        return placed(wanted, [*self._bars()], [*self._marks()], self._height)

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
            if stroke.role == "force":
                yield self._head(*stroke.places)

    def _head(self, start: Flat, tip: Flat) -> str:
        """The head of an arrow."""
        (x, y), (u, v) = self._at(start), self._at(tip)
        angle = math.degrees(math.atan2(v - y, u - x))
        place = f"translate({u:.1f} {v:.1f}) rotate({angle:.1f})"
        return f'<path d="M2 0 L-8 -4 V4 Z" transform="{place}" fill="{DRIVEN}"/>'

    def _ground(self, x: float, y: float) -> str:
        if not self._sketch.planar:
            wide, high = FOOT
            size = f'rx="{wide}" ry="{high}"'
            return f'<ellipse cx="{x:.1f}" cy="{y:.1f}" {size} fill="{PALE}" fill-opacity="0.35"/>'
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
            case "guide":
                angle = -math.degrees(math.atan2(symbol.along[1], symbol.along[0]))
                return _guide(f"translate({x:.1f} {y:.1f}) rotate({angle:.1f})")
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

    def _bars(self) -> Iterator[Bar]:
        """All drawn lines, outlines of plates and wheels among them."""
        for stroke in self._sketch.strokes:
            places = [*map(self._at, stroke.places)]
            ends = [*places[1:], places[0]] if stroke.closed else places[1:]
            for start, end in zip(places, ends, strict=False):
                yield Bar(start, end, LOOKS[stroke.role][1] / 2)

    def _marks(self) -> Iterator[Box]:
        for symbol in self._sketch.symbols:
            x, y = self._at(symbol.place)
            if symbol.mark == "guide":
                yield _wall(x, y, symbol.along)
                continue
            aside, above, below = MARKED[symbol.mark]
            if symbol.mark == "ground" and not self._sketch.planar:
                aside, above, below = FOOT[0], FOOT[1], FOOT[1]
            yield Box(x - aside, y - above, x + aside, y + below)

    def _words(self) -> Iterator[tuple[Wanted, tuple[str, int]]]:
        """Names with what they look like and how high they are: coordinates and inputs, points, axes of the world."""
        for label in self._sketch.labels:
            size = NOTE_HEIGHT if label.point else NAME_HEIGHT
            names = (*label.coordinates, *label.inputs)
            wide = LETTER * size * (len(label.point) if label.point else sum(map(_letters, names)) + 2 * len(names) - 2)
            yield Wanted(self._at(label.place), label.away, wide, size, NEAR, APART), (_spelled(label), size)
        for stroke in self._sketch.strokes:
            if stroke.name:
                (x, y), (u, v) = map(self._at, stroke.places)
                far = math.hypot(u - x, v - y)
                away = (u - x) / far, -(v - y) / far
                wanted = Wanted((u, v), away, LETTER * NOTE_HEIGHT, NOTE_HEIGHT, TIP_GAP, TIP_GAP + 2)
                yield wanted, (_name(stroke.name, PALE), NOTE_HEIGHT)


def _guide(place: str) -> str:
    """A wall that the slider stands on."""
    wide, high = GUIDE
    ticks = " ".join(f"M{step} {high} l-5 5" for step in range(5 - wide, wide + 1, 6))
    return f'<path d="M{-wide} {high} H{wide} {ticks}" transform="{place}" fill="none" stroke="{INK}"/>'


def _wall(x: float, y: float, along: Flat) -> Box:
    """What the wall of a guide takes, with its ticks."""
    wide, high = GUIDE
    right, up = along
    corners = [(step, far) for step in (-wide, wide) for far in (high, high + 5)]
    ends = [(x + step * right + far * up, y - step * up + far * right) for step, far in corners]
    return Box(min(u for u, _ in ends), min(v for _, v in ends), max(u for u, _ in ends), max(v for _, v in ends))


def _spelled(label: MachineLabel) -> str:
    if label.point:
        return f'<tspan fill="{PALE}">{escape(label.point)}</tspan>'
    words = [_name(name, INK) for name in label.coordinates]
    words += [_name(name, DRIVEN) for name in label.inputs]
    return ", ".join(words)


def _letters(name: str) -> float:
    """How many letters of full size a symbol is as wide as."""
    letter, _, index = name.partition("_")
    return len(GREEK.get(letter, letter)) + INDEX_SHARE * len(index)


def _name(name: str, colour: str) -> str:
    """A symbol in italics, what follows its first underscore lowered."""
    letter, _, index = name.partition("_")
    letter = GREEK.get(letter, letter)
    lower, back = f'<tspan font-size="{INDEX_SHARE:.0%}" dy="3">', '<tspan dy="-3">&#8203;</tspan>'
    lowered = f"{lower}{escape(index)}</tspan>{back}" if index else ""
    return f'<tspan fill="{colour}" font-style="italic">{escape(letter)}{lowered}</tspan>'


def _text(there: Standing, content: str, size: int) -> str:
    # a white rim keeps names readable across links
    rim = 'paint-order="stroke" stroke="white" stroke-width="3" stroke-linejoin="round"'
    place = f'x="{there.x:.1f}" y="{there.y:.1f}" font-size="{size}" text-anchor="{there.anchor}"'
    return f"<text {place} {rim}>{content}</text>"
