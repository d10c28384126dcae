"""Drives whose gains are estimated: columns that are made of the log itself, and what a model has in their place.

What a log has in place of inputs is k / k_0 times as much, by a gain k that the file has as k_0.  So projected inputs
of the log, P u = Y b - sum over drives of (k / k_0 - 1) P e u, have a column - P e u / k_0 for each gain: one with the
noise of the log in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.logs.filtering import FilterSettings
from symgen.identification.machine_functions import MachineFunctions
from symgen.model.checks.gains import driven_input
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class DrivesWithGains:
    """Gains by `names` with `before` (g), their values of the file, and `places`, the numbers of their inputs.

    By the gains of the file a unit of such an input has the effect of inputs `along` (g, N, m), and what was `measured`
    (N, m) that of `given` ones.  The motion takes inputs of `columns` (N, m, c) and what is `known` (N, m).  All of
    these are before the filter; of what passes it some samples are `chosen`.
    """

    names: tuple[str, ...]
    before: Array
    places: tuple[int, ...]
    along: Array
    measured: Array
    given: Array
    columns: Array
    known: Array
    settings: FilterSettings
    chosen: slice

    def part(self, chosen: slice) -> DrivesWithGains:
        """Those at some of the samples."""
        return replace(self, chosen=chosen)

    def without(self, place: int) -> DrivesWithGains:
        """All but one."""
        rest = [k for k in range(len(self.names)) if k != place]
        names, places = tuple(self.names[k] for k in rest), tuple(self.places[k] for k in rest)
        return replace(self, names=names, places=places, before=self.before[rest], along=self.along[rest])

    def columns_for(self, inputs: Array) -> Array:
        """Columns (S, m, g), one for each gain, of inputs (N, m)."""
        made = [along * inputs[:, place, None] for along, place in zip(self.along, self.places, strict=True)]
        return np.asarray(self.settings.kept(np.stack(made, axis=-1) / -self.before)[self.chosen], dtype=np.float64)

    def inner(self, factors: Array) -> Array:
        """What drives do against each other (S, m), where inputs have the effect of so many (m) by the file."""
        made, units = self.measured - self.given, np.eye(len(factors))
        for along, place in zip(self.along, self.places, strict=True):
            made = made + (factors[place] - 1) * (units[place] - along) * self.measured[:, place, None]
        return np.asarray(self.settings.kept(made / factors)[self.chosen], dtype=np.float64)

    def predicted(self, values: Array) -> Array:
        """The same columns for the inputs that a motion takes with some values (c) of all but the gains.

        They have no noise of the log.  With other gains they would be as many times as long, which is nothing to
        instruments.
        """
        return self.columns_for(self.columns @ np.nan_to_num(values) + self.known)


def drives_with_gains(
    functions: MachineFunctions,
    names: Sequence[str],
    q: Array,
    inputs: tuple[Array, Array],
    taken: tuple[Array, Array],
    settings: FilterSettings,
) -> DrivesWithGains:
    """Those of a motion with configurations q (N, n), for inputs (N, m), measured and as the motion feels them.

    It takes those of columns (N, m, c) and what is known (N, m).
    """
    places = tuple(driven_input(functions.model, name) for name in names)
    units = np.eye(inputs[0].shape[1])
    along = np.stack([functions.least(q, np.broadcast_to(units[place], inputs[0].shape)) for place in places])
    before = np.array([functions.parameters[name] for name in names])
    return DrivesWithGains(tuple(names), before, places, along, *inputs, *taken, settings, slice(None))
