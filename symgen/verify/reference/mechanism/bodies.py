"""Bodies in the reference: Jacobians of centres and turning rates, and what a motion along them asks for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb_mat

from symgen.model.expressions.expression import Expression
from symgen.model.mechanism import Mechanism
from symgen.verify.reference.arithmetic.tape import Register
from symgen.verify.reference.arithmetic.taylor import CONSTANT
from symgen.verify.reference.configurations.parts import Part, piece, placed
from symgen.verify.reference.mechanism.frames import Frames
from symgen.verify.reference.translation import Translation

# Rows of the Jacobian of a body.
BODY_ROWS = 6
# Weights of a body: its mass, and the entries of its inertia.
WEIGHTS = 10


@dataclass(frozen=True)
class BodyJacobian:
    """Velocities of centres in world axes and turning rates in body axes by the rates, 6 rows a body.

    Bodies of machines side by side do not feel the coordinates of the others: a matrix for each part.
    """

    parts: Sequence[Part]
    pieces: Sequence[Any]
    n: int

    def mass(self, weights: Sequence[Any]) -> Any:
        """G (n x n) of all bodies, by their masses and inertias."""
        pieces = []
        for part, rows in zip(self.parts, self.pieces, strict=True):
            own = [x for k in part.bodies for x in weights[WEIGHTS * k : WEIGHTS * (k + 1)]]
            pieces.append((part.coordinates, part.coordinates, rows.transpose() * weighted(rows, own)))
        return placed(self.n, self.n, pieces)

    def mass_times(self, vector: Any, weights: Sequence[Any]) -> Any:
        """G times a column (n x 1)."""
        pieces = []
        for part, rows in zip(self.parts, self.pieces, strict=True):
            own = [x for k in part.bodies for x in weights[WEIGHTS * k : WEIGHTS * (k + 1)]]
            moved = rows * piece(vector, part.coordinates, (0,))
            pieces.append((part.coordinates, (0,), rows.transpose() * weighted(moved, own)))
        return placed(self.n, 1, pieces)

    def coriolis(self, rates: Sequence[Any], velocity: Any, weights: Sequence[Any]) -> Any:
        """C (3) (n x n) of all bodies along a velocity, by the rates of their Jacobians.

        Centres have gradients that are symmetric, J'W J_dot is all there is of them.  Columns a_i of turning rates in
        body axes have d_j a_i - d_i a_j = a_i x a_j (of R'dR, for every attitude R), which adds half of
        a_i . (I [w] + [w] I - [I w]) a_j at the turning rate w.
        """
        pieces = []
        for part, rows, change in zip(self.parts, self.pieces, rates, strict=True):
            own = [x for k in part.bodies for x in weights[WEIGHTS * k : WEIGHTS * (k + 1)]]
            moved = rows * piece(velocity, part.coordinates, (0,))
            force = weighted(change, own) + _turned(rows, moved.entries(), own)
            pieces.append((part.coordinates, part.coordinates, rows.transpose() * force))
        return placed(self.n, self.n, pieces)

    def mass_dot(self, rates: Sequence[Any], weights: Sequence[Any]) -> Any:
        """d/dt G (n x n) of all bodies, by the rates of their Jacobians."""
        pieces = []
        for part, rows, change in zip(self.parts, self.pieces, rates, strict=True):
            own = [x for k in part.bodies for x in weights[WEIGHTS * k : WEIGHTS * (k + 1)]]
            half = rows.transpose() * weighted(change, own)
            pieces.append((part.coordinates, part.coordinates, half + half.transpose()))
        return placed(self.n, self.n, pieces)

    def force(self, wrenches: Sequence[Any]) -> Any:
        """What forces on the centres and torques in body axes load the coordinates with (n x 1)."""
        pieces = []
        for part, rows in zip(self.parts, self.pieces, strict=True):
            own = [x for k in part.bodies for x in wrenches[BODY_ROWS * k : BODY_ROWS * (k + 1)]]
            pieces.append((part.coordinates, (0,), rows.transpose() * arb_mat(len(own), 1, own)))
        return placed(self.n, 1, pieces)


class BodyRows:
    """Registers of the Jacobians of bodies, from places of first order in the coordinates; or what these do `along` t.

    Of rates along a line the coefficients of `along` = (t,) count.
    """

    def __init__(
        self, mechanism: Mechanism, frames: Frames, n: int, zero: Register, along: tuple[int, ...] = ()
    ) -> None:
        self._zero = zero
        self._rows: list[list[dict[int, Register]]] = []
        for body in mechanism.bodies:
            centre = [
                {j: place[(j, *along), ()] for j in range(n) if ((j, *along), ()) in place}
                for place in frames.center(body)
            ]
            turning = [
                {j: rate[along, (j,)] for j in range(n) if (along, (j,)) in rate} for rate in frames.turning(body)
            ]
            self._rows.append([*centre, *turning])

    def moved(self) -> list[set[int]]:
        """The coordinates that move each body."""
        return [{j for row in rows for j, x in row.items() if x != self._zero} for rows in self._rows]

    def needed(self, parts: Sequence[Part]) -> list[Register]:
        """The Jacobians of the bodies of each part by its coordinates, row by row."""
        zero = self._zero
        return [
            row.get(j, zero) for part in parts for k in part.bodies for row in self._rows[k] for j in part.coordinates
        ]

    def split(self, parts: Sequence[Part], values: Sequence[Any]) -> tuple[Any, ...]:
        """A matrix for each part from the values of what is needed."""
        pieces, start = [], 0
        for part in parts:
            rows, columns = BODY_ROWS * len(part.bodies), len(part.coordinates)
            pieces.append(arb_mat(rows, columns, values[start : start + rows * columns]))
            start += rows * columns
        return tuple(pieces)


def weights_of(mechanism: Mechanism, plain: Translation) -> list[Register]:
    """The mass and the entries of the inertia of every body."""
    return [
        x
        for body in mechanism.bodies
        for x in constants(plain, [body.mass, *(entry for row in body.inertia.rows for entry in row)])
    ]


def constants(plain: Translation, expressions: Sequence[Expression]) -> list[Register]:
    """The values of expressions of parameters."""
    zero = plain.algebra.tape.zero
    return [plain.polynomial(expression).get(CONSTANT, zero) for expression in expressions]


def weighted(rows: Any, weights: Sequence[Any]) -> Any:
    """Velocities of centres times masses and turning rates times inertias, for each column of `rows`."""
    columns = rows.ncols()
    table = rows.tolist()
    entries: list[Any] = []
    for k in range(rows.nrows() // BODY_ROWS):
        mass, *inertia = weights[WEIGHTS * k : WEIGHTS * (k + 1)]
        block = table[BODY_ROWS * k : BODY_ROWS * (k + 1)]
        entries += [mass * x for row in block[:3] for x in row]
        turned = arb_mat(3, 3, inertia) * arb_mat(3, columns, [x for row in block[3:] for x in row])
        entries += turned.entries()
    return arb_mat(rows.nrows(), columns, entries)


def _turned(rows: Any, velocities: Sequence[Any], weights: Sequence[Any]) -> Any:
    """Half of (I [w] + [w] I - [I w]) times the turning rates of each column, w among the velocities; no force."""
    columns, table = rows.ncols(), rows.tolist()
    entries: list[Any] = []
    for k in range(rows.nrows() // BODY_ROWS):
        inertia = arb_mat(3, 3, list(weights[WEIGHTS * k + 1 : WEIGHTS * (k + 1)]))
        rate = velocities[BODY_ROWS * k + 3 : BODY_ROWS * (k + 1)]
        spin = _crossing(rate)
        momentum = _crossing((inertia * arb_mat(3, 1, list(rate))).entries())
        turning = arb_mat(3, columns, [x for row in table[BODY_ROWS * k + 3 : BODY_ROWS * (k + 1)] for x in row])
        entries += [0] * (3 * columns)
        entries += ((inertia * spin + spin * inertia - momentum) * turning / 2).entries()
    return arb_mat(rows.nrows(), columns, entries)


def _crossing(vector: Sequence[Any]) -> Any:
    """The matrix of a cross product."""
    x, y, z = vector
    return arb_mat(3, 3, [0, -z, y, z, 0, -x, -y, x, 0])
