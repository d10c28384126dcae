"""A failing draw made small: whatever can be left out, frozen or written more simply without another ending is."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from symgen.laboratory.zoo.dice import decimal
from symgen.laboratory.zoo.draws.describe import Description, Terms
from symgen.laboratory.zoo.witness.reading.frames import joint_coordinates
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded

Fails = Callable[[Description], bool]
# what may go as a whole, and entry by entry
OPTIONAL = (
    "description", "ranges", "tolerances", "allocation", "springs", "friction", "forces", "applied_forces",
    "rotor_inertias", "gravity", "potential_energy", "rolling", "loops", "inputs", "configuration", "outputs",
    "independent_velocities", "measured", "task",
)  # fmt: skip
ENTRIES = ("inputs", "loops", "rolling", "springs", "friction", "forces", "applied_forces", "rotor_inertias", "ranges",
           "task")  # fmt: skip


def shrink(description: Description, fails: Fails, most: int = 80) -> Description:
    """The smallest description found that still fails, after at most so many runs."""
    runs = 0
    if description.files:
        # a robot of a file as joints and bodies, where that fails too: those can be made small
        blocks = expanded(description.blocks, description.files)
        alone = replace(description, blocks=blocks, files={})
        description = alone if fails(alone) else description
    changed = True
    while changed:
        changed = False
        for candidate in candidates(description):
            if runs >= most:
                return description
            if candidate.text == description.text:
                continue
            runs += 1
            if fails(candidate):
                description, changed = candidate, True
                break
    return description


def candidates(description: Description) -> Iterator[Description]:
    """Smaller descriptions, those that lose most first."""
    blocks = description.blocks
    yield from _fewer_outputs(description)
    for block in OPTIONAL:
        if block in blocks and block != "outputs":
            yield _with(description, _without(blocks, block))
    names = list(description.start)
    for half in (names[len(names) // 2 :], names[: len(names) // 2]) if len(names) > 3 else ():
        smaller = description
        for name in half:
            smaller = frozen(smaller, name) if name in smaller.start else smaller
        yield smaller
    for name in reversed(names):
        yield frozen(description, name)
    if "constraints" in blocks:
        for kind, rows in blocks["constraints"].items():
            for name in rows:
                kept = {**blocks["constraints"], kind: {key: text for key, text in rows.items() if key != name}}
                filled = {key: value for key, value in kept.items() if value}
                yield _with(
                    description, {**_without(blocks, "constraints"), **({"constraints": filled} if filled else {})}
                )
    for block in ENTRIES:
        for name in blocks.get(block) or {}:
            if len(blocks[block]) > 1:
                yield _with(description, {**blocks, block: _without(blocks[block], name)})
    for block in ("kinetic_energy", "potential_energy"):
        terms = blocks[block].terms if isinstance(blocks.get(block), Terms) else ()
        for k in range(len(terms) if len(terms) > 1 else 0):
            yield _with(description, {**blocks, block: Terms(terms[:k] + terms[k + 1 :])})
    yield from _fewer_names(description)
    yield from _simpler_bodies(description)


def _fewer_outputs(description: Description) -> Iterator[Description]:
    blocks = description.blocks
    outputs = blocks.get("outputs")
    if outputs == "all":
        for name in ("inverse_dynamics", "forward_dynamics", "multipliers"):
            yield _with(description, {**blocks, "outputs": [name]})
    elif isinstance(outputs, list) and len(outputs) > 1:
        for name in outputs:
            yield _with(description, {**blocks, "outputs": [name]})


def _fewer_names(description: Description) -> Iterator[Description]:
    """Parameters and definitions written where they are used; points that nothing uses left out."""
    blocks = description.blocks
    for name, entry in (blocks.get("parameters") or {}).items():
        value = entry["value"] if isinstance(entry, Mapping) else entry
        yield _with(description, substituted(_dropped(blocks, "parameters", name), name, str(value)))
        if isinstance(entry, Mapping) and "range" in entry:
            yield _with(description, {**blocks, "parameters": {**blocks["parameters"], name: {"value": value}}})
    for name, text in (blocks.get("definitions") or {}).items():
        yield _with(description, substituted(_dropped(blocks, "definitions", name), name, f"({text})"))
    for block in ("points", "frames"):
        for name in blocks.get(block) or {}:
            less = _dropped(blocks, block, name)
            if not re.search(rf"\b{name}\b", Description("", less).text):
                yield _with(description, less)


def _simpler_bodies(description: Description) -> Iterator[Description]:
    blocks = description.blocks
    bodies = blocks.get("bodies") or {}
    for name, body in bodies.items():
        if len(bodies) > 1:
            yield _with(description, _dropped(blocks, "bodies", name))
        for key in ("inertia", "com"):
            if key in body and len(body) > 1:
                yield _with(description, {**blocks, "bodies": {**bodies, name: _without(body, key)}})


def frozen(description: Description, name: str) -> Description:
    """The description with one coordinate held where it is at the start."""
    value = decimal(description.start[name], 17)
    blocks = dict(description.blocks)
    for joint, entry in (blocks.get("joints") or {}).items():
        if name in joint_coordinates(entry):
            blocks = _held(blocks, joint, entry, description.start)
            gone = joint_coordinates(entry)
            break
    else:
        gone = [name]
    for chosen in ("independent_velocities", "measured", "task"):
        if chosen in blocks:
            # which of the others determine the rest now is not known
            blocks = _without(blocks, chosen)
    for each in gone:
        for block in ("coordinates", "configuration", "ranges", "friction", "rotor_inertias", "applied_forces"):
            if each in (blocks.get(block) or {}):
                blocks = _dropped(blocks, block, each)
        blocks = substituted(_unused(blocks, each), f"{each}_dot", "0")
        blocks = substituted(blocks, each, decimal(description.start[each], 17) if each != name else value)
    start = {key: number for key, number in description.start.items() if key not in gone}
    return replace(description, blocks=blocks, start=start)


def _held(blocks: dict[str, Any], joint: str, entry: Mapping[str, Any], start: Mapping[str, float]) -> dict[str, Any]:
    """A joint turned into a frame that stands as the joint does at the start."""
    values = [f"({decimal(start[name], 17)})" for name in joint_coordinates(entry)]
    at, axis, kind = list(entry.get("at", ["0", "0", "0"])), entry.get("axis", "z"), entry["type"]
    frame: dict[str, Any] = {"parent": entry["parent"]} if "parent" in entry else {}
    turns = list(entry.get("rotation", []))
    if kind == "revolute":
        turns.append([axis, values[0]])
    elif kind in ("prismatic", "cylindrical") and isinstance(axis, str):
        index = "xyz".index(axis)
        at[index] = f"{at[index]} + {values[0]}"
        turns += [[axis, values[1]]] if kind == "cylindrical" else []
    elif kind in ("planar", "floating"):
        moved = 2 if kind == "planar" else 3
        at = [f"{place} + {value}" for place, value in zip(at[:moved], values[:moved], strict=True)] + at[moved:]
        turns += [["z", values[2]]] if kind == "planar" else []
    if kind in ("spherical", "floating"):
        frame["rotation"] = {"quaternion": values[-4:]}
    elif turns:
        frame["rotation"] = turns
    frame["translation"] = at
    name = entry.get("child", joint)
    return {**_dropped(blocks, "joints", joint), "frames": {**(blocks.get("frames") or {}), name: frame}}


def _unused(blocks: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Without springs and inputs that act on the coordinate."""
    rest = dict(blocks)
    for block in ("springs", "inputs"):
        for key, entry in (rest.get(block) or {}).items():
            column = entry.get("acts_on")
            if entry.get("joint") == name or (column and set(column) == {name}):
                rest = _dropped(rest, block, key)
            elif column and name in column:
                rest = {**rest, block: {**rest[block], key: {"acts_on": _without(column, name)}}}
    return rest


def substituted(value: Any, name: str, text: str) -> Any:
    """A name replaced in all expressions; keys are left alone."""
    word = re.compile(rf"(?<![\w.]){re.escape(name)}(?![\w.])")
    if isinstance(value, Mapping):
        return {key: substituted(entry, name, text) for key, entry in value.items()}
    if isinstance(value, Terms):
        return Terms(tuple(str(substituted(term, name, text)) for term in value.terms))
    if isinstance(value, (list, tuple)):
        return [substituted(entry, name, text) for entry in value]
    bracketed = f"({text})" if text.startswith("-") else text
    return word.sub(bracketed, value) if isinstance(value, str) else value


def _without(mapping: Mapping[str, Any], key: str) -> dict[str, Any]:
    return {name: value for name, value in mapping.items() if name != key}


def _dropped(blocks: Mapping[str, Any], block: str, name: str) -> dict[str, Any]:
    """The blocks without one entry, and without the block where that was its last."""
    left = _without(blocks[block], name)
    return {**blocks, block: left} if left else _without(blocks, block)


def _with(description: Description, blocks: Mapping[str, Any]) -> Description:
    return replace(description, blocks=blocks)
