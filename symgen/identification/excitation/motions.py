"""Whole motions from those of the leading coordinates: loops closed, for many motions at once."""

from __future__ import annotations

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.excitation.leading import Leading
from symgen.identification.machine_functions import MachineFunctions
from symgen.identification.not_identified import NotIdentifiedError

State = tuple[Array, Array, Array]
# Steps on the straight way from the configuration of the model to a place: each is one of Newton's method.
STEPS_OF_A_WAY = 24


class LedMotions:
    """States (N, n) of a machine whose `leading` coordinates are given; it stands at `start` (n), they at `middle` (d).

    Each place is reached on a straight way from the start, so that a state depends on nothing but what leads it.
    """

    def __init__(self, functions: MachineFunctions, leading: Leading) -> None:
        self._functions = functions
        model = functions.model
        known = {name: float(value) for name, value in model.configuration}
        chosen = [known.get(c.name, float(sum(c.range)) / 2) for c in model.coordinates]
        self.start = np.array(chosen if model.assembly is None else model.assembly.places[0].q)
        if leading.given_by == "task":
            self.middle = functions.quantity("task_position", self.start[None])[0]
        else:
            self.middle = self.start[list(model.measured_places)]

    def widths(self, halves: Array) -> Array:
        """How far each leading coordinate (d) goes alone until one of all has moved by so much (n), to first order."""
        rates = np.eye(len(self.middle))
        moved, _ = self._functions.motion(np.tile(self.start, (len(rates), 1)), rates, np.zeros_like(rates))
        if not np.isfinite(moved).all():
            raise NotIdentifiedError(
                "the configuration of the model is singular for the coordinates that lead its motion: give another one"
            )
        return np.asarray(1 / np.max(np.abs(moved) / halves, axis=1), dtype=np.float64)

    def states(self, places: Array, rates: Array, accelerations: Array) -> State:
        """q, qd and qdd (N, n) for what leads them (N, d); NaN where no configuration has these places."""
        q = places
        if self._functions.closes_loops:
            q = np.tile(self.start, (len(places), 1))
            for share in np.arange(1, STEPS_OF_A_WAY + 1) / STEPS_OF_A_WAY:
                q = self._functions.configurations(self.middle + share * (places - self.middle), q)
        return (q, *self._functions.motion(q, rates, accelerations))
