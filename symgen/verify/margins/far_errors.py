"""The rounding errors of a quantity where parameters are far from their values, in units of d + eps |y|.

They are estimated, and estimates to the first order are not all there is: one digit of three may be lost by refinement
that no longer converges, by a pivot without a digit, or by numbers too small for the type.  So they are measured as
well: in float32 beside the same operations in float64, in float64 as noise (`rounding_noise.py`).  Kernels with twice
the digits lose in float32 what the same operations on plain numbers do, but for the digits that pairs gain; in float64
plain numbers may have lost all of theirs, and noise alone counts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from symgen.ir.kernel import UNIT_ROUNDOFF, Kernel, Program, Scalar, Status
from symgen.ir.pairs.wide import GAINED
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.many_states import run_lanes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.rounding_noise import noise_in_units
from symgen.verify.single_precision import distances, in_single_precision
from symgen.verify.tolerance import FACTOR

# Units of an estimate that count as lost: other states than these lose twice as much, and more.
UNITS_LOST = FACTOR / 2
# Up to this power of ten the reference judges what is lost.
JUDGED_UP_TO = 1.0


@dataclass(frozen=True)
class Far:
    """A row for each state with one parameter far away: which, by how many powers of ten, from which start, all that
    is given, and whether rows and inputs are as far from a drop of rank there as in regular states."""

    parameters: Lanes
    powers: Lanes
    starts: Lanes
    given: Mapping[str, Lanes]
    regular: Lanes

    def __len__(self) -> int:
        return len(self.powers)

    def only(self, which: Lanes) -> Far:
        """Those that a mask or places name."""
        given = {name: rows[which] for name, rows in self.given.items()}
        return Far(self.parameters[which], self.powers[which], self.starts[which], given, self.regular[which])

    @property
    def rounded(self) -> dict[str, Lanes]:
        """What is given, in single precision."""
        return in_single_precision(self.given)


def joined(parts: Sequence[Far]) -> Far:
    """All of several, of which there is one at least."""
    given = {name: np.concatenate([part.given[name] for part in parts]) for name in parts[0].given}
    rest = ([getattr(part, name) for part in parts] for name in ("parameters", "powers", "starts", "regular"))
    parameters, powers, starts, regular = map(np.concatenate, rest)
    return Far(parameters, powers, starts, given, regular)


class FarErrors:
    """Those of the kernels of one quantity; `plain` is the one in float64 where that works with pairs of numbers."""

    def __init__(
        self, kernels: Mapping[Scalar, Kernel], programs: Mapping[Scalar, Program], plain: Kernel | None = None
    ) -> None:
        self._programs, self._kernels, self._in_pairs = programs, kernels, plain is not None
        self._estimates = RoundingErrors(plain or kernels["float64"])
        self._single = kernels.get("float32")

    def units(self, far: Far, ranked: bool) -> dict[Scalar, Lanes]:
        """By scalar type, a number for each state; 0 where a kernel refuses with reason.

        That masses or lengths far apart seem to leave the motion undetermined is no reason: infinitely many units.
        That masses are none is one, and that rows or inputs are near a drop of rank.  Where states are not to be
        `ranked`, what is estimated to be more than enough is not measured as well, but for what the reference judges.
        """
        own, unit, massless = self._estimates.with_masses(far.given)
        made: dict[Scalar, Lanes] = {scalar: np.zeros(len(far)) for scalar in self._kernels}
        heavy = np.flatnonzero(~massless)
        far, own, unit = far.only(heavy), own[heavy], unit[heavy]
        by_scalar = self._of_pairs(far, own, unit) if self._in_pairs else self._of_numbers(far, own, unit, ranked)
        for scalar, units in by_scalar.items():
            made[scalar][heavy] = units
        return made

    def _of_pairs(self, far: Far, own: Lanes, unit: Lanes) -> dict[Scalar, Lanes]:
        """In float64 their noise; in float32 what plain numbers lose, less the digits of pairs if these are used."""
        by_scalar: dict[Scalar, Lanes] = {"float64": np.maximum(self._noise(far), self._refusals("float64", far))}
        if self._single is not None:
            if works_with_pairs(self._single):
                by_scalar["float32"] = np.maximum(self._refusals("float32", far), own / unit * 2.0**-GAINED)
            else:
                by_scalar["float32"] = self._in_float32(self._single, far, own / unit, unit)
        return by_scalar

    def _of_numbers(self, far: Far, own: Lanes, unit: Lanes, ranked: bool) -> dict[Scalar, Lanes]:
        """What is estimated or measured, whichever is more."""
        estimated = own / unit
        refused = np.flatnonzero(~np.isfinite(unit))
        estimated[refused] = self._refusals("float64", far.only(refused))
        in_doubt = np.flatnonzero(ranked | (estimated <= UNITS_LOST) | (np.abs(far.powers) <= JUDGED_UP_TO))
        doubts = far.only(in_doubt)
        by_scalar: dict[Scalar, Lanes] = {"float64": _raised_to(estimated, in_doubt, self._noise(doubts))}
        if self._single is not None and works_with_pairs(self._single):
            by_scalar["float32"] = self._in_float32(self._single, far, estimated, unit)
        elif self._single is not None:
            made = self._in_float32(self._single, doubts, estimated[in_doubt], unit[in_doubt])
            by_scalar["float32"] = _raised_to(estimated, in_doubt, made)
        return by_scalar

    def _in_float32(self, kernel: Kernel, far: Far, estimated: Lanes, unit: Lanes) -> Lanes:
        """What is measured in that type, and of plain numbers what is estimated."""
        off, size = self._measured(kernel, far), float(UNIT_ROUNDOFF["float32"]) * unit
        # a unit is infinite where the kernel of float64 refuses, or where squares of slopes are too large for it
        measured = np.divide(off, size, out=np.where(np.isfinite(off), 0.0, off), where=np.isfinite(size))
        return measured if works_with_pairs(kernel) else np.maximum(measured, estimated)

    def _noise(self, far: Far) -> Lanes:
        return noise_in_units(self._kernels["float64"], self._programs["float64"].sincos, far.given)

    def _refusals(self, scalar: Scalar, far: Far) -> Lanes:
        """Infinite where a kernel refuses without a reason, 0 elsewhere."""
        status, _ = run_lanes(self._kernels[scalar], self._programs[scalar].sincos, scalar, far.rounded)
        return np.where(_is_unfounded(status, far.regular), inf, 0.0)

    def _measured(self, kernel: Kernel, far: Far) -> Lanes:
        """How far float32 is off; infinitely where it refuses without a reason, or what float64 does not."""
        given, programs = far.rounded, self._programs
        unknown, exact = run_lanes(kernel, programs["float64"].sincos, "float64", given, numbers="float32")
        status, made = run_lanes(kernel, programs["float32"].sincos, "float32", given)
        off = np.where(status != 0, inf, distances(exact, made))
        return np.where((unknown != 0) & ~_is_unfounded(status, far.regular), 0.0, off)


def _raised_to(estimated: Lanes, places: Lanes, measured: Lanes) -> Lanes:
    """What is estimated, or what is measured at these places where that is more."""
    made = estimated.copy()
    made[places] = np.maximum(made[places], measured)
    return made


def _is_unfounded(status: Lanes, regular: Lanes) -> Lanes:
    """Whether a kernel refuses what is due to masses or lengths far apart: a drop of rank, or numbers too large."""
    due = np.isin(status, (Status.MASS_RANK, Status.NOT_FINITE))
    return due | (np.isin(status, (Status.CONSTRAINT_RANK, Status.ACTUATION_RANK)) & regular)
