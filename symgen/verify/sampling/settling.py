"""What lies near the samples of a verification becomes one: brought onto V, looked at whether it is regular there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot, isfinite, sqrt

import numpy as np

from symgen.verify.lanes.loops_in_lanes import LoopsInLanes
from symgen.verify.lanes.ranks_in_lanes import lost_together, matrices, ranked_parts
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import onto_manifold
from symgen.verify.reference.configurations.manifold import exceeds
from symgen.verify.reference.parameter_values import ParameterValues
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.sampling.plain_values import PROJECTED, SAMPLING_BITS, floats, settled, values_at
from symgen.verify.sampling.regular import REGULAR_SHARE
from symgen.verify.sampling.states import Sample
from symgen.verify.sampling.task_ahead import with_task

# How near to singular states u, accelerations and multipliers are judged, beside samples: a thousandth, of measures
# that are squares.  The others keep to where samples are: beside stretched knees N_B and admissible velocities lose
# digits, and hardly anybody wants them there at ten times the operations.
NEARER = 1e-6
# Samples whose rows show how long rows are.
TYPICAL = 8


class Settling:
    """Takes what is as regular as the samples are: at least a thousandth of the usual, or as the least of them.

    `measures` are the least that rows and inputs are to have; a share of that of the samples, where states beside
    singular ones count as well: there of directions of rows that are lost together the least counts.
    """

    def __init__(self, reference: Reference, samples: Sequence[Sample], share: float = 1.0) -> None:
        self._reference, model, self._nearer = reference, reference.model, share < 1
        self._parts = ranked_parts(reference.system, reference.ranks)
        self._loops = LoopsInLanes(reference.system, [float(x) for x in reference.literals()])
        tied = () if model.assembly is None else model.assembly.tied
        self._varied = ParameterValues(model, [p.name for p in model.parameters if p.range and p.name not in tied])
        usual = REGULAR_SHARE ** max(1.0, (model.n - reference.ranks.constraints) / 2)
        columns = zip(*(sample.measures for sample in samples), strict=True)
        self.measures = [share * min(usual, max(column) / 10, *column) for column in columns]
        with precision(SAMPLING_BITS):
            lengths = [self._lengths(sample.state) for sample in samples[:TYPICAL]]
        self._rows = [
            sqrt(share) * min(REGULAR_SHARE * max(column), *column) for column in zip(*lengths, strict=True)
        ]

    def sample(self, state: State, admissible: bool, quantity: str) -> Sample | None:
        """None where that leads nowhere, near a singularity, or to where the quantity has no value."""
        with precision(SAMPLING_BITS):
            try:
                return self._sample(state, admissible, quantity)
            except ReferenceValueError:
                return None

    def _sample(self, state: State, admissible: bool, quantity: str) -> Sample | None:
        reference, model = self._reference, self._reference.model
        given = dict(zip((p.name for p in model.parameters), state.parameters, strict=True))
        exact, literals = self._varied({name: given[name] for name in self._varied.names}), reference.literals()
        q = onto_manifold(reference.system, state.q, exact, literals, rounded=reference.ranks.rounded)
        if q is None or exceeds(reference.system, reference.ranks, q, exact, literals):
            return None
        state = replace(state, q=tuple(settled(q, [c.range for c in model.coordinates])))
        values = values_at(reference, state, ("singularity", *PROJECTED))
        first, second = values["singularity"]
        sizes = (first * self._lost_together(state), second, *self._lengths(state))
        if not all(low <= x and isfinite(x) for low, x in zip((*self.measures, *self._rows), sizes, strict=True)):
            return None
        if admissible:
            rates = settled(values["admissible_velocity"], [c.rate_range for c in model.coordinates])
            ranges = [c.acceleration_range for c in model.coordinates]
            state = replace(state, qd=tuple(rates), qdd=tuple(settled(values["admissible_acceleration"], ranges)))
        state = with_task(reference, state)
        value = floats(reference.matrices(state, [quantity], SAMPLING_BITS)[quantity])
        return Sample(state, admissible, (first, second)) if all(map(isfinite, value)) else None

    def _lost_together(self, state: State) -> float:
        """The factor by which the measure of rows is not how far the nearest drop of rank is."""
        if not self._nearer:
            return 1.0
        q, p = (np.array([[float(x) for x in part]]) for part in (state.q, state.parameters))
        blocks = matrices(self._reference.system, self._parts, self._loops, q, p)
        return float(lost_together(self._parts, blocks)[0])

    def _lengths(self, state: State) -> list[float]:
        """Of the rows of B."""
        rows = values_at(self._reference, state, ("constraint_jacobian",))["constraint_jacobian"]
        n = self._reference.model.n
        return [hypot(*rows[start : start + n]) for start in range(0, len(rows), n)]
