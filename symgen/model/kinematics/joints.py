"""One frame against its parent: the matrix of its turns, its place, and the rates of both."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Generic

from symgen.model.expressions import combine
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.walk import exact_value
from symgen.model.kinematics.fixed_angles import exact_sine_and_cosine
from symgen.model.kinematics.triples import P, Rates, Rows, Space, Triple, V, product, transposed
from symgen.model.mechanism import ZERO, Frame, Quaternion, Turn, Vector3


@dataclass(frozen=True)
class Joint(Generic[P, V]):
    """`axes` turns components in the frame into components in the parent, `place` is its origin in the parent's axes.

    `turning` is the relative angular velocity in the frame's axes, `turning_before` the same in the parent's.
    """

    axes: Rows[P]
    place: Triple[P]
    place_rate: Rates[V]
    turning: Rates[V]
    turning_before: Rates[V]


def joint_of(space: Space[P, V], frame: Frame) -> Joint[P, V]:
    """The frame against its parent."""
    rotation = frame.rotation
    axes, turning, before = (
        _attitude(space, rotation.parts) if isinstance(rotation, Quaternion) else _turns(space, rotation)
    )
    if axes is not space.identity:
        axes = space.named(f"{frame.name}.axes", axes)
    return Joint(axes, space.values(frame.translation), space.rates(frame.translation), turning, before)


def plane_turn(frame: Frame) -> tuple[Vector3 | None, Expression] | None:
    """Axis and angle of a frame whose turns share one main axis; no axis where it is not turned; else None."""
    if isinstance(frame.rotation, Quaternion):
        return None
    shared: Vector3 | None = None
    angle: Expression = ZERO
    for turn in frame.rotation:
        main = main_axis(turn.axis)
        if main is None or (shared is not None and main != main_axis(shared)):
            return None
        shared, angle = turn.axis, combine.plus(angle, turn.angle)
    return shared, angle


def main_axis(axis: Vector3) -> tuple[int, int] | None:
    """Which of x, y, z (0, 1, 2) the axis is, and its sign; None for any other direction."""
    signed_axis: tuple[int, int] | None = None
    for index, entry in enumerate(axis):
        value = entry.value if isinstance(entry, Number) else exact_value(entry)
        if value is None:
            return None
        if value.numerator:
            if signed_axis is not None or abs(value.numerator) != 1 or value.denominator != 1:
                return None
            signed_axis = index, value.numerator
    return signed_axis


def _turns(space: Space[P, V], turns: tuple[Turn, ...]) -> tuple[Rows[P], Rates[V], Rates[V]]:
    axes, turning, before = space.identity, space.still, space.still
    for turn in turns:
        axis = unit_axis(space, turn.axis)
        matrix = turn_matrix(space, turn.angle, turn.axis)
        spin = space.scaled(axis, space.arithmetic.rate(turn.angle))
        if turning is space.still:
            turning = before = spin
        else:
            turning = space.summed(space.turned(transposed(matrix), turning), spin)
            before = space.summed(before, space.turned(axes, spin))
        axes = matrix if axes is space.identity else product(axes, matrix)
    return axes, turning, before


def turn_matrix(space: Space[P, V], turn: Expression, axis: Vector3) -> Rows[P]:
    """Rodrigues' formula 1 + s K + (1 - c) K^2 with K = axis x."""
    sine, cosine = _sine_and_cosine(space, turn)
    main = main_axis(axis)
    if main is not None:
        return _about(space, main[0], sine if main[1] > 0 else -sine, cosine)
    x, y, z = unit_axis(space, axis)
    versed = space.one - cosine
    xy, xz, yz = x * y * versed, x * z * versed, y * z * versed
    return (
        (cosine + x * x * versed, xy - z * sine, xz + y * sine),
        (xy + z * sine, cosine + y * y * versed, yz - x * sine),
        (xz - y * sine, yz + x * sine, cosine + z * z * versed),
    )


def _sine_and_cosine(space: Space[P, V], turn: Expression) -> tuple[P, P]:
    exact = exact_sine_and_cosine(turn)
    if exact is None:
        angle = space.arithmetic.value(turn)
        return space.arithmetic.function("sin", angle), space.arithmetic.function("cos", angle)
    sine, cosine = (_rooted(space, factor, root) for factor, root in exact)
    return sine, cosine


def _rooted(space: Space[P, V], factor: Fraction, root: int) -> P:
    """factor * sqrt(root)."""
    number = space.arithmetic.number
    rational = number(factor.numerator) / number(factor.denominator)
    return rational if root == 1 else rational * space.arithmetic.function("sqrt", number(root))


def _about(space: Space[P, V], index: int, sine: P, cosine: P) -> Rows[P]:
    one, zero = space.one, space.zero
    if index == 0:
        return (one, zero, zero), (zero, cosine, -sine), (zero, sine, cosine)
    if index == 1:
        return (cosine, zero, sine), (zero, one, zero), (-sine, zero, cosine)
    return (cosine, -sine, zero), (sine, cosine, zero), (zero, zero, one)


def unit_axis(space: Space[P, V], axis: Vector3) -> Triple[P]:
    """The axis with length 1."""
    main = main_axis(axis)
    if main is not None:
        x, y, z = (space.arithmetic.number(main[1] if index == main[0] else 0) for index in range(3))
        return x, y, z
    x, y, z = space.values(axis)
    length = space.arithmetic.function("sqrt", x * x + y * y + z * z)
    return x / length, y / length, z / length


def _attitude(
    space: Space[P, V], parts: tuple[Expression, Expression, Expression, Expression]
) -> tuple[Rows[P], Rates[V], Rates[V]]:
    """The rotation e / |e|; its angular velocity is 2 (w v' - w' v -+ v x v') / (e . e) in the axes after or before."""
    combination = space.arithmetic.combination
    w, x, y, z = (space.arithmetic.value(part) for part in parts)
    w_rate, x_rate, y_rate, z_rate = (space.arithmetic.rate(part) for part in parts)
    two = (space.one + space.one) / (w * w + x * x + y * y + z * z)
    axes = (
        (space.one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)),
        (two * (x * y + w * z), space.one - two * (x * x + z * z), two * (y * z - w * x)),
        (two * (x * z - w * y), two * (y * z + w * x), space.one - two * (x * x + y * y)),
    )
    w, x, y, z = two * w, two * x, two * y, two * z
    turning = (
        combination(((w, x_rate), (-x, w_rate), (-y, z_rate), (z, y_rate))),
        combination(((w, y_rate), (-y, w_rate), (-z, x_rate), (x, z_rate))),
        combination(((w, z_rate), (-z, w_rate), (-x, y_rate), (y, x_rate))),
    )
    before = (
        combination(((w, x_rate), (-x, w_rate), (y, z_rate), (-z, y_rate))),
        combination(((w, y_rate), (-y, w_rate), (z, x_rate), (-x, z_rate))),
        combination(((w, z_rate), (-z, w_rate), (x, y_rate), (-y, x_rate))),
    )
    return axes, turning, before
