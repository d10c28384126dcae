"""What links and joints of a robot description are called in the model: as the user says, else by their own names.

Characters that names cannot have become `_`: joint-1 is joint_1.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from symgen.diagnostics import Mistake, Notice, Span, printable
from symgen.model.expressions.names import MAXIMUM_NAME, did_you_mean, name_mistake
from symgen.model.file.reading import entries, member, text_of
from symgen.model.file.scope import Scope
from symgen.model.file.source import Node, ScalarNode
from symgen.model.mechanism import WORLD


@dataclass(frozen=True, slots=True)
class RobotNames:
    """Coordinates of joints (before their endings) and frames of links, by their names in the robot description."""

    coordinates: dict[str, str] = field(hash=False)
    frames: dict[str, str] = field(hash=False)


@dataclass(frozen=True, slots=True)
class NamedThings:
    """What a robot description of the format `form` has names for: joints that move, with the endings of their
    coordinates, and links, of which `root` may be the world."""

    form: str
    moving: dict[str, tuple[Span, tuple[str, ...]]] = field(hash=False)
    links: dict[str, Span] = field(hash=False)
    root: str


def read_names(scope: Scope, node: Node | None, things: NamedThings, key_span: Span) -> RobotNames:
    """The names; those that are none, or that two things share, are mistakes that say how to choose others."""
    moving = {name: span for name, (span, _) in things.moving.items()}
    coordinates = _chosen(scope, member(node, "coordinates"), moving, "moving joint")
    frames = _chosen(scope, member(node, "frames"), things.links, "link")
    taken: dict[str, str] = {}
    key = things.form.lower()
    for name, (span, endings) in things.moving.items():
        for ending in endings:
            of = (key, "coordinate", "coordinates", "joint", name)
            _enter(scope, taken, coordinates[name] + ending, span, of)
    for name, span in things.links.items():
        if not (name == things.root and frames[name] == WORLD):
            _enter(scope, taken, frames[name], span, (key, "frame", "frames", "link", name))
    pairs = (*coordinates.items(), *frames.items())
    changed = [f"{own} is {name}" for own, name in pairs if name == plain_name(own) != own]
    if changed:
        listed = ", ".join(changed)
        message = f"names of the {things.form} with characters that names of a model cannot have: {listed}"
        scope.notices.append(Notice(printable(message), key_span))
    return RobotNames(coordinates, frames)


def _chosen(scope: Scope, node: Node | None, known: dict[str, Span], what: str) -> dict[str, str]:
    """The name of each thing in the model: its own, or that of an entry `name in the model: own name`."""
    by_own_name = {name: plain_name(name) for name in known}
    named: set[str] = set()
    for key, value in entries(node):
        own = text_of(value)
        if own is None or own not in known:
            remedy = did_you_mean(own or "", known, f"name a {what} of the robot description")
            scope.wrong(f"there is no {what} `{own}` in the robot description", remedy, value.span)
            continue
        if own in named:
            scope.wrong(f"the {what} `{own}` is named twice", "keep one of the two", value.span)
        named.add(own)
        by_own_name[own] = key.value
    return by_own_name


def _enter(scope: Scope, taken: dict[str, str], name: str, span: Span, of: tuple[str, str, str, str, str]) -> None:
    key, what, block, owner, own = of
    mistake = name_mistake(ScalarNode(name, span, "", False), what)
    message = mistake.message if mistake is not None else ""
    if not message and name == WORLD:
        message = f"the link `{own}` is called as the frame at rest, and moves against the root"
    if not message and name in taken:
        message = f"the {owner} `{own}` has the name of a {taken[name]}"
    if message:
        better = _suggestion(own, taken)
        remedy = f"name it in the model file: `{key}: {{file: ..., {block}: {{{better}: {own}}}}}`"
        scope.mistakes.append(Mistake(message, remedy, span, own))
    taken.setdefault(name, owner)


def _suggestion(name: str, taken: Iterable[str]) -> str:
    made = plain_name(name)[: MAXIMUM_NAME - 8].strip("_")
    made = made if made[:1].isalpha() else f"n_{made}"
    good = made not in taken and name_mistake(ScalarNode(made, Span(1, 1, 2), "", False), "") is None
    return made if good else f"{made}_1"


def plain_name(name: str) -> str:
    """The name with `_` for characters that names cannot have."""
    return re.sub(r"[^A-Za-z0-9_]", "_", name)
