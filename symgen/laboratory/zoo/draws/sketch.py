"""A drawing in progress: a model file that grows around a configuration at which everything is measured."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from functools import partial
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice, decimal, exact
from symgen.laboratory.zoo.draws.names import Namer
from symgen.laboratory.zoo.witness.numbers.fields import Floats, settled
from symgen.laboratory.zoo.witness.numbers.tape import Node
from symgen.laboratory.zoo.witness.reading.mechanics import constraint_jacobian
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded

# rows that are none, and rows that are as good as dependent
FLAT, DEPENDENT = 1e-12, 1e-3
# a coordinate that no motion changes
HELD = 1e-7
TRIES = 8


class Sketch:
    """A model file that grows, with a configuration at which everything drawn so far can be measured."""

    def __init__(self, dice: Dice, family: str) -> None:
        self.dice, self.family = dice, family
        self.name = Namer(dice, 0.5 if dice.chance(0.15) else 0)
        dice.extreme = dice.chance(0.08)
        self.blocks: dict[str, Any] = {"model": "zoo"}
        self.start: dict[str, float] = {}
        self.marks: list[str] = []
        self.files: dict[str, str] = {}

    def mark(self, text: str) -> None:
        """Says of the drawing what its text does not show."""
        self.marks.append(text)

    def block(self, name: str) -> dict[str, Any]:
        """A block, made where it is missing."""
        entries: dict[str, Any] = self.blocks.setdefault(name, {})
        return entries

    def coordinate(self, plain: str, value: float, unit: str = "rad") -> str:
        """A new coordinate with its value at the start."""
        name = self.name(plain)
        self.block("coordinates")[name] = {"unit": unit} if self.dice.chance(0.7) else {}
        self.start[name] = value
        return name

    def parameter(self, plain: str, value: str, positive: bool = True) -> str:
        """A parameter, or its value as a literal."""
        # 1, 2, 4 and 1/2 are pure numbers wherever they stand, never lengths or masses
        if float(value) not in (1, 2, 4, 0.5) and self.dice.chance(0.2):
            return value if not value.startswith("-") else f"({value})"
        name = self.name(plain)
        entry: dict[str, Any] = {"value": value}
        if positive and float(value) > 0 and self.dice.chance(0.3):
            entry["range"] = [decimal(float(value) * 0.7, 3), decimal(float(value) * 1.4, 3)]
        self.block("parameters")[name] = entry
        return name

    def definition(self, plain: str, text: str, always: bool = False) -> str:
        """A definition, or the text in brackets."""
        if not always and self.inlined:
            return f"({text})"
        name = self.name(plain)
        self.block("definitions")[name] = text
        return name

    inlined = False

    def measured(self, text: str) -> float:
        """What an expression is at the start."""
        system = SystemReader(expanded(self.blocks, self.files))
        return self.values(system, [system.read(text)])[0]

    def values(self, system: SystemReader, nodes: list[Node]) -> list[float]:
        """Numbers of nodes at the start."""
        floats = Floats()
        values: dict[str, float] = {**self.start, **dict.fromkeys((f"{name}_dot" for name in self.start), 0.0)}
        for name, value in system.parameters.items():
            values[name] = system.tape.evaluate([value], values, floats)[0]
        return [float(value) for value in system.tape.evaluate(nodes, values, floats)]

    def place(self, owner: str) -> list[float]:
        """Where a point or the origin of a frame is at the start."""
        system = SystemReader(expanded(self.blocks, self.files))
        return self.values(system, list(system.place(owner)))

    def axes(self, frame: str) -> list[list[float]]:
        """The attitude of a frame at the start, as rows of its matrix."""
        system = SystemReader(expanded(self.blocks, self.files))
        flat = self.values(system, [entry for row in system.frames.pose(frame).axes for entry in row])
        return [flat[0:3], flat[3:6], flat[6:9]]

    def rows(self, away: float = 0.0) -> Any:
        """Rows of length 1 of the constraint Jacobian at the start, or at a place that is about so far away from it."""
        system = SystemReader(expanded(self.blocks, self.files))
        rows = constraint_jacobian(system)
        values = {name: value + self.dice.uniform(-away, away) for name, value in self.start.items()}
        values |= dict.fromkeys(system.rate_names, 0.0)
        for name, node in system.parameters.items():
            values[name] = system.tape.evaluate([node], values, Floats())[0]
        # rounding leaves something of a row that says nothing, and of one times a million more than of others
        jacobian = np.array([settled(partial(system.tape.evaluate, row), values) for row in rows])
        jacobian = jacobian.reshape(-1, len(system.coordinates))
        lengths = np.linalg.norm(jacobian, axis=1)
        return jacobian[lengths > FLAT] / lengths[lengths > FLAT, None]

    def locked(self) -> bool:
        """Whether rows depend on each other at the start that do not elsewhere, or hold more than there is to hold.

        Such a loop closes in single poses, by the last digits of its lengths.
        """
        here, there = self.rows(), self.rows(away=0.2)
        if _rank(here) < _rank(there):
            return True
        return _rank(here) < len(there) and bool((np.abs(null_space(here)).max(axis=0, initial=0) < HELD).any())

    def that_moves(self, close: Callable[[], int], oddly: float) -> int:
        """Tries loops until one leaves the mechanism able to move, and now and then takes one that does not.

        How many rows it has; 0 where none is found.
        """
        for _ in range(TRIES):
            before, marks = deepcopy(self.blocks), list(self.marks)
            rows = close()
            if not rows or not self.locked():
                return rows
            if self.dice.chance(oddly):
                self.mark("locked loop")
                return rows
            self.blocks, self.marks = before, marks
        return 0

    def row(self, plain: str, text: str, measured: bool = True) -> str:
        """A geometric row that holds at the start."""
        if measured:
            value = self.measured(text)
            if abs(value) > 1e-12 or self.dice.chance(0.5):
                place = self.parameter(f"{plain}_at", exact(value), positive=False)
                text = f"{text} - {place}"
        if self.dice.chance(0.12):
            text = f"{self.dice.choice(('1e-6', '1e6', '1e-6', '1e6', '1e-3', '250'))}*({text})"
        name = self.name(plain)
        self.block("constraints").setdefault("geometric", {})[name] = text
        return name


def _rank(rows: Any) -> int:
    return int((np.linalg.svd(rows, compute_uv=False) > DEPENDENT).sum()) if rows.size else 0


def null_space(rows: Any) -> Any:
    """Directions that rows leave free, as rows."""
    return np.linalg.svd(rows)[2][_rank(rows) :] if rows.size else np.eye(rows.shape[1])
