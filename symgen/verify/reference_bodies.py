"""Bodies in the reference: Jacobians of centres and turning rates, and what a motion along them asks for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb_mat

from symgen.model.expression import Expression
from symgen.model.mechanism import Mechanism
from symgen.verify.reference_frames import Frames
from symgen.verify.reference_tape import Register
from symgen.verify.reference_taylor import CONSTANT
from symgen.verify.reference_translation import Translation

BLOCK = 6  # rows of the Jacobian of a body
WEIGHTS = 10  # its mass and the entries of its inertia


class BodyReplay:
    """Registers of the Jacobian and the weights of every body, from frames to first order in the coordinates."""

    def __init__(self, mechanism: Mechanism, frames: Frames, plain: Translation, n: int) -> None:
        zero = plain.algebra.tape.zero
        self.jacobian: list[Register] = []
        self.weights: list[Register] = []
        for body in mechanism.bodies:
            for place in frames.center(body):
                self.jacobian += [place.get(((j,), ()), zero) for j in range(n)]
            for rate in frames.turning(body):
                self.jacobian += [rate.get(((), (j,)), zero) for j in range(n)]
            self.weights += constants(plain, [body.mass, *(entry for row in body.inertia.rows for entry in row)])


def constants(plain: Translation, expressions: Sequence[Expression]) -> list[Register]:
    """The values of expressions of parameters."""
    zero = plain.algebra.tape.zero
    return [plain.polynomial(expression).get(CONSTANT, zero) for expression in expressions]


def weighted(rows: Any, weights: Sequence[Any]) -> Any:
    """Velocities of centres times masses and turning rates times inertias, for each column of `rows`."""
    columns = rows.ncols()
    table = rows.tolist()
    found: list[Any] = []
    for k in range(rows.nrows() // BLOCK):
        mass, *inertia = weights[WEIGHTS * k : WEIGHTS * (k + 1)]
        block = table[BLOCK * k : BLOCK * (k + 1)]
        found += [mass * x for row in block[:3] for x in row]
        turned = arb_mat(3, 3, inertia) * arb_mat(3, columns, [x for row in block[3:] for x in row])
        found += turned.entries()
    return arb_mat(rows.nrows(), columns, found)
