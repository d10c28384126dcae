"""The part of a system that u depends on where inputs span less than the motions: blocks of rows that inputs load.

N_B is made of a projector for each block of rows that share no coordinate.  Where B M = 0 in a block, because no input
acts on its coordinates or all work along its motions alone (torques and the length of a quaternion), N_B M = M there in
every configuration, and u = M~^+ tau depends neither on the rows nor on their rank.
"""

from __future__ import annotations

from dataclasses import replace

from symgen.linear_algebra.blocks import components
from symgen.mechanics.genericity import Genericity, at_configurations, rank
from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.symbolic.matrix import dot


def where_inputs_act(model: Model, generic: Genericity) -> tuple[Model, Genericity] | None:
    """The system without the rows of other blocks, None where there are none, or its ranks there are in doubt.

    Inputs that span all motions leave no direction open: their methods need the rows.
    """
    if generic.full_actuation or not generic.r:
        return None
    mechanics = System(model)
    b = mechanics.constraint_jacobian
    loaded = {i for i, row in enumerate(b) if not all(dot(mechanics.graph, row, x).is_zero for x in mechanics.inputs)}
    kept = sorted(i for part in components(b) if not loaded.isdisjoint(part.rows) for i in part.rows)
    if len(kept) == generic.r:
        return None
    rows = [model.constraints[i] for i in kept]
    geometric = sum(row.kind == "geometric" for row in rows)  # the first ones
    ranks = set[tuple[int | None, int | None]]()
    for of_all_rows in at_configurations(mechanics, b):
        at = [of_all_rows[i] for i in kept]
        ranks.add((rank(at), rank(at[:geometric])))
    if len(ranks) != 1:
        return None
    ((of_all, of_geometric),) = ranks
    if of_all is None or of_geometric is None:
        return None
    touched = {j for i in kept for j, entry in enumerate(b[i]) if not entry.is_zero}
    locked = tuple(j for j in generic.locked if j in touched)
    smaller = replace(generic, r=len(kept), rank=of_all, geometric_rank=of_geometric, locked=locked)
    return replace(model, constraints=tuple(rows), row_units=()), smaller
