"""Where links, joints and frames of a model are, each relative to another by name."""

from __future__ import annotations

from dataclasses import dataclass

from symgen.diagnostics import Span
from symgen.model.expressions.names import did_you_mean
from symgen.model.mechanism import WORLD
from symgen.model.robots.places import AxesPlace
from symgen.model.robots.reader import ElementReader

MODEL = "__model__"


@dataclass(frozen=True, slots=True)
class Posed:
    """Something with a pose relative to something else; it moves with `attached`, a link with itself."""

    relative_to: str
    place: AxesPlace
    attached: str
    span: Span


class Poses:
    """All places of a model, which itself has a place in the world."""

    def __init__(self, reader: ElementReader, place: AxesPlace, known: dict[str, Posed], canonical: str) -> None:
        self._reader, self._known, self._canonical = reader, known, canonical
        self._places = {WORLD: AxesPlace(), MODEL: place}
        self._in_circles: set[str] = set()

    def place(self, name: str, asked: Span) -> AxesPlace:
        """The place of a link, joint or frame in the world."""
        line: list[str] = []
        while name not in self._places and name not in line:
            line.append(name)
            posed = self._known.get(name)
            if posed is None:
                self._unknown(name, self._known[line[-2]].span if len(line) > 1 else asked)
                return AxesPlace()
            name = posed.relative_to or MODEL
        if name in line:
            self._circle([*line[line.index(name) :], name])
            return AxesPlace()
        for own in reversed(line):
            posed = self._known[own]
            self._places[own] = self._places[posed.relative_to or MODEL].then(posed.place)
        return self._places[line[0] if line else name]

    def link(self, name: str, asked: Span) -> str:
        """The link that a link, joint or frame moves with; the world moves with itself."""
        line: list[str] = []
        while name not in line:
            line.append(name)
            if name == WORLD:
                return name
            if name == MODEL or not name:
                name = self._canonical
                continue
            posed = self._known.get(name)
            if posed is None:
                self._unknown(name, asked)
                return ""
            if posed.attached == name:
                return name
            name = posed.attached
        self._circle([*line, name])
        return ""

    def _unknown(self, name: str, asked: Span) -> None:
        remedy = did_you_mean(name, self._known, "name a link, joint or frame of this model")
        self._reader.wrong(f"there is no link, joint or frame `{name}`", remedy, asked)

    def _circle(self, line: list[str]) -> None:
        if line[0] not in self._in_circles:
            self._in_circles.update(line)
            way = " -> ".join(f"`{name}`" for name in line)
            message = f"poses or frames hang on each other: {way}"
            self._reader.wrong(message, "give one of them relative to `__model__`", self._known[line[0]].span)
