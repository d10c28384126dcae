"""Functions of many numbers at once, in float64, with the same bits on every machine.

NumPy has sines, powers and exponentials with instructions of the newest processors, whose last bits are others.  Where
a pivot has lost its digits, or a method starts far from where it ends, these decide which state is the worst.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from symgen.ir.kernel import OperationName
from symgen.ir.sincos import angle_limit, sincos
from symgen.verify.lanes.lane_arithmetic import LaneArithmetic, Lanes

_PORTABLE, _OF_THE_LIBRARY = LaneArithmetic("float64", sincos("float64", wide=True)), LaneArithmetic("float64", None)
# Of larger angles the sines are the library's.
_LARGEST_ANGLE = float(angle_limit("float64", wide=True))


def sines(angles: Lanes) -> tuple[Lanes, Lanes]:
    """Sines and cosines."""
    sine, cosine = _PORTABLE.apply("sincos", [angles])
    large = ~(np.abs(angles) <= _LARGEST_ANGLE)
    if np.any(large):
        others = _OF_THE_LIBRARY.apply("sincos", [np.where(large, angles, 0.0)])
        sine, cosine = (np.where(large, *both) for both in zip(others, (sine, cosine), strict=True))
    return sine, cosine


def applied(operation: OperationName, operands: Sequence[Lanes]) -> Lanes:
    """Any other operation."""
    return _PORTABLE.apply(operation, operands)[0]
