"""Turns by fixed angles whose sine and cosine are known exactly: multiples of 30 and 45 degrees, written with pi."""

from __future__ import annotations

from fractions import Fraction
from math import pi

from symgen.model.expressions.expression import Binary, Expression, Negation, Number, Pi

# In rad; robot descriptions and models that were computed elsewhere have no pi.
QUARTER_TOLERANCE = 1e-8

# sine of k * 15 degrees for k = 0 ... 6: factor and the number under its root
_SINES: dict[int, tuple[Fraction, int]] = {
    0: (Fraction(0), 1),
    2: (Fraction(1, 2), 1),
    3: (Fraction(1, 2), 2),
    4: (Fraction(1, 2), 3),
    6: (Fraction(1), 1),
}


def exact_sine_and_cosine(angle: Expression) -> tuple[tuple[Fraction, int], tuple[Fraction, int]] | None:
    """Sine and cosine as (factor, number under the root); None for any other angle."""
    parts = _parts(angle)
    if parts is None or parts[0] != 0:
        return None
    steps = parts[1] * 12
    if steps.denominator != 1:
        return None
    sine, cosine = sine_of_steps(int(steps)), sine_of_steps(int(steps) + 6)
    return None if sine is None or cosine is None else (sine, cosine)


def quarter_turns(angle: Expression) -> int | None:
    """How many quarter turns a number stands for that is written without pi, such as 1.5707963267948966.

    None for 0, for what is further away than 1e-8 rad, and for anything that is no number.
    """
    parts = _parts(angle)
    if parts is None or parts[1] != 0:
        return None
    turns = round(float(parts[0]) * 2 / pi)
    return turns if turns and abs(float(parts[0]) - turns * pi / 2) < QUARTER_TOLERANCE else None


def sine_of_steps(steps: int) -> tuple[Fraction, int] | None:
    """The sine of steps * 15 degrees as (factor, number under the root), or None."""
    steps %= 24
    sign = 1 if steps < 12 else -1
    steps %= 12
    known = _SINES.get(min(steps, 12 - steps))
    return None if known is None else (sign * known[0], known[1])


def _parts(angle: Expression) -> tuple[Fraction, Fraction] | None:
    """The angle as a + b pi with rational a and b."""
    match angle:
        case Number(value=value):
            return value, Fraction(0)
        case Pi():
            return Fraction(0), Fraction(1)
        case Negation(operand=operand):
            parts = _parts(operand)
            return None if parts is None else (-parts[0], -parts[1])
        case Binary(operator=operator, left=left, right=right):
            a, b = _parts(left), _parts(right)
            if a is None or b is None:
                return None
            if operator in "+-":
                sign = 1 if operator == "+" else -1
                return a[0] + sign * b[0], a[1] + sign * b[1]
            if operator == "/":
                return None if b[1] != 0 or b[0] == 0 else (a[0] / b[0], a[1] / b[0])
            if a[1] != 0 and b[1] != 0:
                return None
            return a[0] * b[0], a[0] * b[1] + a[1] * b[0]
        case _:
            return None
