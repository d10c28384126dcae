"""Systems that fall freely: their weights accelerate all of them alike, and load no row and no joint.

Then weights are -G e, where e is an acceleration of the coordinates that is constant, and that no row touches: B e = 0.
With q_ddot = a + e weights are gone from the motion equations of a, and the rows bear the same, on the constraints and
off them.  In floating point they would leave a rounding of themselves in lambda, which is all there is near rest.

It is an identity in coordinates and parameters, and decided where these are residues at random (Schwartz and Zippel).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TypeAlias

from symgen.linear_algebra.residue_rows import ReducedRows, with_row
from symgen.mechanics.system import System
from symgen.mechanics.workless_forces import weights
from symgen.model.mechanism import NO_VECTOR
from symgen.model.model import Model
from symgen.symbolic.angles.circle import FIELD
from symgen.symbolic.exact import ExactValues
from symgen.symbolic.translate import translate

# Of each free coordinate the number, from 1, of the axis of the ground along which it falls, with its sign; or 0.
_Fall: TypeAlias = tuple[int, ...]


@lru_cache(maxsize=1)
def falls_freely(model: Model) -> bool:
    """Whether lambda does not depend on the weights of bodies; no where friction grows with what the rows bear."""
    if not model.constraints or model.rough or model.mechanism.gravity == NO_VECTOR:
        return False
    mechanics = System(model)
    free = [j for j in range(mechanics.n) if all(row[j].is_zero for row in mechanics.constraint_jacobian)]
    if not free or not mechanics.bodies.weights_work:
        return False
    falls = {_fall(mechanics, free, ExactValues(seed, signs=False)) for seed in (1, 2)}
    return len(falls) == 1 and None not in falls


def _fall(mechanics: System, free: Sequence[int], point: ExactValues) -> _Fall | None:
    """How free coordinates fall at a point; None where weights are no such -G e."""
    gravity = [translate(mechanics.graph, entry, mechanics.names) for entry in mechanics.model.mechanism.gravity]
    ground, loads = point.pairs(gravity), point.pairs(weights(mechanics))
    columns = [point.pairs([row[j] for row in mechanics.mass_matrix]) for j in free]
    if ground is None or loads is None or None in columns:
        return None
    reduced: ReducedRows = {}
    for i, load in enumerate(loads):
        for part in range(2):
            entries = [column[i][part] for column in columns if column is not None]
            reduced = with_row(reduced, [*entries, load[part]], FIELD.prime)
    if len(free) in reduced:
        return None
    rates = [-reduced[k][-1] % FIELD.prime if k in reduced else 0 for k in range(len(free))]
    falls = {0: 0}
    for axis, (g, _) in enumerate(ground, 1):
        falls = {g: axis, -g % FIELD.prime: -axis} | falls
    return tuple(falls[rate] for rate in rates) if falls.keys() >= set(rates) else None
