"""Velocities that a rate gives to bodies, and what forces on these load the coordinates with, without their Jacobian.

Both are read off the velocities of bodies along a line, which are linear in the rate: the load is the gradient of their
power by the rate.  Of a chain this grows with its length, the Jacobian with the square of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any

from flint import arb_mat

from symgen.verify.reference.arithmetic.adjoints import gradient
from symgen.verify.reference.arithmetic.tape import Register, Tape, replay_of
from symgen.verify.reference.mechanism.bodies import weighted


class MovedBodies:
    """Two replays; inputs are q, a rate, the parameters and the literals, `given` numbers together, then a wrench each.

    `velocities` has 6 registers a body, as rows of Jacobians are.
    """

    def __init__(self, tape: Tape, velocities: Sequence[Register], n: int, given: int) -> None:
        self._n = n
        self._velocities = replay_of(tape, velocities)
        shares = [tape.binary("mul", tape.input(given + k), x) for k, x in enumerate(velocities)]
        power = reduce(lambda total, share: tape.binary("add", total, share), shares, tape.zero)
        self._force = replay_of(tape, gradient(tape, power, range(n, 2 * n)))
        self.operations = self._velocities.operations + self._force.operations

    def force(self, inputs: Sequence[Any], wrenches: Sequence[Any]) -> Any:
        """What forces on the centres and torques in body axes load the coordinates with (n x 1)."""
        return arb_mat(self._n, 1, self._force.run([*inputs, *wrenches]))

    def momenta(self, inputs: Sequence[Any], weights: Sequence[Any]) -> list[Any]:
        """Masses times velocities of centres and inertias times turning rates."""
        moved = self._velocities.run(inputs)
        entries: list[Any] = weighted(arb_mat(len(moved), 1, moved), weights).entries()
        return entries
