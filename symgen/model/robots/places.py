"""Where one set of axes sits in another, and the same as translations and turns of the model language."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from symgen.diagnostics import Span
from symgen.model.file.source import ScalarNode, SequenceNode
from symgen.model.kinematics.triples import plus, transposed
from symgen.model.robots.numbers import (
    IDENTITY,
    Matrix,
    Vector,
    WrittenNumber,
    angle_text,
    applied,
    product,
    sine_and_cosine,
    written,
)

# Axes that stay where those outside are are shifted by this.
NO_SHIFT: Vector = (Fraction(0), Fraction(0), Fraction(0))
# The axis of a joint that names none.
ALONG_Z: Vector = (Fraction(0), Fraction(0), Fraction(1))
# The quaternion of axes that are not turned.
UPRIGHT = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
# Of the largest number beside it: what rounding of sines leaves of 0.
REST_OF_ROUNDING = Fraction(1, 10**14)
# In rad: turns that rounding leaves of none.
NO_ANGLE = 1e-14


@dataclass(frozen=True, slots=True)
class AxesPlace:
    """Axes that are shifted, and whose components `axes` turns into those of the axes outside."""

    shift: Vector = NO_SHIFT
    axes: Matrix = IDENTITY

    def then(self, inner: AxesPlace) -> AxesPlace:
        """A place in these axes, seen from outside."""
        return AxesPlace(self.point(inner.shift), product(self.axes, inner.axes))

    def point(self, at: Vector) -> Vector:
        """A point in these axes, seen from outside."""
        return plus(self.shift, applied(self.axes, at))

    @property
    def inverse(self) -> AxesPlace:
        """The outside, seen from these axes."""
        back = transposed(self.axes)
        x, y, z = applied(back, self.shift)
        return AxesPlace((-x, -y, -z), back)

    @property
    def is_nowhere(self) -> bool:
        """Whether the axes are those outside."""
        return not any(self.shift) and self.axes == IDENTITY


def turned_about(axis: Vector, angle: Fraction) -> Matrix:
    """The matrix of a turn about an axis of any length; exact for quarter turns about main axes."""
    return _turned_by(axis, *sine_and_cosine(angle))


def z_to(direction: Vector) -> Matrix:
    """The shortest turn that leads z to a direction of any length but 0."""
    x, y, z = unit(direction)
    side = Fraction(math.sqrt(x * x + y * y))
    # z turned over is turned about x
    return _turned_by((-y, x, Fraction(0)) if side else (Fraction(1), side, side), side, z)


def _turned_by(axis: Vector, sine: Fraction, cosine: Fraction) -> Matrix:
    x, y, z = unit(axis)
    rest = 1 - cosine
    return (
        (cosine + x * x * rest, x * y * rest - z * sine, x * z * rest + y * sine),
        (y * x * rest + z * sine, cosine + y * y * rest, y * z * rest - x * sine),
        (z * x * rest - y * sine, z * y * rest + x * sine, cosine + z * z * rest),
    )


def quaternion_axes(parts: Sequence[Fraction]) -> Matrix:
    """The matrix of a quaternion of any length but 0, scalar part first; quarter turns in few digits are exact."""
    length = Fraction(math.sqrt(sum(part * part for part in parts)))
    w, x, y, z = (_half_turned(part / length) for part in parts)
    two = 2 / (w * w + x * x + y * y + z * z)
    return (
        (1 - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)),
        (two * (x * y + w * z), 1 - two * (x * x + z * z), two * (y * z - w * x)),
        (two * (x * z - w * y), two * (y * z + w * x), 1 - two * (x * x + y * y)),
    )


def quaternion_of(place: AxesPlace) -> tuple[Fraction, Fraction, Fraction, Fraction]:
    """The quaternion of the axes, by its largest part."""
    m = place.axes
    trace = m[0][0] + m[1][1] + m[2][2]
    candidates = [1 + trace, *(1 + 2 * m[i][i] - trace for i in range(3))]
    largest = candidates.index(max(candidates))
    parts = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]]
    if largest == 0:
        four = [candidates[0], *parts]
    else:
        i = largest - 1
        four = [parts[i], *(candidates[largest] if i == k else m[i][k] + m[k][i] for k in range(3))]
    length = Fraction(float(sum(part * part for part in four)) ** 0.5)
    w, x, y, z = (part / length for part in four)
    return w, x, y, z


def _half_turned(part: Fraction) -> Fraction:
    """1 for what a normalised 1 is up to rounding."""
    near = round(part)
    return Fraction(near) if abs(part - near) < REST_OF_ROUNDING else part


def unit(axis: Vector) -> Vector:
    """The vector with length 1."""
    length = _size(axis)
    x, y, z = (entry / length for entry in axis)
    return x, y, z


def _size(axis: Vector) -> Fraction:
    square = sum((entry * entry for entry in axis), Fraction(0))
    root = Fraction(math.isqrt(square.numerator), math.isqrt(square.denominator))
    return root if root * root == square else Fraction(math.sqrt(square))


def shift_node(shift: Vector, span: Span) -> SequenceNode | None:
    """The shift as a vector of the model language; None for none."""
    if not any(shift):
        return None
    return SequenceNode(tuple(ScalarNode(text, span, "", False) for text in texts(shift)), span)


def texts(vector: Sequence[Fraction]) -> list[str]:
    """Numbers that belong together, without what rounding left of 0."""
    least = REST_OF_ROUNDING * max(map(abs, vector))
    return ["0" if abs(entry) <= least else written(entry) for entry in vector]


def turns_node(axes: Matrix, span: Span) -> SequenceNode | None:
    """The turns about z, y and x that lead to the axes; None for none."""
    m = [[float(entry) for entry in row] for row in axes]
    yaw = math.atan2(m[1][0], m[0][0]) if math.hypot(m[0][0], m[1][0]) > NO_ANGLE else 0.0
    sine, cosine = math.sin(yaw), math.cos(yaw)
    pitch = math.atan2(-m[2][0], cosine * m[0][0] + sine * m[1][0])
    roll = math.atan2(sine * m[0][2] - cosine * m[1][2], cosine * m[1][1] - sine * m[0][1])
    turns = []
    for axis, angle in (("z", yaw), ("y", pitch), ("x", roll)):
        number = WrittenNumber(Fraction(angle), written(Fraction(angle)), span)
        if abs(angle) > NO_ANGLE and angle_text(number) != "0":
            turn = ScalarNode(angle_text(number), span, "", False)
            turns.append(SequenceNode((ScalarNode(axis, span, "", False), turn), span))
    return SequenceNode(tuple(turns), span) if turns else None
