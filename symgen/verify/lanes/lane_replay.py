"""A recorded computation of the reference at many states at once, in float64: where to look, never what is right."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from symgen.verify.lanes.lane_arithmetic import UFUNCS, Lanes, together
from symgen.verify.lanes.portable_lanes import applied, sines
from symgen.verify.reference.arithmetic.tape import Replay

SINES = ("sin", "cos")


class LaneReplay:
    """Registers are rows, states columns; a group of operations is one operation on arrays."""

    def __init__(self, replay: Replay) -> None:
        places = replay.places
        self._constants = np.array(replay.constants.floats())[:, None]
        self._inputs, self._outputs = places.inputs, np.array(places.outputs, dtype=int)
        first = len(self._constants) + len(self._inputs)
        self._groups: list[tuple[Any, slice, list[Lanes]]] = []
        for operation, *operands in places.groups:
            read = [rows for rows in operands if rows is not None]
            made = slice(first, first + len(read[0]))
            self._groups.append((operation, made, [together(rows) for rows in read]))
            first = made.stop
        self._count = first

    def run(self, inputs: Sequence[Lanes], count: int) -> Lanes:
        """The outputs, a row each; `inputs` are numbers, or a number for each of `count` states."""
        registers = np.empty((self._count, count))
        first = len(self._constants)
        registers[:first] = self._constants
        for place, source in enumerate(self._inputs, first):
            registers[place] = inputs[source]
        for operation, made, read in self._groups:
            given = [registers[rows] if rows.__class__ is slice else registers.take(rows, 0) for rows in read]
            if operation in SINES:
                registers[made] = sines(*given)[SINES.index(operation)]
            elif (function := UFUNCS.get(operation)) is not None:
                function(*given, out=registers[made])
            else:
                registers[made] = applied(operation, given)
        return registers[self._outputs]
