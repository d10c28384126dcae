"""What a drawn system has of what the zoo is there to draw: counted, so that nothing goes missing unnoticed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.draws.drawn import ROUNDING, DrawnEquations, reached
from symgen.laboratory.zoo.draws.names import LEGAL_BY_LANGUAGE
from symgen.laboratory.zoo.witness.numbers.float_rows import normalized
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded

OVER_CONSTRAINED = {
    "bennett": "Bennett linkage",
    "bricard": "Bricard linkage",
    "sarrus": "Sarrus linkage",
    "double_four_bar": "double four-bar on one crank",
}
JOINTS = {
    "prismatic": "prismatic joint",
    "cylindrical": "cylindrical joint",
    "spherical": "spherical joint",
    "floating": "floating base",
    "planar": "planar joint",
}
WORDS = {1: "one loop", 2: "two loops", 3: "three loops", 4: "four loops"}
FUNCTIONS = ("sqrt", "exp", "atan2", "tanh", "log", "cosh", "atan", "asin", "acos", "tan", "sinh")
DECADES = 1e9
# letters that draws use anyway
USUAL = frozenset("acdghklmqrsuvwxyzJLR")

# in the order in which the zoo's task names them
ALL = (
    "energies", "bodies", "energies and bodies", "URDF",
    *(f"{n} coordinate{'s' if n > 1 else ''}" for n in range(1, 13)),
    "tree", *(f"{count} {where}" for where in ("in the plane", "in space") for count in WORDS.values()),
    "loop on a frame that moves",
    "parallelogram with several cranks", "Bennett linkage", "Bricard linkage", "Sarrus linkage",
    "double four-bar on one crank", "cranks on a common pin", "platform on legs",
    *JOINTS.values(), "quaternion", "rolling", "rows of rates", "coupling", "cable",
    "absolute angles", "relative angles", "absolute coordinates",
    "rows that depend on each other", "row times 1e-6", "row times 1e6", "locked loop", "cannot move",
    "start at a singular pose",
    "no inputs", "underactuated", "fully actuated", "redundantly actuated", "input that moves nothing",
    "input that others replace", "M depends on q",
    "coordinate without mass", "frame without a body", "end without a body",
    *(f"{name} in a potential" for name in FUNCTIONS), "exp of a length",
    "parameter that is zero", "parameters that are equal", "parameters 1e9 apart", "parameter with a range",
    *(f"names that hurt in {language}" for language in LEGAL_BY_LANGUAGE), "reserved name",
    "outputs chosen at random", "all outputs", "outputs by default", "outputs in one call", "one scalar type",
    "start told", "start left out",
    "independent velocities", "measured coordinates", "task", "weights", "one preload", "preloads", "limits",
    "wide range of angles",
    "spring", "damper", "friction", "force element", "rotor", "applied force", "skew axis", "fixed turn",
    "mistake on purpose",
)  # fmt: skip


def features(description: Description) -> frozenset[str]:
    """Which of `ALL` a drawn system has."""
    blocks = expanded(description.blocks, description.files)
    present = set(_of_text(description, blocks)) | set(_of_marks(description.marks))
    return frozenset(present | set(_of_numbers(DrawnEquations(blocks, description.start), blocks)))


def _of_marks(marks: tuple[str, ...]) -> Iterator[str]:
    for where in ("in the plane", "in space"):
        count = marks.count(f"loop {where}")
        if count:
            yield f"{WORDS[min(count, 4)]} {where}"
    yield from (mark for mark in marks if mark in ALL)


def _of_text(description: Description, blocks: Mapping[str, Any]) -> Iterator[str]:
    energies, bodies = "kinetic_energy" in blocks, "bodies" in blocks
    yield "energies and bodies" if energies and bodies else "energies" if energies else "bodies"
    if "urdf" in description.blocks:
        yield "URDF"
    n = len(description.start)
    yield f"{n} coordinate{'s' if n > 1 else ''}"
    if description.family in OVER_CONSTRAINED:
        yield OVER_CONSTRAINED[description.family]
    yield from _of_joints(blocks)
    yield from _of_rows(blocks)
    potential = str(blocks.get("potential_energy", ""))
    yield from (f"{name} in a potential" for name in FUNCTIONS if re.search(rf"\b{name}\(", potential))
    yield from _of_values(blocks)
    names = {*description.start, *_names(blocks)}
    for language, hurting in LEGAL_BY_LANGUAGE.items():
        if names & set(hurting) - USUAL:
            yield f"names that hurt in {language}"
    outputs = blocks.get("outputs")
    yield "all outputs" if outputs == "all" else "outputs chosen at random" if outputs else "outputs by default"
    if isinstance(outputs, list) and any(not isinstance(name, str) for name in outputs):
        yield "outputs in one call"
    if description.options:
        yield "one scalar type"
    yield "start told" if "configuration" in blocks else "start left out"
    yield from _of_elements(blocks)


def _of_joints(blocks: Mapping[str, Any]) -> Iterator[str]:
    joints = (blocks.get("joints") or {}).values()
    for entry in joints:
        if entry["type"] in JOINTS:
            yield JOINTS[entry["type"]]
        if entry["type"] in ("spherical", "floating"):
            yield "quaternion"
        if isinstance(entry.get("axis"), (list, tuple)):
            yield "skew axis"
        if entry.get("rotation"):
            yield "fixed turn"
    frames = {entry.get("child", name) for name, entry in (blocks.get("joints") or {}).items()}
    carriers = {entry.get("parent") for entry in joints}
    carrying = {(body or {}).get("frame", name) for name, body in (blocks.get("bodies") or {}).items()}
    carrying |= {entry.get("parent") for entry in (blocks.get("frames") or {}).values() if entry}
    for frame in frames - carrying:
        yield "frame without a body" if frame in carriers else "end without a body"


def _of_rows(blocks: Mapping[str, Any]) -> Iterator[str]:
    rows = blocks.get("constraints") or {}
    texts = [text for kind in rows.values() for text in kind.values()]
    for scale in ("1e-6", "1e6"):
        if any(text.startswith(f"{scale}*") for text in texts):
            yield f"row times {scale}"
    if rows.get("nonholonomic"):
        yield "rows of rates"
    if "rolling" in blocks:
        yield "rolling"


def _of_values(blocks: Mapping[str, Any]) -> Iterator[str]:
    entries = [
        entry if isinstance(entry, Mapping) else {"value": entry} for entry in (blocks.get("parameters") or {}).values()
    ]
    literals = [abs(float(e["value"])) for e in entries if re.fullmatch(r"-?[0-9.]+(e[-+]?\d+)?", str(e["value"]))]
    if 0 in literals:
        yield "parameter that is zero"
    if len(set(literals)) < len(literals):
        yield "parameters that are equal"
    sizes = [value for value in literals if value]
    if sizes and max(sizes) >= DECADES * min(sizes) * (1 - ROUNDING):
        yield "parameters 1e9 apart"
    if any("range" in entry for entry in entries):
        yield "parameter with a range"


def _of_elements(blocks: Mapping[str, Any]) -> Iterator[str]:
    springs = (blocks.get("springs") or {}).values()
    inputs = (blocks.get("inputs") or {}).values()
    allocation = blocks.get("allocation") or {}
    preload = allocation.get("preload")
    by_name = {
        "spring": bool(springs),
        "damper": any("damping" in spring for spring in springs),
        "friction": "friction" in blocks,
        "force element": "forces" in blocks,
        "rotor": "rotor_inertias" in blocks,
        "applied force": "applied_forces" in blocks,
        "cable": any("cable" in entry for entry in inputs),
        "weights": "weights" in allocation,
        "one preload": isinstance(preload, str),
        "preloads": isinstance(preload, Mapping),
        "limits": "limits" in allocation,
        "independent velocities": "independent_velocities" in blocks,
        "measured coordinates": "measured" in blocks,
        "task": "task" in blocks,
        "wide range of angles": blocks.get("trig_range") == "wide",
    }
    yield from (name for name, true in by_name.items() if true)


def _of_numbers(drawn: DrawnEquations, blocks: Mapping[str, Any]) -> Iterator[str]:
    at = drawn.at_start
    joints = (blocks.get("joints") or {}).values()
    if not drawn.freedom:
        yield "cannot move"
    norms = sum(entry["type"] in ("spherical", "floating") for entry in joints)
    if len(at.rows) == norms:
        yield "tree"
    rows = np.array(at.rows, dtype=float).reshape(-1, at.n)
    if drawn.rank < len(normalized(rows)):
        yield "rows that depend on each other"
    count = len(at.control[0]) if at.control else 0
    if not count:
        yield "no inputs"
    elif drawn.reach < drawn.freedom:
        yield "underactuated"
    elif count == drawn.freedom:
        yield "fully actuated"
    if count > drawn.reach:
        yield "redundantly actuated" if drawn.reach == drawn.freedom else "input that others replace"
        idle = [np.linalg.norm(reached(place), axis=0) for place in drawn.places]
        if (np.max(idle, axis=0) < ROUNDING).any():
            yield "input that moves nothing"
    other = drawn.at([value + Dice("M", name).uniform(0.1, 0.3) for name, value in drawn.start.items()])
    if count and np.abs(np.array(other.control, dtype=float) - np.array(at.control, dtype=float)).max() > ROUNDING:
        yield "M depends on q"
    mass = np.array(at.mass, dtype=float)
    if (np.abs(mass).max(axis=1) <= NOTHING**2 * np.abs(mass).max()).any():
        yield "coordinate without mass"


def _names(blocks: Mapping[str, Any]) -> Iterator[str]:
    for block in ("parameters", "definitions", "frames", "joints", "bodies", "points", "loops", "inputs", "springs"):
        yield from blocks.get(block) or ()
    for rows in (blocks.get("constraints") or {}).values():
        yield from rows
