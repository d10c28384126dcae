"""Bodies in axes of which their joint's axis is one, where the model's axes lie oblique to it.

Of a body that turns about e, e . (w x I w) loses everything that the rate of its own joint does.  About one of its axes
no such term is formed; about an oblique one they are rounded and left to cancel: accelerations that are 0 become
1e-16, and a wheel that spins fast on a base that hardly turns drowns what the base does to it.

A half turn about the bisector takes an oblique axis to the nearest main one.  It is its own inverse, and its entries
are p + q sqrt(s) with the axis' squared length s, so that tensors and places are turned exactly.  The frame that the
model names stays, fixed to the new one: nothing that is written in its components changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from math import isqrt, lcm
from typing import TypeAlias

from symgen.model.expressions import combine
from symgen.model.expressions.expression import Call, Expression, Number, Pi
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.mechanism import NO_VECTOR, ZERO, Body, Frame, Inertia, Mechanism, Point, Quaternion, Turn, Vector3
from symgen.records import dataclass

# p + q sqrt(s)
Surd: TypeAlias = tuple[Fraction, Fraction]
# 0, as a surd.
NOTHING: Surd = (Fraction(0), Fraction(0))


@dataclass(frozen=True, slots=True)
class HalfTurn:
    """The half turn that takes an axis, `sign` times its direction, to the main axis `main`.

    `axis` are whole numbers, positive along the main axis; `square` is their squared length.
    """

    axis: tuple[int, int, int]
    main: int
    sign: int

    @property
    def square(self) -> int:
        """The squared length s of the axis."""
        return sum(x * x for x in self.axis)

    @property
    def turn(self) -> Turn:
        """The turn itself: by pi about the bisector of both axes."""
        x, y, z = (
            _written((Fraction(a), Fraction(int(i == self.main))), self.square) for i, a in enumerate(self.axis)
        )
        return Turn((x, y, z), Pi())

    def about_main(self, angle: Expression) -> Turn:
        """The joint's own turn, about the main axis."""
        x, y, z = (Number(Fraction(self.sign)) if i == self.main else ZERO for i in range(3))
        return Turn((x, y, z), angle)

    @property
    def rows(self) -> tuple[tuple[Surd, Surd, Surd], ...]:
        """2 n n^T / n.n - 1 with n = axis + sqrt(s) e."""
        s, k, a = self.square, self.main, self.axis
        across = s - a[k] * a[k]

        def entry(i: int, j: int) -> Surd:
            if k in (i, j):
                return _surd(Fraction(0), Fraction(a[j if i == k else i], s), s)
            both = Fraction(a[i] * a[j], across)
            return _surd(both - int(i == j), -both * Fraction(a[k], s), s)

        return tuple((entry(i, 0), entry(i, 1), entry(i, 2)) for i in range(3))

    def vector(self, given: Vector3) -> Vector3:
        """A vector, turned."""
        x, y, z = (self._combined(zip(row, given, strict=True)) for row in self.rows)
        return x, y, z

    def inertia(self, given: Inertia) -> Inertia:
        """A tensor, turned."""
        elements = {(i, j): given.rows[i][j] for i in range(3) for j in range(3)}

        def element(i: int, j: int) -> Expression:
            first, second = self.rows[i], self.rows[j]
            return self._combined((self._product(first[k], second[n]), x) for (k, n), x in elements.items())

        return Inertia(*(element(i, j) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))))

    def _product(self, one: Surd, other: Surd) -> Surd:
        return one[0] * other[0] + self.square * one[1] * other[1], one[0] * other[1] + one[1] * other[0]

    def _combined(self, terms: Iterable[tuple[Surd, Expression]]) -> Expression:
        """Sum of surds times expressions, numbers and equal expressions taken together."""
        number = NOTHING
        factors: dict[Expression, Surd] = {}
        for (p, q), expression in terms:
            value = exact_value(expression)
            if value is not None:
                number = number[0] + p * value, number[1] + q * value
            else:
                before = factors.get(expression, NOTHING)
                factors[expression] = before[0] + p, before[1] + q
        total = _written(number, self.square)
        for expression, factor in factors.items():
            total = combine.plus(total, combine.times(_written(factor, self.square), expression))
        return total


def along_joints(mechanism: Mechanism) -> Mechanism:
    """The mechanism with bodies in the axes of their joints."""
    turned = {frame.name: half for frame in mechanism.frames if (half := _half_turn(mechanism, frame)) is not None}
    if not turned:
        return mechanism
    frames: list[Frame] = []
    for frame in mechanism.frames:
        carried = _carried(frame, turned)
        half = turned.get(frame.name)
        if half is None:
            frames.append(carried)
            continue
        assert not isinstance(carried.rotation, Quaternion)
        *before, own = carried.rotation
        rotation = (*before, half.turn, half.about_main(own.angle))
        frames.append(replace(carried, name=_named(frame.name), rotation=rotation))
        frames.append(replace(frame, parent=_named(frame.name), translation=NO_VECTOR, rotation=(half.turn,)))
    return replace(
        mechanism,
        frames=tuple(frames),
        bodies=tuple(_turned_body(body, turned) for body in mechanism.bodies),
        points=tuple(_turned_point(point, turned) for point in mechanism.points),
    )


def _half_turn(mechanism: Mechanism, frame: Frame) -> HalfTurn | None:
    """That of a frame with bodies that turns, last of all, about an oblique axis given by numbers."""
    if isinstance(frame.rotation, Quaternion) or not frame.rotation or not _carries_alone(mechanism, frame):
        return None
    turn = frame.rotation[-1]
    values = [exact_value(entry) for entry in turn.axis]
    numbers = [value for value in values if value is not None]
    if len(numbers) < 3 or sum(value != 0 for value in numbers) < 2 or not any(names_in(turn.angle)):
        return None
    whole = lcm(*(value.denominator for value in numbers))
    axis = [int(value * whole) for value in numbers]
    main = max(range(3), key=lambda k: (abs(axis[k]), -k))
    sign = 1 if axis[main] > 0 else -1
    x, y, z = (sign * entry for entry in axis)
    return HalfTurn((x, y, z), main, sign)


def _carries_alone(mechanism: Mechanism, frame: Frame) -> bool:
    """Whether all that turns with the frame is bodies of its own, and these more than a mass at its origin.

    Of what else hangs on it, what is lost about its axis is rounded in any axes, and turned ones have more entries.
    """
    loaded = {body.frame for body in mechanism.bodies}
    carried = {frame.name}
    for other in mechanism.frames:
        if other.parent in carried:
            carried.add(other.name)
    return not loaded & (carried - {frame.name}) and any(
        exact_value(entry) != 0
        for body in mechanism.bodies
        if body.frame == frame.name
        for entry in (*body.com, *(x for row in body.inertia.rows for x in row))
    )


def _carried(frame: Frame, turned: Mapping[str, HalfTurn]) -> Frame:
    """A frame on the new axes of its parent."""
    half = turned.get(frame.parent)
    if half is None or isinstance(frame.rotation, Quaternion):
        return frame
    rotation = (half.turn, *frame.rotation)
    return replace(frame, parent=_named(frame.parent), translation=half.vector(frame.translation), rotation=rotation)


def _turned_body(body: Body, turned: Mapping[str, HalfTurn]) -> Body:
    half = turned.get(body.frame)
    if half is None:
        return body
    return replace(body, frame=_named(body.frame), com=half.vector(body.com), inertia=half.inertia(body.inertia))


def _turned_point(point: Point, turned: Mapping[str, HalfTurn]) -> Point:
    carrier = _named(point.carrier) if point.carrier in turned else point.carrier
    half = turned.get(point.frame)
    if half is None:
        return replace(point, carrier=carrier)
    return replace(point, frame=_named(point.frame), at=half.vector(point.at), carrier=carrier)


def _named(frame: str) -> str:
    """No name of a model has a blank."""
    return f"{frame} along its joint"


def _surd(p: Fraction, q: Fraction, square: int) -> Surd:
    """p + q sqrt(square), without the root where it is a whole number."""
    root = isqrt(square)
    return (p + q * root, Fraction(0)) if root * root == square else (p, q)


def _written(surd: Surd, square: int) -> Expression:
    p, q = _surd(*surd, square)
    return combine.plus(Number(p), combine.times(Number(q), Call("sqrt", (Number(Fraction(square)),))))
