"""What a drawn system is at its start and along its constraints: ranks, freedom, reach, masses, in floats."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.witness.kkt import EquationEvaluator, EquationValues
from symgen.laboratory.zoo.witness.numbers.fields import Floats
from symgen.laboratory.zoo.witness.numbers.float_rows import normalized, null_space, rank_of
from symgen.laboratory.zoo.witness.numbers.tape import NodeProgram
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.states import Walker

# what rounding leaves at a start that was measured in floats
ROUNDING = 1e-9
# the root of what rounding leaves of a mass beside the largest entry, ten times over
MASSLESS = 1e-7
PLACES, FURTHER = 6, 24


class DrawnEquations:
    """A model's equations at the configuration that was drawn, and at others that satisfy the constraints."""

    def __init__(self, blocks: Mapping[str, Any], start: Mapping[str, float]) -> None:
        self.system = SystemReader(blocks)
        system_equations = equations(self.system)
        self._evaluate = EquationEvaluator(NodeProgram(self.system.tape, system_equations.flat), system_equations)
        self.start = {name: start.get(name, 0.0) for name in self.system.coordinates}

    @cached_property
    def parameters(self) -> dict[str, float]:
        """Their values in the file."""
        values: dict[str, float] = {}
        for name, node in self.system.parameters.items():
            values[name] = float(self.system.tape.evaluate([node], values, Floats())[0])
        return values

    @cached_property
    def places(self) -> list[EquationValues]:
        """The equations at the start and at configurations that a walk along the constraints reaches."""
        walker = Walker(self.system, self._evaluate, self.start, Dice("places"))
        return [self.at_start, *(self.at(q) for q in walker.points(self.parameters, PLACES))]

    @cached_property
    def at_start(self) -> EquationValues:
        """The equations at the start, at rest."""
        return self.at(list(self.start.values()))

    def at(self, q: Any) -> EquationValues:
        """The equations at a configuration, at rest."""
        values = {**self.parameters, **dict(zip(self.system.coordinates, map(float, q), strict=True))}
        values |= dict.fromkeys(self.system.rate_names, 0.0)
        return self._evaluate.settled(values)

    @cached_property
    def rank(self) -> int:
        """The rank of the constraints, the largest that was met."""
        return max(rank_at(at) for at in self.places)

    @property
    def freedom(self) -> int:
        """The degrees of freedom."""
        return len(self.start) - self.rank

    @cached_property
    def reach(self) -> int:
        """How many directions of motion the inputs span, at most."""
        return max(_reach(at) for at in self.places)

    @cached_property
    def independent(self) -> bool:
        """Whether no row says what others say, and none says nothing."""
        return self.rank == len(self.at_start.rows)

    @cached_property
    def singular(self) -> bool:
        """Whether short steps along the constraints leave their tangent at every place that is found.

        So it is where a linkage closes in single poses, or rows have no gradients where they hold.
        """
        walker = Walker(self.system, self._evaluate, self.start, Dice("steps"))
        places = [np.array(list(self.start.values())), *walker.points(self.parameters, FURTHER)]
        return not any(walker.is_regular(q, self.parameters) for q in places)

    @cached_property
    def undetermined(self) -> bool:
        """Whether at every place some motion that the constraints allow moves no mass."""
        return all(_massless_motion(at) for at in self.places)


def reached(at: EquationValues) -> Any:
    """What each input does along the constraints, in columns of length 1 at most."""
    control = np.array(at.control, dtype=float).reshape(at.n, -1)
    if not control.size:
        return np.zeros((0, 0))
    lengths = np.linalg.norm(control, axis=0)
    return null_space(at).T @ (control / np.where(lengths > 0, lengths, 1))


def rank_at(at: EquationValues) -> int:
    """The rank of the constraints at one configuration."""
    return rank_of(normalized(np.array(at.rows, dtype=float).reshape(-1, at.n)), ROUNDING)


def _reach(at: EquationValues) -> int:
    moved = reached(at)
    return rank_of(moved, ROUNDING, absolute=True) if moved.size else 0


def _massless_motion(at: EquationValues) -> bool:
    free = null_space(at)
    mass = np.array(at.mass, dtype=float)
    along = free.T @ mass @ free
    largest = np.abs(mass).max(initial=0.0)
    if not along.size:
        return False
    # graded masses are masses: each direction in its own size
    sizes = np.sqrt(np.maximum(np.diag(along), 0))
    if sizes.min() <= MASSLESS * np.sqrt(largest):
        return True
    return bool(np.linalg.eigvalsh(along / np.outer(sizes, sizes)).min() < 1e-10)
