"""States out of the ranges that a file states, led to where rows, inputs or masses lose rank: kernels answer there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

from symgen.model.quantities import MAIN
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.inertias import DIVIDED_BY_MASSES, REGULAR_INERTIA
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.nearby_states import Nearby
from symgen.verify.sampling.settling import NEARER, Settling
from symgen.verify.sampling.states import Sample

# States drawn of each kind.
OUTSIDE = 256


class OutsideStates:
    """Those of one verification."""

    def __init__(self, reference: Reference, drawn: Sequence[Sample], around: Surroundings) -> None:
        self._around, self._count = around, around.affordable(OUTSIDE)
        self._settling = Settling(reference, drawn, NEARER)

    def of(self, quantity: str) -> Iterator[Nearby]:
        """Those at which digits of a quantity may be lost."""
        if quantity in MAIN:
            yield self._towards_ranks
        if quantity in MAIN and quantity in DIVIDED_BY_MASSES:
            yield self._towards_no_mass

    def settled(self, states: Nearby, place: int, quantity: str) -> Sample | None:
        """One of them brought onto V; None where that leads nowhere."""
        return self._settling.sample(states.state(place), bool(states.admissible[place]), quantity)

    @cached_property
    def _towards_ranks(self) -> Nearby:
        return self._around.out_of_ranges(self._count, self._settling.measures)

    @cached_property
    def _towards_no_mass(self) -> Nearby:
        return self._around.no_mass_out_of_ranges(self._count, self._settling.measures, NEARER * REGULAR_INERTIA)
