"""What a kernel loses at many states, measured beside the same operations in more digits; doubts are judged.

In units of d + eps |y|.  For a doubt only: what is lost is what the reference finds.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Kernel, Program, Scalar
from symgen.ir.pairs.wide import paired
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.many_states import run_lanes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.reference.reference import ReferenceValueError, State
from symgen.verify.sampling.nearby_states import Nearby
from symgen.verify.sampling.searched import NUMBERS
from symgen.verify.single_precision import distances, lost_in_float32, units_in_float32
from symgen.verify.tolerance import FACTOR, is_beyond

# Statements of the longest kernels that are measured; in pairs these are twenty times as many.
LONGEST_PAIRED, PAIRED = 4_000, 20


class LostDigits:
    """Of the kernels of one verification."""

    def __init__(self, expected: Expected) -> None:
        self._expected = expected

    @staticmethod
    def are_measured(kernel: Kernel, scalar: Scalar) -> bool:
        """Whether that is affordable, and worth it: pairs of float64 have digits enough."""
        in_pairs = works_with_pairs(kernel)
        length = len(kernel.statements) / (PAIRED if in_pairs else 1)
        return length <= LONGEST_PAIRED and not (in_pairs and scalar == "float64")

    def units(self, kernel: Kernel, programs: Mapping[Scalar, Program], scalar: Scalar, states: Nearby) -> Lanes:
        """A number for each state; 0 where the kernel refuses.  Of long kernels they are estimated.

        Plain numbers have no digits of d left where float32 needs pairs: there d is that of a few changes.
        """
        in_pairs, measured = works_with_pairs(kernel), self.are_measured(kernel, scalar)
        if in_pairs and scalar == "float64":
            return np.zeros(len(states))
        precise = paired(kernel, scalar) if measured and scalar == "float64" else kernel
        errors = None if in_pairs else RoundingErrors(kernel)

        def lost(part: Nearby) -> Lanes:
            if errors is None:
                units = units_in_float32(kernel, programs, part.parts)
                # as large as numbers get where it refuses
                return np.where(units < np.finfo(float).max, units, 0.0)
            own, unit = errors.with_units(part.parts, self._tangents(part))
            with np.errstate(all="ignore"):
                if measured:
                    own, unit = _off(kernel, precise, scalar, part.parts), unit * float(UNIT_ROUNDOFF[scalar])
                return np.nan_to_num(own / unit, posinf=0.0)

        held = max(1, NUMBERS // (len(precise.statements) + 1))
        parts = (states.only(slice(start, start + held)) for start in range(0, len(states), held))
        return np.concatenate([np.zeros(0), *map(lost, parts)])

    def is_lost(self, kernel: Kernel, program: Program, state: State, where: str) -> bool:
        """Whether a kernel has status 0 at a state, and the reference finds more lost than is allowed."""
        (made,) = outcomes(kernel, program.sincos, program.scalar, [state])
        if not made.valid:
            return False
        try:
            reference = self._expected.reference
            return is_beyond(reference, state, kernel.name, program.scalar, where, made.entries, FACTOR)
        except ReferenceValueError:
            return False

    def _tangents(self, states: Nearby) -> Lanes | None:
        reference = self._expected.reference
        dependent = reference.ranks.constraints < reference.system.r
        return self._expected.surroundings.tangents(states) if dependent else None


def _off(kernel: Kernel, precise: Kernel, scalar: Scalar, given: Mapping[str, Lanes]) -> Lanes:
    """How far results are off, beside float64 or beside pairs of numbers."""
    if scalar == "float32":
        return lost_in_float32(kernel, given)
    refused, y = run_lanes(kernel, None, scalar, given)
    unknown, z = run_lanes(precise, None, scalar, given)
    return np.where(refused + unknown == 0, distances(y, z), 0.0)
