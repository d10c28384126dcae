"""Sine and cosine by additions and products alone, so that they are the same numbers on every machine.

The last bits of a C library's are its own; what is decided at generation time must not depend on them.  The angle is
reduced by multiples of pi/2 in three parts (Cody and Waite, Software Manual for the Elementary Functions, ch. 8), what
is left goes through Taylor's series; off by 2.4 ulp at most up to 1e5.
"""

from __future__ import annotations

from math import factorial

# 2/pi: how many quarter turns an angle has.
TWO_OVER_PI = 0.6366197723675814
# pi/2 in parts of 33 and 33 bits and a rest: products of the first two with multiples up to 2^20 are exact
PARTS = (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21)
# of r, r^3, ... and of 1, r^2, ...; the last terms are below a tenth of an ulp at pi/4
SINE = tuple((-1) ** k / factorial(2 * k + 1) for k in range(9))
COSINE = tuple((-1) ** k / factorial(2 * k) for k in range(10))


def sine(angle: float) -> float:
    """The sine of a finite angle."""
    return _quarter(angle, 0)


def cosine(angle: float) -> float:
    """The cosine of a finite angle."""
    return _quarter(angle, 1)


def _quarter(angle: float, ahead: int) -> float:
    """sin(angle + ahead pi/2)."""
    turns = round(angle * TWO_OVER_PI)
    rest = angle
    for part in PARTS:
        rest -= turns * part
    quadrant = (turns + ahead) % 4
    square = rest * rest
    value = 0.0
    for coefficient in reversed(COSINE if quadrant % 2 else SINE):
        value = value * square + coefficient
    if quadrant % 2 == 0:
        value *= rest
    return -value if quadrant > 1 else value
