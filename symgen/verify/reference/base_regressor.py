"""The base of the regressor: some of its columns, and what stands for all inertial parameters there.

Nothing is known here of how parameters combine.  Along admissible motions the bodies as they are load the coordinates
with N tau; the columns that are to stand for all make up for it, and what they are multiplied with solves that for
motions enough at once, on V near the state, in many digits.  That it does at one motion more than it takes is looked
at: columns that depend on each other have no solution, and columns that do not stand for all leave something over.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from typing import Any
from weakref import WeakKeyDictionary

from flint import arb_mat, ctx

from symgen.model.mechanism import ZERO
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.linear import column, columns_of, norm, solve
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.configurations.closing import admissible, onto_manifold
from symgen.verify.reference.configurations.manifold import ManifoldRanks
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.regressor import loads_of_units, of_other_bodies, regressor
from symgen.verify.reference.system import ReferenceSystem

# Motions beyond those that the count of unknowns takes.
FURTHER_MOTIONS = 1
# Of the ranges of coordinates: how far motions are from the state, which stays on its branch of V there.
NEARBY_SHARE = 0.1
# Times the working precision with which configurations are closed: what they leave open is nothing to what is solved.
CLOSING_PRECISION = 2
# The share of that to which they are.
CLOSED_SHARE = 0.6
# Configurations at which loops do not close, at most.
MOST_LEFT_OPEN = 20
# The share of the working precision to which columns have to make up for the bodies.
MADE_UP_SHARE = 0.5
_ALONE: WeakKeyDictionary[ReferenceSystem, ReferenceSystem] = WeakKeyDictionary()
_SOLVED: WeakKeyDictionary[ReferenceSystem, dict[tuple[Any, ...], Any]] = WeakKeyDictionary()


def base_regressor(e: Evaluation) -> Any:
    """The columns of Y (m x p_b) that stand for all."""
    return columns_of(regressor(e), _columns(e))


def base_parameters(e: Evaluation) -> Any:
    """beta (p_b x 1), with which these columns make up for all bodies."""
    solved = _SOLVED.setdefault(e.system, {})
    key = (ctx.prec, *(x.mid().man_exp() for x in (*e.parameters, *e.literals)))
    if key not in solved:
        solved[key] = _solution(e)
    return solved[key]


def _columns(e: Evaluation) -> tuple[int, ...]:
    base = e.system.model.inertial_base
    assert base is not None
    return base.columns


def motions_solved(model: Model, ranks: ManifoldRanks) -> int:
    """At how many motions the load of bodies is looked at for base parameters."""
    count = 0 if model.inertial_base is None else len(model.inertial_base.columns)
    return -(-count // (model.n - ranks.constraints)) + FURTHER_MOTIONS


def _solution(e: Evaluation) -> Any:
    matrices, loads = [], []
    for at in islice(_motions(e), motions_solved(e.system.model, e.ranks)):
        matrices += (at.projector * columns_of(loads_of_units(at), _columns(e))).tolist()
        loads += (at.projector * _alone(at).load).entries()
    matrix, load = arb_mat(matrices), column(loads)
    across = matrix.transpose()
    made = solve(across * matrix, across * load)
    if not norm(matrix * made - load) <= 2.0 ** (-MADE_UP_SHARE * ctx.prec) * norm(load):
        raise ZeroDivisionError("the columns do not make up for the bodies")
    return made


def _motions(e: Evaluation) -> Iterator[Evaluation]:
    """Admissible motions near a state: the same ones for the same state."""
    generator, n = random.Random("base"), e.system.n
    spans = [float(c.range[1] - c.range[0]) for c in e.system.model.coordinates]
    missed = 0
    while missed < MOST_LEFT_OPEN:
        q = _closed(e, [NEARBY_SHARE * span * generator.uniform(-1, 1) for span in spans])
        rate, acceleration = (column([generator.uniform(-1, 1) for _ in range(n)]) for _ in range(2))
        if q is None:
            missed += 1
            continue
        at = replace(e, q=q, u=(), task=(), derivatives={})
        rate = at.projector * rate
        drift = at.inverse * at.motion(rate)[1]
        at.qd, at.qdd = rate.entries(), (at.projector * acceleration - drift).entries()
        yield at
    raise ZeroDivisionError("no motion was found near the state")


def _closed(e: Evaluation, shift: list[float]) -> list[Any] | None:
    """Where the loops close near a shifted configuration."""
    given = e.parameters, e.literals
    with precision(CLOSING_PRECISION * ctx.prec):
        steps = admissible(e.system, e.q, shift, *given)
        start = [x.mid() + step for x, step in zip(e.q, steps, strict=True)]
        return onto_manifold(e.system, start, *given, 2.0 ** (-CLOSED_SHARE * ctx.prec))


def _alone(e: Evaluation) -> Evaluation:
    """The same state of the bodies and rotors alone: no springs, no friction, no energies that are written out."""
    model = e.system.model
    if e.system not in _ALONE:
        bodies = replace(model, kinetic_energy=ZERO, potential_energy=ZERO, applied_forces=(), forces=())
        _ALONE[e.system] = ReferenceSystem(bodies)
    return of_other_bodies(e, _ALONE[e.system])
