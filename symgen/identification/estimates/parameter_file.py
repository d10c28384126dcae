"""The user's model file with other values of parameters: every other character stays as it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from symgen.diagnostics import ModelError
from symgen.identification.estimates.bodies_file import with_bodies
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import exact_value
from symgen.model.file.source import MappingNode, Node, ScalarNode, SequenceNode, read_tree
from symgen.model.load import DESCRIPTIONS, load_text
from symgen.model.model import Model
from symgen.records import dataclass

# Digits of values that are written.
WRITTEN_DIGITS = 6


@dataclass(frozen=True, slots=True)
class WrittenFile:
    """The new text, or None with `why` there is none; `widened` are parameters whose ranges had to be."""

    text: str | None
    why: str = ""
    widened: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class WrittenBodies:
    """What is written of bodies, by body and key, and of rotors, by coordinate."""

    entries: Mapping[str, Mapping[str, str]]
    rotors: Mapping[str, str]


def with_values(path: Path, values: Mapping[str, float], whole: WrittenBodies | None = None) -> WrittenFile:
    """The file at `path` with these values of parameters; it is read once more, so that it generates at once.

    With `whole` its bodies are these numbers, too.
    """
    text = path.read_bytes().decode("utf-8-sig")
    tree, _ = read_tree(text)
    assert tree is not None
    if described := [key for key in DESCRIPTIONS if tree.get(key) is not None]:
        return WrittenFile(None, f"the bodies stand in the file that `{described[0]}` names, which is left as it is")
    if whole is not None:
        text = with_bodies(text, whole.entries, whole.rotors)
        tree, _ = read_tree(text)
        assert tree is not None
    elif not values:
        return WrittenFile(None, "no parameter of the file was estimated: give masses, centres and inertias names")
    changes, widened = list[tuple[ScalarNode, str]](), list[str]()
    for name, value in values.items():
        node = _value_node(tree, name)
        if node is None:
            return WrittenFile(None, f"the value of `{name}` is not written in one line of `parameters`")
        changes.append((node, f"{value:.{WRITTEN_DIGITS}g}"))
        wider = list(_widened(tree, name, float(f"{value:.{WRITTEN_DIGITS}g}")))
        changes += wider
        widened += [name] if wider else []
    made = _replaced(text, changes)
    try:
        load_text(made, str(path))
    except ModelError as error:
        return WrittenFile(None, f"the model would not be read with these values: {error.mistakes[0].message}")
    return WrittenFile(made, widened=tuple(widened))


def numbers_in_bodies(model: Model) -> tuple[str, ...]:
    """What bodies are given as numbers other than 0, which stay: nothing in `parameters` stands for them."""
    mechanism = model.mechanism
    given: list[tuple[str, Expression]] = []
    for body in mechanism.bodies:
        given.append((f"mass of {body.name}", body.mass))
        given += [(f"com of {body.name}", entry) for entry in body.com]
        given += [(f"inertia of {body.name}", entry) for row in body.inertia.rows for entry in row]
    given += [(f"rotor inertia of {rotor.coordinate}", rotor.inertia) for rotor in mechanism.rotor_inertias]
    return tuple(dict.fromkeys(name for name, expression in given if exact_value(expression)))


def _value_node(tree: MappingNode, name: str) -> ScalarNode | None:
    parameters = tree.get("parameters")
    entry = parameters.get(name) if isinstance(parameters, MappingNode) else None
    node = entry.get("value") if isinstance(entry, MappingNode) else entry
    return node if isinstance(node, ScalarNode) and "\n" not in node.raw else None


def _widened(tree: MappingNode, name: str, value: float) -> Iterator[tuple[ScalarNode, str]]:
    """An end of the range that the value is beyond becomes twice as far from the other end as the value is."""
    ends = _range_nodes(tree, name)
    if ends is None:
        return
    try:
        lower, upper = float(ends[0].value), float(ends[1].value)
    except ValueError:
        return
    if value < lower:
        yield ends[0], f"{value - (upper - value) / 2:.3g}" if value <= 0 else f"{value / 2:.3g}"
    if value > upper:
        yield ends[1], f"{value + (value - lower) / 2:.3g}"


def _range_nodes(tree: MappingNode, name: str) -> tuple[ScalarNode, ScalarNode] | None:
    parameters, ranges = tree.get("parameters"), tree.get("ranges")
    entry = parameters.get(name) if isinstance(parameters, MappingNode) else None
    nodes: list[Node | None] = [
        entry.get("range") if isinstance(entry, MappingNode) else None,
        ranges.get(name) if isinstance(ranges, MappingNode) else None,
    ]
    for node in nodes:
        if isinstance(node, SequenceNode) and len(node.items) == 2:
            first, last = node.items
            if isinstance(first, ScalarNode) and isinstance(last, ScalarNode):
                return first, last
    return None


def _replaced(text: str, changes: list[tuple[ScalarNode, str]]) -> str:
    """Each scalar's characters replaced, from the end of the file so that places before stay."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for node, written in sorted(changes, key=lambda pair: pair[0].span, reverse=True):
        begin = starts[node.span.line - 1] + node.span.column - 1
        text = text[:begin] + written + text[begin + len(node.raw.rstrip()) :]
    return text
