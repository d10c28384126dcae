"""A drawn system as data, and the model file it becomes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import yaml

# blocks in the order in which people write them
ORDER = (
    "model", "description", "urdf", "coordinates", "parameters", "definitions", "gravity", "frames", "joints", "bodies",
    "rotor_inertias", "points", "loops", "rolling", "springs", "friction", "forces", "kinetic_energy",
    "potential_energy", "constraints", "inputs", "allocation", "applied_forces", "outputs", "independent_velocities",
    "measured", "task", "configuration", "ranges", "tolerances", "trig_range",
)  # fmt: skip
# the mark of a draw that must be refused
MISTAKE = "mistake on purpose"
PLAIN = re.compile(r"[A-Za-z_0-9.+*/() -]+")


@dataclass(frozen=True)
class Terms:
    """A sum that is written out, term by term, so that a shrinker can take terms away."""

    terms: tuple[str, ...]

    def __str__(self) -> str:
        return " + ".join(term if not term.startswith("-") else f"({term})" for term in self.terms) or "0"


@dataclass(frozen=True)
class Description:
    """A model file as data: blocks of mappings, lists, texts and sums.

    `start` is a configuration that satisfies the constraints by construction, whether the file tells it or not.
    `marks` say what the text does not show: how loops were closed, which mistake was made on purpose. `files` stand
    beside the model file. `options` stand behind it on the command line.
    """

    family: str
    blocks: Mapping[str, Any]
    start: Mapping[str, float] = field(default_factory=dict)
    marks: tuple[str, ...] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    options: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The model file."""
        lines: list[str] = []
        known = [key for key in ORDER if key in self.blocks]
        for key in (*known, *(key for key in self.blocks if key not in ORDER)):
            value = self.blocks[key]
            if isinstance(value, Mapping) and value:
                lines.append(f"{key}:")
                lines += _entries(value, "  ", key)
            else:
                lines.append(f"{key}: {flow(value)}")
        return "\n".join(lines) + "\n"


def read_description(text: str, start: Mapping[str, float] | None = None) -> Description:
    """A model file back as data, so that it can be made small; the start is its configuration where none is given."""
    blocks: dict[str, Any] = yaml.load(text, Loader=yaml.BaseLoader)
    for name in ("kinetic_energy", "potential_energy"):
        if name in blocks:
            blocks[name] = Terms(tuple(summands(blocks[name])))
    given = {name: float(value) for name, value in (blocks.get("configuration") or {}).items()}
    return Description("file", blocks, {**given, **(start or {})})


def summands(text: str) -> list[str]:
    """The terms of a sum, outside of brackets; a difference stays together."""
    terms, depth, begin = [], 0, 0
    for index, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and text.startswith(" + ", index):
            terms.append(text[begin:index].strip())
            begin = index + 3
    return [*terms, text[begin:].strip()]


def _entries(value: Mapping[str, Any], indent: str, block: str) -> list[str]:
    lines = []
    for key, entry in value.items():
        if block == "constraints" and isinstance(entry, Mapping):
            lines.append(f"{indent}{key}:")
            lines += _entries(entry, indent + "  ", "")
        else:
            lines.append(f"{indent}{key}: {flow(entry)}")
    return lines


def flow(value: Any) -> str:
    """A value in one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {flow(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(flow(entry) for entry in value) + "]"
    text = str(value)
    if PLAIN.fullmatch(text) and not text.startswith(("*", "-", " ")) and not text.endswith(" "):
        return text
    if re.fullmatch(r"-[0-9.][0-9.e+-]*", text):
        return text
    return '"' + text + '"'
