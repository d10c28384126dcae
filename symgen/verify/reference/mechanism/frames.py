"""The reference's own walk over frames, bodies and points: rotation matrices and places as Taylor polynomials.

Velocities are what differentiating places and rotation matrices gives, in world axes for places and as the skew matrix
R'R_dot for turning rates; nothing of the derivation's kinematics in body axes is used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import TypeAlias

from symgen.model.expressions.expression import Expression, Number
from symgen.model.mechanism import WORLD, Body, Frame, Mechanism, Quaternion, Turn, Vector3, component
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Polynomial, Taylor

Triple: TypeAlias = list[Polynomial]
Rows: TypeAlias = list[Triple]


class Frames:
    """Places as polynomials in the coordinates, rates to one degree less and linear in the rates.

    `polynomial` translates an expression to polynomials of the coordinates in the arithmetic `algebra`.
    """

    def __init__(self, mechanism: Mechanism, algebra: Taylor, polynomial: Callable[[Expression], Polynomial]) -> None:
        self._algebra, self._polynomial = algebra, polynomial
        self._moving = algebra.of_rates
        self._mechanism = mechanism
        self._frames = {frame.name: frame for frame in mechanism.frames}
        self._points = {point.name: point for point in mechanism.points}
        one: Polynomial = {CONSTANT: algebra.tape.one}
        self._one = one
        identity: Rows = [[one, {}, {}], [{}, one, {}], [{}, {}, one]]
        self._local: dict[str, Rows] = {WORLD: identity}
        self._axes: dict[str, Rows] = {WORLD: identity}
        self._origins: dict[str, Triple] = {WORLD: [{}, {}, {}]}
        self._turning: dict[str, Triple] = {WORLD: [{}, {}, {}]}
        for frame in mechanism.frames:
            self._enter(frame)

    def center(self, body: Body) -> Triple:
        """The centre of mass in world axes."""
        com = self._apply(self._algebra, self._axes[body.frame], self._values(body.com))
        return self._add(self._algebra, self._origins[body.frame], com)

    def turning(self, body: Body) -> Triple:
        """The turning rates of a body in its own axes."""
        return self._turning[body.frame]

    def place(self, owner: str) -> Triple:
        """A point or the origin of a frame in world axes."""
        if owner not in self._points:
            return self._origins[owner]
        point = self._points[owner]
        at = self._apply(self._algebra, self._axes[point.frame], self._values(point.at))
        return self._add(self._algebra, self._origins[point.frame], at)

    def velocity(self, owner: str) -> Triple:
        """Of the material point of the carrier that is there now, in world axes."""
        carrier = self._points[owner].carrier if owner in self._points else owner
        arm = self._add(self._algebra, self.place(owner), [self._algebra.negate(x) for x in self._origins[carrier]])
        arm = self._apply(self._algebra, _transposed(self._axes[carrier]), arm)
        swinging = self._apply(self._moving, [[self.rate(x) for x in row] for row in self._axes[carrier]], arm)
        return self._add(self._moving, [self.rate(x) for x in self._origins[carrier]], swinging)

    def component(self, name: str) -> Polynomial:
        """A component of a point or frame."""
        one = component(name)
        if one.what.startswith("r"):
            algebra = self._algebra
            seen = self._product(algebra, _transposed(self._axes[one.axes]), self._axes[one.owner])
            return seen[int(one.what[1]) - 1][int(one.what[2]) - 1]
        if one.what.startswith("w"):
            vector = self._apply(self._moving, self._axes[one.owner], self._turning[one.owner])
        elif one.is_rate:
            vector = self.velocity(one.owner)
        else:
            vector = self.place(one.owner)
        if one.axes != WORLD:
            algebra = self._moving if one.is_rate else self._algebra
            vector = self._apply(algebra, _transposed(self._axes[one.axes]), vector)
        return vector[one.index]

    def kinetic_energy(self, algebra: Taylor, settled: Callable[[Polynomial], Polynomial]) -> Polynomial:
        """Half the sum of mass times speed squared and of the turning rates' form in the inertias.

        `settled` brings a rate into the arithmetic `algebra`.
        """
        half: Polynomial = {CONSTANT: algebra.tape.constant(Fraction(1, 2))}
        terms: list[Polynomial] = []
        for body in self._mechanism.bodies:
            place = self.center(body)
            mass = self._polynomial(body.mass)
            if mass:
                speeds = [settled(self.rate(x)) for x in place]
                terms += [algebra.multiply(mass, algebra.multiply(v, v)) for v in speeds if v]
            turning = [settled(x) for x in self._turning[body.frame]]
            for row, left in zip(body.inertia.rows, turning, strict=True):
                for entry, right in zip(row, turning, strict=True):
                    inertia = self._polynomial(entry)
                    if inertia and left and right:
                        terms.append(algebra.multiply(inertia, algebra.multiply(left, right)))
        return algebra.multiply(half, _sum(algebra, terms))

    def potential_energy(self) -> Polynomial:
        """Minus mass times gravity times place."""
        algebra = self._algebra
        gravity = self._values(self._mechanism.gravity)
        terms: list[Polynomial] = []
        for body in self._mechanism.bodies if any(gravity) else ():
            pairs = zip(gravity, self.center(body), strict=True)
            height = _sum(algebra, [algebra.multiply(g, x) for g, x in pairs if g and x])
            terms.append(algebra.negate(algebra.multiply(self._polynomial(body.mass), height)))
        return _sum(algebra, terms)

    def rate(self, place: Polynomial) -> Polynomial:
        """The time derivative: every coordinate of a monomial replaced by its rate, one after the other.

        The time along a line is none of the coordinates that move.
        """
        tape = self._algebra.tape
        derivative: Polynomial = {}
        for (coordinates, _), register in place.items():
            for index, moving in enumerate(coordinates):
                if moving == self._algebra.along:
                    continue
                rest = coordinates[:index] + coordinates[index + 1 :]
                if not self._moving.keeps(rest, (moving,)):
                    continue
                monomial = (rest, (moving,))
                known = derivative.get(monomial)
                derivative[monomial] = register if known is None else tape.binary("add", known, register)
        return derivative

    def _enter(self, frame: Frame) -> None:
        algebra, parent = self._algebra, frame.parent
        local = self._attitude(frame)
        self._local[frame.name] = local
        self._axes[frame.name] = self._product(algebra, self._axes[parent], local)
        moved = self._apply(algebra, self._axes[parent], self._values(frame.translation))
        self._origins[frame.name] = self._add(algebra, self._origins[parent], moved)
        rates = [[self.rate(x) for x in row] for row in local]
        inward = _transposed(local)
        own = [
            _sum(self._moving, [self._moving.multiply(inward[i][k], rates[k][j]) for k in range(3)])
            for i, j in ((2, 1), (0, 2), (1, 0))
        ]
        carried = self._apply(self._moving, inward, self._turning[parent])
        self._turning[frame.name] = self._add(self._moving, carried, own)

    def _attitude(self, frame: Frame) -> Rows:
        if isinstance(frame.rotation, Quaternion):
            return self._of_quaternion(frame.rotation)
        axes = self._local[WORLD]
        for turn in frame.rotation:
            axes = self._product(self._algebra, axes, self._of_turn(turn))
        return axes

    def _of_turn(self, turn: Turn) -> Rows:
        """cos 1 + (1 - cos) a a' + sin [a], column by column."""
        algebra = self._algebra
        angle = self._polynomial(turn.angle)
        sine, cosine = algebra.function("sin", angle), algebra.function("cos", angle)
        exact = [entry.value if isinstance(entry, Number) else None for entry in turn.axis]
        if sorted(exact, key=str) == [0, 0, 1]:
            return self._about_main_axis(exact.index(Fraction(1)), sine, cosine)
        axis = self._values(turn.axis)
        length = algebra.power(_sum(algebra, [algebra.multiply(a, a) for a in axis]), Fraction(1, 2))
        axis = [algebra.divide(a, length) if a else {} for a in axis]
        rest = algebra.subtract(self._one, cosine)
        x, y, z = (algebra.multiply(sine, a) for a in axis)
        skew: Rows = [[{}, algebra.negate(z), y], [z, {}, algebra.negate(x)], [algebra.negate(y), x, {}]]
        return [
            [
                _sum(
                    algebra,
                    [
                        *([cosine] if i == j else []),
                        algebra.multiply(rest, algebra.multiply(axis[i], axis[j])),
                        skew[i][j],
                    ],
                )
                for j in range(3)
            ]
            for i in range(3)
        ]

    def _about_main_axis(self, along: int, sine: Polynomial, cosine: Polynomial) -> Rows:
        rows: Rows = [[{}, {}, {}], [{}, {}, {}], [{}, {}, {}]]
        one, other = (along + 1) % 3, (along + 2) % 3
        rows[along][along] = self._one
        rows[one][one] = rows[other][other] = cosine
        rows[one][other], rows[other][one] = self._algebra.negate(sine), sine
        return rows

    def _of_quaternion(self, quaternion: Quaternion) -> Rows:
        """Left times right multiplication by the conjugate, over the square of the length."""
        algebra = self._algebra
        a, b, c, d = (self._polynomial(part) for part in quaternion.parts)
        minus = algebra.negate
        left = [[a, minus(b), minus(c), minus(d)], [b, a, minus(d), c], [c, d, a, minus(b)], [d, minus(c), b, a]]
        right = [[a, b, c, d], [minus(b), a, minus(d), c], [minus(c), d, a, minus(b)], [minus(d), minus(c), b, a]]
        square = _sum(algebra, [algebra.multiply(x, x) for x in (a, b, c, d)])
        return [
            [
                algebra.divide(_sum(algebra, [algebra.multiply(left[i][k], right[k][j]) for k in range(4)]), square)
                for j in (1, 2, 3)
            ]
            for i in (1, 2, 3)
        ]

    def _values(self, vector: Vector3) -> Triple:
        return [self._polynomial(entry) for entry in vector]

    def _add(self, algebra: Taylor, left: Triple, right: Triple) -> Triple:
        return [algebra.add(a, b) for a, b in zip(left, right, strict=True)]

    def _apply(self, algebra: Taylor, matrix: Rows, vector: Triple) -> Triple:
        return [
            _sum(algebra, [algebra.multiply(a, x) for a, x in zip(row, vector, strict=True) if a and x])
            for row in matrix
        ]

    def _product(self, algebra: Taylor, left: Rows, right: Rows) -> Rows:
        return _transposed([self._apply(algebra, left, column) for column in _transposed(right)])


def _transposed(rows: Rows) -> Rows:
    return [list(column) for column in zip(*rows, strict=True)]


def _sum(algebra: Taylor, terms: Iterable[Polynomial]) -> Polynomial:
    total: Polynomial = {}
    for term in terms:
        total = algebra.add(total, term)
    return total
