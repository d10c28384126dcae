"""What a correct kernel gives at the states of a verification: worked out once, however often kernels change."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cached_property
from typing import TypeAlias

from symgen.ir.kernel import Scalar
from symgen.model.model import Model
from symgen.runtime.activity import each, working
from symgen.verify.certificate import SearchRecord
from symgen.verify.reference.reference import Reference, ReferenceValueError
from symgen.verify.sampling.modes import modes
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.outside import OutsideStates
from symgen.verify.sampling.regular import FEWEST_STATES
from symgen.verify.sampling.states import (
    USUAL_STATES,
    Sample,
    VerificationError,
    affordable_states,
    rounded,
    sample_states,
)
from symgen.verify.tolerance import Expectation, expectations

Progress: TypeAlias = Callable[[str], None]


class Expected:
    """States of a model, and the reference values and error units of its quantities there by scalar type.

    Up to 64 `states` become fewer (8 at least) where a count of operations predicts more than 20 s; more are taken as
    asked.  `drawn` are they before they are rounded to a type.  Raises VerificationError when fewer than 8 are found,
    ReferenceValueError when there is no configuration.
    """

    def __init__(self, model: Model, quantities: Sequence[str], states: int, progress: Progress) -> None:
        with working("branches"):
            self.reference = Reference(model)
        self._quantities = tuple(quantities)
        self._progress = progress
        count = states if states > USUAL_STATES else affordable_states(self.reference, quantities, states)
        with working("assembly modes"):
            self.modes = modes(self.reference)
        self.drawn = sample_states(self.reference, quantities, count, modes=self.modes)
        self._searches: dict[tuple[str, str], SearchRecord] = {}
        self._samples: dict[Scalar, tuple[Sample, ...]] = {}
        self._values: dict[Scalar, list[dict[str, Expectation]]] = {}

    @cached_property
    def surroundings(self) -> Surroundings:
        """What lies near the states."""
        return Surroundings(self.reference, self.drawn, self.modes)

    @cached_property
    def outside(self) -> OutsideStates:
        """States out of the ranges of the file."""
        return OutsideStates(self.reference, self.drawn, self.surroundings)

    @property
    def searches(self) -> tuple[SearchRecord, ...]:
        """What was looked for beside the states, by quantity; of several methods with the fewest states."""
        return tuple(record for _, record in sorted(self._searches.items()))

    def record_search(self, made: SearchRecord) -> None:
        """Something was looked for."""
        known = self._searches.setdefault((made.quantity, made.looked_for), made)
        if made.states < known.states:
            self._searches[made.quantity, made.looked_for] = made

    @property
    def scalars(self) -> tuple[Scalar, ...]:
        """The scalar types whose values were asked for."""
        return tuple(self._values)

    def samples(self, scalar: Scalar) -> tuple[Sample, ...]:
        """The states, rounded to the scalar type, at which `values` are."""
        self.values(scalar)
        return self._samples[scalar]

    def values(self, scalar: Scalar) -> list[dict[str, Expectation]]:
        """Reference values and error units of every quantity, state by state.

        States at which a quantity has no value once they are rounded are let go of.  Raises VerificationError when
        fewer than 8 are left.
        """
        if scalar not in self._values:
            computed, kept = [], []
            for index, sample in each("", [(k, rounded(drawn, scalar)) for k, drawn in enumerate(self.drawn)]):
                if index % 8 == 0:
                    self._progress(f"verifying: reference for {scalar}, state {index + 1} of {len(self.drawn)}")
                with suppress(ReferenceValueError):
                    made = expectations(self.reference, sample.state, self._quantities, scalar, f"{scalar} {index}")
                    computed.append(made)
                    kept.append(sample)
            if len(kept) < FEWEST_STATES:
                raise VerificationError(
                    f"only {len(kept)} regular configurations are left once they are rounded to {scalar} "
                    f"({FEWEST_STATES} are needed); give ranges that lie further from singular configurations"
                    + ("" if scalar == "float64" else ", or generate double precision alone, with `--scalar float64`")
                )
            self._samples[scalar] = tuple(kept)
            self._values[scalar] = computed
        return self._values[scalar]
