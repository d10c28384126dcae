"""Numbers of a robot description, exact as written, and the turns by roll, pitch and yaw.

A turn nearer than 1e-8 rad to a multiple of a quarter turn stands for it (1.57079633 is pi/2), so that matrices of such
turns are exact.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

from symgen.diagnostics import Span
from symgen.model.expressions.parser import MAXIMUM_DIGITS
from symgen.model.file.source import ScalarNode
from symgen.model.kinematics import triples
from symgen.model.kinematics.fixed_angles import QUARTER_TOLERANCE
from symgen.model.kinematics.triples import transposed

# Of 10, between 1/10 to which and which numbers are read: a density times five lengths is one of double precision.
LARGEST_POWER = 50
# Binary places to which entries of turns are rounded, where denominators have grown through many of them.
FINEST = 400
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(?:[eE]([+-]?\d{1,4}))?", re.ASCII)

Vector: TypeAlias = tuple[Fraction, Fraction, Fraction]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]
IDENTITY: Matrix = (
    (Fraction(1), Fraction(0), Fraction(0)),
    (Fraction(0), Fraction(1), Fraction(0)),
    (Fraction(0), Fraction(0), Fraction(1)),
)


@dataclass(frozen=True, slots=True)
class WrittenNumber:
    """A number of the file: its exact value, as it is written, and where."""

    value: Fraction
    text: str
    span: Span

    @property
    def node(self) -> ScalarNode:
        """The number as a value of the model language."""
        return ScalarNode(self.text, self.span, self.text, False)


def read_number(text: str, span: Span) -> WrittenNumber | None:
    """The number; None for what is none, or has more digits or another size than is read."""
    match = _NUMBER.fullmatch(text)
    if match is None or len(match.group(1)) > MAXIMUM_DIGITS:
        return None
    if abs(int(match.group(2) or 0)) > 2 * LARGEST_POWER:
        return None
    value = Fraction(text)
    if value and not Fraction(1, 10**LARGEST_POWER) <= abs(value) <= 10**LARGEST_POWER:
        return None
    return WrittenNumber(value, text.removeprefix("+"), span)


def written(value: Fraction) -> str:
    """A number computed here: exact where it is a short decimal, else to 15 digits."""
    short = format(float(value), ".15g")
    return short if short != "-0" else "0"


def quarters(angle: WrittenNumber) -> int | None:
    """The number of quarter turns that an angle stands for; None for any other angle."""
    return _quarters(float(angle.value))


def _quarters(angle: float) -> int | None:
    turns = angle / (math.pi / 2)
    near = round(turns)
    return near if abs(turns - near) * (math.pi / 2) < QUARTER_TOLERANCE else None


def angle_text(angle: WrittenNumber) -> str:
    """The angle as an expression: quarter turns with pi."""
    turns = quarters(angle)
    return angle.text if turns is None else {0: "0", 1: "pi/2", -1: "-pi/2"}.get(turns, f"{turns}*pi/2")


def sine_and_cosine(angle: Fraction) -> tuple[Fraction, Fraction]:
    """Both, exact where the angle stands for quarter turns."""
    turns = _quarters(float(angle))
    if turns is None:
        return Fraction(math.sin(float(angle))), Fraction(math.cos(float(angle)))
    return Fraction((0, 1, 0, -1)[turns % 4]), Fraction((1, 0, -1, 0)[turns % 4])


def turn(axis: int, angle: WrittenNumber) -> Matrix:
    """The matrix of a turn about x, y or z (0, 1, 2); exact for quarter turns."""
    sine, cosine = sine_and_cosine(angle.value)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    rows = [list(row) for row in IDENTITY]
    rows[first][first], rows[second][second] = cosine, cosine
    rows[first][second], rows[second][first] = -sine, sine
    x, y, z = ((row[0], row[1], row[2]) for row in rows)
    return x, y, z


def product(left: Matrix, right: Matrix) -> Matrix:
    """left right."""
    x, y, z = (applied(transposed(right), row) for row in left)
    return x, y, z


def applied(matrix: Matrix, vector: Vector) -> Vector:
    """matrix vector."""
    x, y, z = map(_short, triples.applied(matrix, vector))
    return x, y, z


def _short(value: Fraction) -> Fraction:
    """The value, rounded at 2^-400 where its denominator has grown through many turns."""
    if value.denominator.bit_length() <= FINEST:
        return value
    return Fraction(round(value * 2**FINEST), 2**FINEST)
